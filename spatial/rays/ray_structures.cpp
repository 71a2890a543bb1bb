#include "spatial/rays/ray_structures.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "spatial/refusal.h"
#include "trace/error.h"
#include "trace/range.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::spatial {
namespace {

constexpr trace::Parameter stack{"stack", "",
                                 "entries of a ray's stack on chip, 0 to 512, the others are read and "
                                 "written in memory; none: all are on chip"};
constexpr trace::Parameter renderers_parameters[] = {stack};
constexpr trace::Parameter bvh_parameters[] = {{"leaf", "4", "most triangles of a leaf, 1 to 8"},
                                               {"quantised", "0", "1: boxes of children to 8 bits a plane"},
                                               stack};

constexpr RayStructureEntry table[] = {
    {"ray-bvh", "what the renderer casts rays through: up to 8 children a node, 8 triangles a leaf", 1,
     renderers_parameters, 8, true},
    {"bvh-2", "bounding volume hierarchy by the surface area heuristic, 2 children a node", 1, bvh_parameters,
     2},
    {"bvh-4", "the same tree collapsed to 4 children a node (Wald et al. 2008)", 1, bvh_parameters, 4},
    {"bvh-8", "the same tree collapsed to 8 children a node", 1, bvh_parameters, 8},
};

std::string_view name_of(std::string_view spec) {
    return spec.substr(0, spec.find(':'));
}

void check_leaves(const trace::TraceReader& trace, std::span<const std::uint32_t> begin) {
    if (begin.empty() || begin[0] != 0)
        refuse_row(trace.folder(), "tree_leaf_begin", 0,
                   begin.empty() ? "nothing" : fmt::format("{}", begin[0]), "0");
    for (std::size_t l = 0; l + 1 < begin.size(); ++l)
        if (begin[l + 1] <= begin[l] || begin[l + 1] - begin[l] > RayBvh::width)
            refuse_row(trace.folder(), "tree_leaf_begin", l + 1, fmt::format("{}", begin[l + 1]),
                       fmt::format("1 to {} more than {}", RayBvh::width, begin[l]));
}

/// Each element but the root is the child of one node that comes before it, so there is no cycle; nodes fill
/// their slots from the first one on, two at least.
void check_children(const trace::TraceReader& trace, std::span<const std::uint32_t> children,
                    std::uint32_t width, std::uint64_t leaves) {
    const std::uint64_t inner = children.size() / width;
    if (children.size() % width != 0 || (leaves <= 1 && inner > 0) || (leaves > 1 && inner == 0))
        refuse_row(trace.folder(), "tree_child", children.size(), fmt::format("{} rows", children.size()),
                   fmt::format("{} for each inner node of a tree with {} leaves", width, leaves));
    std::vector<bool> met(inner + leaves);
    std::uint64_t known = 0;
    for (std::uint64_t c = 0; c < children.size(); ++c) {
        const std::uint64_t child = children[c], slot = c % width;
        if (child == 0 ? slot < 2 : slot > 0 && children[c - 1] == 0)
            refuse_row(trace.folder(), "tree_child", c, fmt::format("{}", child),
                       "children from the first row of a node on, two at least");
        if (child == 0) continue;
        if (child >= inner + leaves || child <= c / width || met[child])
            refuse_row(trace.folder(), "tree_child", c, fmt::format("{}", child),
                       fmt::format("an element above {} and below {} that is no other's child", c / width,
                                   inner + leaves));
        met[child] = true;
        ++known;
    }
    if (inner > 0 && known + 1 != inner + leaves)
        refuse_row(trace.folder(), "tree_child", children.size(), fmt::format("{} children", known),
                   fmt::format("{}, all elements but the root", inner + leaves - 1));
}

}  // namespace

std::span<const RayStructureEntry> ray_structures() {
    return table;
}

bool is_ray_structure(std::string_view spec) {
    return std::any_of(std::begin(table), std::end(table),
                       [&](const RayStructureEntry& entry) { return entry.name == name_of(spec); });
}

