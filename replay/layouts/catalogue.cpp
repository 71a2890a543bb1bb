#include "replay/layouts/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "replay/layouts/placement.h"
#include "spatial/photons/left_balanced.h"
#include "spatial/rays/ray_tree.h"
#include "trace/error.h"
#include "trace/range.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::replay {
namespace {

constexpr std::uint64_t region_alignment = 4096;

constexpr std::array<LayoutOrder, 7> orders{{
    {"heap", "by number: a left-balanced tree level by level, children of i at 2i and 2i + 1"},
    {"depth-first", "each element before those below it, subtree by subtree"},
    {"breadth-first", "level by level"},
    {"van-emde-boas", "the upper half of the levels, then each subtree below, again so"},
    {"hilbert", "photons, or their leaves, along a Hilbert curve; inner nodes depth-first"},
    {"morton", "the same along the Morton curve"},
    {"clusters", "groups of an element and what hangs below it that fill a line (line=128)"},
}};

constexpr std::array<PhotonRecord, 5> records{{
    {"20", "as in Jensen 2001: position, power, direction, flags", 20, 20},
    {"32", "the same, padded to 32 bytes", 32, 20},
    {"16", "compressed to 16 bytes", 16, 16},
    {"14+6", "position and axis; power and direction apart, read of the photons found", 14, 14, 6},
    {"12+6", "position; power and direction apart, read of the photons found", 12, 12, 6, false},
}};

constexpr std::array<TriangleRecord, 2> of_triangles{{
    {"36", "three corners", 36},
    {"48", "three corners of 16 bytes, with number and material in the padding", 48},
}};

constexpr trace::Parameter parameters[] = {
    {"line", "128", "bytes of the line that a cluster fills, a power of two from 16 to 4096"},
    {"node", "",
     "bytes of an inner node that holds no photon, 4 to 1024; none: 8, for rays what its boxes take"},
    {"top", "0", "levels from the root that are kept on chip, 0 to 40"},
};

template <class Table>
const auto& row(const Table& table, std::string_view what, std::string_view word) {
    std::vector<std::string_view> names;
    names.reserve(table.size());
    for (const auto& entry : table) names.push_back(entry.name);
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end())
        throw trace::UsageError(fmt::format("layout: unknown {} {}; nearest: {}; known: {}", what,
                                            trace::in_quotes(word), trace::nearest_words(word, names).front(),
                                            trace::listed(names)));
    return table[static_cast<std::size_t>(found - names.begin())];
}

/// What elements take and what visits of them read, in bytes.
struct Sizes {
    const spatial::Structure& structure;
    const PhotonRecord& record;
    std::uint32_t node_bytes, triangle_bytes;

    trace::Region region(std::uint32_t element) const {
        const std::span<const spatial::ElementRange> ranges = structure.ranges();
        std::size_t r = 0;
        while (r + 1 < ranges.size() && element >= ranges[r + 1].first) ++r;
        return ranges[r].region;
    }
    std::uint32_t taken(std::uint32_t element) const {
        switch (region(element)) {
            case trace::Region::nodes:
                return node_bytes;
            case trace::Region::photon_power:
                return record.apart_bytes;
            case trace::Region::triangles:
                return triangle_bytes * structure.records(element);
            case trace::Region::stack:
                return stack_entry_bytes;
            default:
                return record.stride_bytes * structure.records(element);
        }
    }
    /// The padding behind the last photon is not read.
    std::uint32_t used(std::uint32_t element) const {
        const std::uint32_t bytes = taken(element);
        if (region(element) != trace::Region::photons || bytes == 0) return bytes;
        return bytes - (record.stride_bytes - record.used_bytes);
    }
};

/// Addresses of a placement's elements, region by region.
std::vector<Extent> extents_of(const Placement& placement, const Sizes& sizes, std::uint32_t line_bytes,
                               std::uint32_t top) {
    const spatial::Structure& structure = sizes.structure;
    std::vector<Extent> extents(structure.end());
    std::uint64_t address = 0;
    for (const spatial::ElementRange& range : structure.ranges()) {
        address = (address + region_alignment - 1) / region_alignment * region_alignment;
        if (range.region == trace::Region::photon_power) {
            const spatial::ElementRange photons = structure.range_of(trace::Region::photons);
            for (const std::uint32_t e : placement.elements) {
                if (e < photons.first || e >= photons.first + photons.count) continue;
                const std::uint32_t first = range.first + structure.first_record(e);
                for (std::uint32_t p = first; p < first + structure.records(e); ++p) {
                    extents[p] = {address, sizes.used(p)};
                    address += sizes.taken(p);
                }
            }
            continue;
        }
        const auto here = [&](std::uint32_t e) { return e >= range.first && e < range.first + range.count; };
        std::size_t group = 0;
        for (std::size_t i = 0; i < placement.elements.size(); ++i) {
            if (group < placement.group_begins.size() && placement.group_begins[group] == i) {
                ++group;
                const std::size_t end = group < placement.group_begins.size() ? placement.group_begins[group]
                                                                              : placement.elements.size();
                std::uint64_t bytes = 0;
                for (std::size_t g = i; g < end; ++g)
                    if (here(placement.elements[g])) bytes += sizes.taken(placement.elements[g]);
                if (bytes <= line_bytes && address % line_bytes + bytes > line_bytes)
                    address = (address + line_bytes - 1) / line_bytes * line_bytes;
            }
            const std::uint32_t e = placement.elements[i];
            if (!here(e)) continue;
            extents[e] = {address, structure.level(e) < top ? 0 : sizes.used(e)};
            address += sizes.taken(e);
        }
    }
    return extents;
}

}  // namespace

