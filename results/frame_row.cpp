#include "results/frame_row.h"

#include <algorithm>
#include <array>
#include <vector>

#include "results/geometry.h"
#include "results/machine_columns.h"

namespace regather::results {
namespace {

template <auto field>
constexpr Column of_machine(std::string_view name, bool is_needed = false) {
    return column<field, FrameRow>(name, is_needed);
}

constexpr auto frame_columns = with_machine_counts<FrameRow>(std::array{
    of_machine<&FrameRow::scene>("scene"),
    column<&FrameRow::frame>("frame"),
    column<&FrameRow::unit>("unit", needed),
    column<&FrameRow::run>("run", needed),
    column<&FrameRow::part>("part", needed),
    of_machine<&FrameRow::structure>("structure"),
    of_machine<&FrameRow::layout>("layout"),
    of_machine<&FrameRow::ordering>("ordering"),
    of_machine<&FrameRow::parameters>("parameters"),
    of_machine<&FrameRow::machine>("machine", needed),
    of_machine<&FrameRow::level>("level", needed),
    of_machine<&FrameRow::region>("region", needed),
    column<&FrameRow::queries>("queries"),
});

std::string difference(std::uint64_t together_bytes, std::uint64_t apart_bytes) {
    return together_bytes < apart_bytes ? "-" + decimal_bytes(apart_bytes - together_bytes)
                                        : decimal_bytes(together_bytes - apart_bytes);
}

}  // namespace

const RowKind& FrameRow::kind() {
    static constexpr RowKind kind{"frame", frame_columns};
    return kind;
}

Table frame_table(std::span<const FrameRow> rows) {
    Table out({{"machine", Align::left},
               {"unit", Align::left},
               {"level", Align::left},
               {"part", Align::left},
               {"apart"},
               {"together"},
               {"difference"}});
    struct Line {
        const FrameRow* first;
        std::array<std::uint64_t, 2> bytes{};  // apart, together
    };
    std::vector<Line> lines;
    for (const FrameRow& row : rows) {
        if (!row.bytes_in) continue;
        const auto same_level = [&](const Line& line) {
            return line.first->unit == row.unit && line.first->machine == row.machine &&
                   line.first->level == row.level;
        };
        auto line = std::find_if(lines.begin(), lines.end(),
                                 [&](const Line& l) { return same_level(l) && l.first->part == row.part; });
        if (line == lines.end()) {  // behind the last of its level
            const auto last = std::find_if(lines.rbegin(), lines.rend(), same_level);
            line = lines.insert(last.base() == lines.begin() ? lines.end() : last.base(), Line{&row});
        }
        line->bytes[row.run == together] += *row.bytes_in + row.bytes_out.value_or(0);
    }
    std::array<std::uint64_t, 2> sum{};
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const FrameRow& of = *lines[l].first;
        out.add({of.machine, of.unit, of.level, of.part, decimal_bytes(lines[l].bytes[0]),
                 decimal_bytes(lines[l].bytes[1]), difference(lines[l].bytes[1], lines[l].bytes[0])});
        for (std::size_t r = 0; r < sum.size(); ++r) sum[r] += lines[l].bytes[r];
        const bool last = l + 1 == lines.size() || lines[l + 1].first->level != of.level ||
                          lines[l + 1].first->machine != of.machine || lines[l + 1].first->unit != of.unit;
        if (!last) continue;
        out.add({of.machine, of.unit, of.level, "all", decimal_bytes(sum[0]), decimal_bytes(sum[1]),
                 difference(sum[1], sum[0])});
        sum = {};
    }
    return out;
}

}  // namespace regather::results
