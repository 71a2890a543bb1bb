#include "results/caption.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace regather::results {
namespace {

/// The values of a column over all curves, "a, b" when there are several.
template <class Text>
std::string all_values(std::span<const Curve> curves, Text text) {
    std::vector<std::string> seen;
    for (const Curve& curve : curves)
        for (const Row* row : curve.rows)
            if (const std::string value = text(*row);
                !value.empty() && std::find(seen.begin(), seen.end(), value) == seen.end())
                seen.push_back(value);
    return joined(seen, " and ");
}

}  // namespace

std::string caption(std::span<const Curve> curves, const std::string& cache) {
    std::string queries = all_values(curves, [](const Row& row) {
        return row.queries ? decimal_count(static_cast<double>(*row.queries)) : std::string();
    });
    if (!queries.empty()) queries += " queries";
    std::vector<std::string> parts = {all_values(curves, [](const Row& row) { return row.scene; }), queries};
    if (!cache.empty()) {
        const std::string policy =
            all_values(curves, [](const Row& row) { return row.policy == "lru" ? "LRU" : row.policy; });
        parts.push_back(policy.empty() ? cache : fmt::format("{} {}", cache, policy));
        parts.push_back(all_values(curves, [](const Row& row) { return row.structure; }));
        parts.push_back(all_values(curves, [](const Row& row) { return row.layout; }));
    }
    return joined(parts, " · ");
}

}  // namespace regather::results
