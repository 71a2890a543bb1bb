#include "charts/caption.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

namespace regather::charts {
namespace {

/// The values of a column over all curves, "a, b" when there are several.
template <class Text>
std::string all_values(std::span<const Curve> curves, Text text) {
    std::vector<std::string> seen;
    for (const Curve& curve : curves)
        for (const results::Row* row : curve.rows)
            if (const std::string value = text(*row);
                !value.empty() && std::find(seen.begin(), seen.end(), value) == seen.end())
                seen.push_back(value);
    return results::joined(seen, " and ");
}

/// "frames 0:30:5, median and range" as `capture --frames` takes them; uneven ones one by one.
std::string frames_text(std::span<const Curve> curves) {
    std::set<std::uint64_t> seen;
    bool merged = false;
    for (const Curve& curve : curves)
        for (const auto& frames : curve.frames) {
            merged |= frames.size() > 1;
            for (const results::Row* row : frames)
                if (row->frame) seen.insert(*row->frame);
        }
    if (!merged || seen.size() < 2) return "";
    const std::vector<std::uint64_t> all(seen.begin(), seen.end());
    const std::uint64_t step = all[1] - all[0];
    bool even = true;
    for (std::size_t i = 1; i < all.size(); ++i) even &= all[i] - all[i - 1] == step;
    std::string list;
    if (even)
        list = fmt::format("{}:{}:{}", all.front(), all.back() + step, step);
    else
        for (const std::uint64_t frame : all) list += fmt::format("{}{}", list.empty() ? "" : ", ", frame);
    return fmt::format("frames {}, median and range", list);
}

}  // namespace

std::string caption(std::span<const Curve> curves, const std::string& cache) {
    std::string queries = all_values(curves, [](const results::Row& row) {
        return row.queries ? results::decimal_count(static_cast<double>(*row.queries)) : std::string();
    });
    if (!queries.empty()) queries += " queries";
    std::vector<std::string> parts = {all_values(curves, [](const results::Row& row) { return row.scene; }),
                                      frames_text(curves), queries};
    if (!cache.empty()) {
        const std::string policy = all_values(
            curves, [](const results::Row& row) { return row.policy == "lru" ? "LRU" : row.policy; });
        parts.push_back(policy.empty() ? cache : fmt::format("{} {}", cache, policy));
        parts.push_back(all_values(curves, [](const results::Row& row) { return row.structure; }));
        parts.push_back(all_values(curves, [](const results::Row& row) { return row.layout; }));
    }
    return results::joined(parts, " · ");
}

}  // namespace regather::charts
