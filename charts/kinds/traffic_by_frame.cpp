#include "charts/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "charts/caption.h"
#include "charts/series.h"

namespace regather::charts {

Chart traffic_by_frame(const ChartKind& kind, const results::Rows& rows, const ChartOptions& options) {
    const auto common = results::commonest_geometry(rows.of<results::Row>());
    if (!common) return skip("no row has cache_bytes, line_bytes and ways");
    const results::Geometry cache = options.cache.value_or(*common);
    std::vector<Curve> all =
        curves(rows.of<results::Row>(), Along::cache, {cache, options.tile, options.bins, true});

    std::set<std::uint64_t> frames;
    double most = 0;
    for (Curve& curve : all) {
        std::vector<const results::Row*> own;
        for (const auto& place : curve.frames)
            for (const results::Row* row : place)
                if (row->frame && row->cache_bytes == cache.cache_bytes &&
                    row->traffic_bytes.value_or(0) > 0) {
                    own.push_back(row);
                    frames.insert(*row->frame);
                    most = std::max(most, static_cast<double>(*row->traffic_bytes));
                }
        curve.rows = own;
        curve.frames.clear();
    }
    std::erase_if(all, [](const Curve& curve) { return curve.rows.empty(); });
    if (frames.size() < 2) return skip(fmt::format("needs {}; found {}", kind.needs, frames.size()));

    const results::ByteUnit unit = results::byte_unit(most);
    Panel panel;
    panel.up.label = fmt::format("traffic [{}]", unit.name);
    panel.height = 250;
    std::vector<double> heights;
    for (const Curve& curve : all) {
        Line line = line_of(curve);
        for (const results::Row* row : curve.rows) {
            heights.push_back(static_cast<double>(*row->traffic_bytes) / unit.bytes);
            line.points.push_back({static_cast<double>(*row->frame), heights.back()});
        }
        panel.lines.push_back(std::move(line));
    }
    panel.up.scale = log_scale(heights, plain_number);
    const auto first = static_cast<double>(*frames.begin()), last = static_cast<double>(*frames.rbegin());
    Scale across{false, first - 0.03 * (last - first), last + 0.03 * (last - first), {}};
    const std::size_t every = 1 + (frames.size() - 1) / 8;
    std::size_t number = 0;
    for (const std::uint64_t frame : frames)
        if (number++ % every == 0)
            across.ticks.emplace_back(static_cast<double>(frame), fmt::to_string(frame));
    std::string text = results::geometry_text(cache);
    return draw({std::string(kind.title),
                 caption(all, text.insert(text.find(','), " cache")),
                 {"frame of the camera path", across},
                 {std::move(panel)}});
}

}  // namespace regather::charts