RayStructureSpec parse_ray_structure(std::string_view spec) {
    const auto [which, behind] =
        trace::named_spec("structure of rays", spec, std::span<const RayStructureEntry>(table));
    const RayStructureEntry& entry = table[which];
    const trace::Parameters given(entry.name, entry.parameters, behind);
    RayStructureSpec parsed{
        &entry, {.node_width = entry.width}, given.given_count("stack"), std::string(entry.name)};
    const auto tell = [&](std::string_view parameter, std::uint32_t value) {
        parsed.text +=
            fmt::format("{}{}={}", parsed.text.size() == entry.name.size() ? ":" : ",", parameter, value);
    };
    if (!entry.renderers) {
        parsed.shape.leaf_triangles = given.count("leaf");
        trace::require_range(entry.name, "leaf", parsed.shape.leaf_triangles, 1, RayBvh::width);
        tell("leaf", parsed.shape.leaf_triangles);
        trace::require_range(entry.name, "quantised", given.count("quantised"), 0, 1);
        parsed.shape.quantised = given.count("quantised") == 1;
        if (parsed.shape.quantised) tell("quantised", 1);
    }
    if (parsed.stack_on_chip) {
        trace::require_range(entry.name, "stack", *parsed.stack_on_chip, 0, 512);
        tell("stack", *parsed.stack_on_chip);
    }
    return parsed;
}

RayBvh build(const RayStructureSpec& spec, std::span<const trace::Vec3> vertices,
             std::span<const TriangleIndices> triangles) {
    return spec.entry->renderers ? RayBvh(vertices, triangles) : RayBvh(vertices, triangles, spec.shape);
}

std::shared_ptr<const RayTree> tree_of(const RayStructureSpec& spec, const RayBvh& bvh, bool any_hit) {
    return std::make_shared<RayTree>(spec.text, shape_of(bvh, spec.entry->width, spec.shape.quantised),
                                     RayTree::Stack{spec.stack_on_chip, any_hit});
}

void store(const RayTree& tree, const RayBvh& bvh, trace::TraceWriter& writer) {
    writer.column("tree_child").append(std::span<const std::uint32_t>(tree.shape().children));
    writer.column("tree_leaf_begin").append(std::span<const std::uint32_t>(tree.shape().leaf_begin));
    trace::ColumnWriter& triangles = writer.column("tree_triangle");
    for (const RayBvh::Block& block : bvh.blocks())
        triangles.append(std::span<const std::uint32_t>(block.triangles, block.count));
}

std::shared_ptr<const Structure> open_ray_structure(trace::TraceReader& trace) {
    const std::string file = trace::shown((trace.folder() / "trace.json").string(), trace::most_shown_path);
    const RayStructureSpec spec = [&] {
        try {
            return parse_ray_structure(trace.info().structure);
        } catch (const trace::UsageError& error) {
            throw trace::DataError(fmt::format("{}: {}", file, error.what()));
        }
    }();
    if (trace.info().structure_version != spec.entry->version)
        throw trace::DataError(
            fmt::format("{}: structure_version: found {}, expected {}: walk the trace again (regather walk)",
                        file, trace.info().structure_version, spec.entry->version));
    const trace::Json* const kind = trace.info().parameters.find("rays");
    const auto known =
        std::find_if(trace::ray_kinds.begin(), trace::ray_kinds.end(),
                     [&](std::string_view name) { return kind && *kind == trace::Json(name); });
    if (known == trace::ray_kinds.end())
        throw trace::DataError(fmt::format("{}: parameters.rays: found {}, expected {}", file,
                                           kind ? trace::shown(kind->dump()) : "nothing",
                                           trace::alternatives(trace::ray_kinds)));
    const std::span<const std::uint32_t> children = trace.column<std::uint32_t>("tree_child"),
                                         begin = trace.column<std::uint32_t>("tree_leaf_begin");
    check_leaves(trace, begin);
    check_children(trace, children, spec.entry->width, begin.size() - 1);
    if (trace.has("tree_triangle"))
        if (const std::uint64_t places = trace.column<std::uint32_t>("tree_triangle").size();
            places != begin.back())
            refuse_row(trace.folder(), "tree_leaf_begin", begin.size() - 1, fmt::format("{}", begin.back()),
                       fmt::format("{} as the rows of tree_triangle", places));
    return std::make_shared<RayTree>(spec.text,
                                     RayTree::Shape{.width = spec.entry->width,
                                                    .children = {children.begin(), children.end()},
                                                    .leaf_begin = {begin.begin(), begin.end()},
                                                    .quantised = spec.shape.quantised},
                                     RayTree::Stack{spec.stack_on_chip, *known == "shadow"});
}

}  // namespace regather::spatial
