#include "spatial/listed_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "spatial/refusal.h"
#include "trace/error.h"
#include "trace/text.h"

namespace regather::spatial {
namespace {

namespace fs = std::filesystem;
using trace::Region;

bool is_element_region(std::uint64_t region) {
    return region < trace::region_count && Region(region) != Region::reorder_buffer &&
           Region(region) != Region::photon_power;
}

void check_bytes(const Listed::Elements& elements, const fs::path& folder) {
    for (std::size_t e = 0; e < elements.bytes.size(); ++e) {
        if (elements.bytes[e] > most_element_bytes)
            refuse_row(folder, "element_bytes", e, fmt::format("{}", elements.bytes[e]),
                       fmt::format("at most {}", most_element_bytes));
        if (!elements.address.empty() && elements.address[e] + elements.bytes[e] < elements.address[e])
            refuse_row(folder, "element_address", e, fmt::format("{}", elements.address[e]),
                       fmt::format("one that leaves room for {} bytes below 2^64", elements.bytes[e]));
    }
}

void check_overlaps(const Listed::Elements& elements, const fs::path& folder) {
    std::vector<std::uint32_t> order(elements.address.size());
    std::iota(order.begin(), order.end(), 0u);
    std::erase_if(order, [&](std::uint32_t e) { return elements.bytes[e] == 0; });
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return elements.address[a] < elements.address[b] ||
               (elements.address[a] == elements.address[b] && a < b);
    });
    for (std::size_t i = 1; i < order.size(); ++i) {
        const std::uint32_t before = order[i - 1], e = order[i];
        const std::uint64_t end = elements.address[before] + elements.bytes[before];
        if (elements.address[e] < end)
            refuse_row(
                folder, "element_address", e, fmt::format("{}", elements.address[e]),
                fmt::format("at least {}, where element {} ends (--allow-overlaps takes elements that share "
                            "bytes)",
                            end, before));
    }
}

void check_levels(const Listed::Elements& elements, const fs::path& folder) {
    const std::span<const std::uint32_t> parent = elements.parent;
    for (std::size_t e = 0; e < parent.size(); ++e)
        if (parent[e] >= parent.size())
            refuse_row(folder, "element_parent", e, fmt::format("{}", parent[e]),
                       fmt::format("an element below {}", parent.size()));
    const std::vector<std::uint32_t> below = levels_below(parent);
    for (std::size_t e = 0; e < below.size(); ++e) {
        if (below[e] == no_level)
            refuse_row(folder, "element_parent", e,
                       fmt::format("{}, whose parents lead in a circle", parent[e]),
                       "parents that lead to an element that is its own parent");
        if (elements.level.empty() && below[e] >= most_element_levels)
            refuse_row(folder, "element_parent", e,
                       fmt::format("an element {} steps below its root", below[e]),
                       fmt::format("fewer than {}", most_element_levels));
    }
    for (std::size_t e = 0; e < elements.level.size(); ++e)
        if (elements.level[e] >= most_element_levels)
            refuse_row(folder, "element_level", e, fmt::format("{}", elements.level[e]),
                       fmt::format("less than {}", most_element_levels));
}

template <class T>
std::vector<T> column(trace::TraceReader& trace, std::string_view name) {
    if (!trace.has(name)) return {};
    const std::span<const T> rows = trace.column<T>(name);
    return {rows.begin(), rows.end()};
}

std::vector<ElementRange> ranges_of(std::span<const std::uint32_t> region, const fs::path& folder) {
    std::vector<ElementRange> ranges;
    for (std::uint32_t e = 0; e < region.size(); ++e) {
        const auto own = static_cast<Region>(region[e]);
        if (ranges.empty() || ranges.back().region != own) {
            for (const ElementRange& range : ranges)
                if (range.region == own)
                    refuse_row(folder, "element_region", e, fmt::format("{} again", region[e]),
                               "the elements of a region together");
            ranges.push_back({own, e, 0});
        }
        ++ranges.back().count;
    }
    return ranges;
}

}  // namespace

std::string element_regions() {
    std::string text;
    for (std::size_t r = 0; r < trace::region_count; ++r)
        if (is_element_region(r))
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", r, trace::region_names[r]);
    return text;
}

void check_elements(const Listed::Elements& elements, std::span<const std::uint32_t> region, bool overlaps,
                    const fs::path& folder) {
    for (std::size_t e = 0; e < region.size(); ++e)
        if (!is_element_region(region[e]))
            refuse_row(folder, "element_region", e, fmt::format("{}", region[e]),
                       "one of " + element_regions());
    check_bytes(elements, folder);
    check_levels(elements, folder);
    if (!overlaps) check_overlaps(elements, folder);
}

void store_elements(trace::TraceWriter& writer, const Listed& structure) {
    const Listed::Elements& elements = structure.elements();
    const auto store = [&](const char* name, const auto& rows) {
        if (!rows.empty()) writer.column(name).append(std::span(rows));
    };
    std::vector<std::uint32_t> region;
    for (const ElementRange& range : elements.ranges)
        region.insert(region.end(), range.count, static_cast<std::uint32_t>(range.region));
    writer.column("element_region").append(std::span<const std::uint32_t>(region));
    store("element_bytes", elements.bytes);
    store("element_address", elements.address);
    store("element_level", elements.level);
    store("element_parent", elements.parent);
}

Listed::Elements open_elements(trace::TraceReader& trace) {
    const std::span<const std::uint32_t> region = trace.column<std::uint32_t>("element_region");
    if (region.size() >= std::uint64_t{1} << 31)
        throw trace::DataError(fmt::format("{}: found {} rows, expected fewer than 2^31",
                                           (trace.folder() / "element_region.npy").string(), region.size()));
    Listed::Elements elements;
    elements.parent = column<std::uint32_t>(trace, "element_parent");
    elements.level = column<std::uint32_t>(trace, "element_level");
    elements.bytes = column<std::uint32_t>(trace, "element_bytes");
    elements.address = column<std::uint64_t>(trace, "element_address");
    if (!elements.address.empty() && elements.bytes.empty())
        refuse_row(trace.folder(), "element_address", 0, "an address", "element_bytes beside it");
    const trace::Json* const overlaps = trace.info().parameters.find("overlaps");
    check_elements(elements, region, overlaps && *overlaps == trace::Json(true), trace.folder());
    elements.ranges = ranges_of(region, trace.folder());
    if (!trace.has("photon")) return elements;

    elements.record_begin = column<std::uint32_t>(trace, "tree_leaf_begin");
    const std::uint64_t photons = trace.column<trace::Photon>("photon").size();
    const std::vector<std::uint32_t>& begin = elements.record_begin;
    std::uint64_t leaves = 0;
    for (const ElementRange& range : elements.ranges)
        if (range.region == Region::photons) leaves = range.count;
    if (begin.size() != leaves + 1 || begin.front() != 0 || begin.back() != photons)
        refuse_row(trace.folder(), "tree_leaf_begin", begin.empty() ? 0 : begin.size() - 1,
                   begin.empty() ? "nothing" : fmt::format("{}", begin.back()),
                   fmt::format("{} rows from 0 to {}, the photons", leaves + 1, photons));
    for (std::uint64_t l = 0; l < leaves; ++l)
        if (begin[l + 1] <= begin[l])
            refuse_row(trace.folder(), "tree_leaf_begin", l + 1, fmt::format("{}", begin[l + 1]),
                       fmt::format("more than {}", begin[l]));
    return elements;
}

}  // namespace regather::spatial