std::span<const LayoutOrder> layout_orders() {
    return orders;
}
std::span<const PhotonRecord> photon_records() {
    return records;
}
std::span<const TriangleRecord> triangle_records() {
    return of_triangles;
}
std::span<const trace::Parameter> layout_parameters() {
    return parameters;
}

Layout make_layout(std::string_view spec, const spatial::Structure& structure,
                   std::span<const trace::Vec3> positions) {
    const std::size_t colon = std::min(spec.find(':'), spec.size());
    const std::string_view name = spec.substr(0, colon);
    const std::size_t dash = name.rfind('-');
    if (dash == std::string_view::npos)
        throw trace::UsageError(
            fmt::format("layout: found {}, expected ORDER-RECORD such as heap-20", trace::in_quotes(spec)));
    const LayoutOrder& order = row(orders, "order", name.substr(0, dash));
    const auto* const of_rays = dynamic_cast<const spatial::RayTree*>(&structure);
    const PhotonRecord& record = of_rays ? records[0] : row(records, "record", name.substr(dash + 1));
    const std::uint32_t triangle_bytes =
        of_rays ? row(of_triangles, "record of a triangle", name.substr(dash + 1)).bytes : 0;
    const trace::Parameters given(name, parameters, spec.substr(std::min(colon + 1, spec.size())));
    const std::uint32_t line = given.count("line"), top = given.count("top"),
                        node = given.given_count("node").value_or(of_rays ? of_rays->node_bytes() : 8);
    trace::require_range(name, "line", line, 16, 4096);
    trace::require_range(name, "node", node, of_rays ? of_rays->node_bytes() : 4, 1024);
    trace::require_range(name, "top", top, 0, 40);
    if (!std::has_single_bit(line))
        throw trace::UsageError(fmt::format("{}: line: found {}, expected a power of two", name, line));

    const Sizes sizes{structure, record, node, triangle_bytes};
    const bool clusters = order.name == "clusters";
    const bool nodes = structure.range_of(trace::Region::nodes).count > 0;
    if (record.apart_bytes > 0 && structure.end() > 0 &&
        structure.range_of(trace::Region::photon_power).count == 0)
        throw trace::UsageError(
            fmt::format("layout: record {}: found walks in {} that do not tell which photons were found, "
                        "expected found=1 "
                        "(regather walk)",
                        record.name, structure.name()));
    if (!record.tells_axis && !nodes && structure.range_of(trace::Region::photons).count > 1)
        throw trace::UsageError(fmt::format(
            "layout: record {}: found {}, whose photons are inner nodes, expected a record with an axis",
            record.name, structure.name()));
    std::string text(name);
    auto tell = [&, colon = true](std::string_view parameter, std::uint32_t value) mutable {
        text += fmt::format("{}{}={}", std::exchange(colon, false) ? ":" : ",", parameter, value);
    };
    if (clusters) tell("line", line);
    if (nodes) tell("node", node);
    if (top > 0) tell("top", top);
    if (order.name == "heap" && top == 0 && dynamic_cast<const spatial::LeftBalanced*>(&structure))
        return {std::move(text), structure, 0, record.stride_bytes, record.used_bytes};
    const bool along_hilbert = order.name == "hilbert", along_morton = order.name == "morton";
    if ((along_hilbert || along_morton) && positions.empty() && structure.end() > 0)
        throw trace::UsageError(fmt::format("layout: order {}: found {} without positions, expected photons",
                                            order.name, structure.name()));
    const Placement placement =
        order.name == "heap"            ? heap_order(structure)
        : order.name == "depth-first"   ? depth_first_order(structure)
        : order.name == "breadth-first" ? breadth_first_order(structure)
        : along_hilbert                 ? curve_order(structure, positions, SpaceCurve::hilbert)
        : along_morton                  ? curve_order(structure, positions, SpaceCurve::morton)
        : clusters ? clustered_order(structure, line, [&](std::uint32_t e) { return sizes.taken(e); })
                   : van_emde_boas_order(structure);
    return {std::move(text), structure, extents_of(placement, sizes, line, top)};
}

Layout usual_layout(const spatial::Structure& structure) {
    const bool of_rays = dynamic_cast<const spatial::RayTree*>(&structure) != nullptr;
    return make_layout(of_rays ? "depth-first-48" : "heap-20", structure);
}

}  // namespace regather::replay
