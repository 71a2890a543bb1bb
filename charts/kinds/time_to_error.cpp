#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "charts/kinds.h"
#include "charts/ladder_look.h"

namespace regather::charts {
namespace {

constexpr double goal_pixels = 26, goal_note = 0.66, goal_mark = 0.26;  // of a line, and parts of its height

/// One line: an error of one picture, and when each ladder reaches it.
struct Goal {
    std::string name;
    std::vector<std::pair<std::string, double>> seconds;  ///< By the ladder's name; below 0: at most so many.
};

bool same_picture(const results::ConvergenceRow& a, const results::ConvergenceRow& b) {
    return a.scene == b.scene && a.width == b.width && a.height == b.height && a.reference == b.reference;
}

constexpr std::size_t most_goals = 3;  // of a picture

/// By pictures as they come; of each the least errors that some ladder reaches, greatest first.
std::vector<Goal> goals_of(const std::vector<results::Ladder>& all) {
    std::vector<const results::ConvergenceRow*> pictures;
    for (const results::Ladder& ladder : all)
        if (std::none_of(pictures.begin(), pictures.end(),
                         [&](const auto* row) { return same_picture(*row, *ladder.rows.front()); }))
            pictures.push_back(ladder.rows.front());
    std::vector<Goal> goals;
    for (const results::ConvergenceRow* picture : pictures) {
        std::vector<Goal> own;
        for (const double percent : {50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5}) {
            Goal goal{fmt::format("{}, {:g} %", picture->scene, percent), {}};
            for (const results::Ladder& ladder : all) {
                const results::ConvergenceRow& first = *ladder.rows.front();
                if (!same_picture(first, *picture) || first.mean_radiance.value_or(0) <= 0) continue;
                if (const auto found = results::seconds_to(ladder, percent / 100 * *first.mean_radiance))
                    goal.seconds.emplace_back(first.ladder, *found);
            }
            if (!goal.seconds.empty()) own.push_back(std::move(goal));
        }
        const std::size_t first = own.size() - std::min(own.size(), most_goals);
        goals.insert(goals.end(), own.begin() + static_cast<std::ptrdiff_t>(first), own.end());
    }
    return goals;
}

}  // namespace

Chart time_to_error(const ChartKind& kind, const results::Rows& rows, const ChartOptions&) {
    const std::vector<results::Ladder> all = results::ladders(rows.of<results::ConvergenceRow>());
    const std::vector<Goal> goals = goals_of(all);
    std::vector<double> values;
    for (const Goal& goal : goals)
        for (const auto& [ladder, seconds] : goal.seconds) values.push_back(std::abs(seconds));
    if (values.empty()) return skip(fmt::format("needs {}", kind.needs));
    const Scale across = log_scale(values, plain_number);

    Panel panel;
    panel.height = goal_pixels * static_cast<double>(goals.size());
    panel.up.scale = {false, 0, static_cast<double>(goals.size()), {}};
    panel.bare = true;
    std::map<std::string, std::size_t> line_at;  // of a ladder's name
    for (const results::Ladder& ladder : all) {
        const std::string& name = ladder.rows.front()->ladder;
        if (!line_at.emplace(name, panel.lines.size()).second) continue;
        Line& line = panel.lines.emplace_back(line_of(ladder, panel.lines.size()));
        line.label = name;
        line.form = Line::Form::points;
    }
    for (std::size_t g = 0; g < goals.size(); ++g) {
        const double base = static_cast<double>(goals.size() - 1 - g);
        panel.notes.push_back({across.low, base + goal_note, goals[g].name});
        for (const auto& [ladder, seconds] : goals[g].seconds)
            panel.lines[line_at.at(ladder)].points.push_back({std::abs(seconds), base + goal_mark});
    }
    std::erase_if(panel.lines, [](const Line& line) { return line.points.empty(); });
    return draw({std::string(kind.title),
                 caption(all),
                 {"seconds an image, with photon pass and tree, at most", across},
                 {std::move(panel)}});
}

}  // namespace regather::charts
