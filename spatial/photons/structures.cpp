#include "spatial/photons/structures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "spatial/photons/bucket_kd.h"
#include "spatial/photons/found_walk.h"
#include "spatial/photons/left_balanced.h"
#include "spatial/photons/listed_search.h"
#include "spatial/photons/photon_kd.h"
#include "spatial/rays/ray_structures.h"
#include "spatial/refusal.h"
#include "trace/error.h"
#include "trace/range.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::spatial {
namespace {

constexpr std::string_view found_help = "1: walks tell which photons were found";
constexpr trace::Parameter heap_parameters[] = {{"found", "0", found_help}};
constexpr trace::Parameter leaf{"leaf", "8", "most photons of a leaf, 1 to 64"};
constexpr trace::Parameter bucket_parameters[] = {
    leaf,
    {"bounds", "0", "1: a subtree is passed over by its cell's distance, 0: by its plane's"},
    {"found", "0", found_help}};
constexpr trace::Parameter leaf_parameters[] = {leaf, {"found", "0", found_help}};

constexpr trace::Parameter cell_parameters[] = {
    {"cell", "8", "photons of a cell on average, 1 to 64; see docs/structures.md"},
    {"found", "0", found_help}};

constexpr trace::Parameter hashing_parameters[] = {
    {"tables", "16", "hash tables, 1 to 64"},
    {"block", "16", "photons of a block, 1 to 64"},
    {"blocks", "0", "most blocks that a search looks at, 1 to 1024; 0: all that its buckets name"},
    {"found", "0", found_help}};

struct Range {
    std::uint32_t least, most;
};
/// Of a parameter's values; 0 is that of a switch or limit that is not set.
Range range_of(std::string_view parameter) {
    if (parameter == "found" || parameter == "bounds") return {0, 1};
    if (parameter == "blocks") return {0, BlockHashing::most_tables * BlockHashing::most_named};
    return {1, 64};
}

bool tells_found(const trace::Parameters& given) {
    return given.knows("found") && given.count("found") == 1;
}

// The left-balanced tree.

template <class Tree>
class HeapSearch final : public PhotonSearch {
public:
    HeapSearch(std::span<const Photon> heap, bool tells_found, std::string text)
        : tree_(heap), structure_(std::make_shared<Tree>(tree_.size())), tells_found_(tells_found) {
        if (tells_found) structure_ = std::make_shared<WithFound>(structure_, std::move(text));
    }
    std::shared_ptr<const Structure> structure() const override { return structure_; }
    Recording record(std::span<const Vec3> points, std::uint32_t k, float radius,
                     bool tells_candidates) const override {
        Recording recording = record_walks(tree_, points, k, radius, {tells_found_, tells_candidates});
        if constexpr (std::same_as<Tree, StackFree>) recording.visited_nodes = visits(recording);
        return recording;
    }
    std::span<const std::uint32_t> photon_at() const override { return {}; }
    void store(trace::TraceWriter&) const override {}

private:
    /// What the walks decode to.
    std::uint64_t visits(const Recording& recording) const {
        const std::unique_ptr<WalkDecoder> decoder = structure_->decoder();
        std::span<const std::uint8_t> walks = recording.walks;
        std::uint64_t sum = 0;
        for (const std::uint32_t bytes : recording.walk_bytes) {
            sum += decoder->decode(walks.first(bytes)).elements.size();
            walks = walks.subspan(bytes);
        }
        return sum;
    }

    PhotonKd tree_;
    std::shared_ptr<const Structure> structure_;
    bool tells_found_;
};

template <class Tree>
std::unique_ptr<PhotonSearch> build_heap(std::span<const Photon> heap, const trace::Parameters& given,
                                         std::string text, std::uint32_t, float) {
    return std::make_unique<HeapSearch<Tree>>(heap, tells_found(given), std::move(text));
}

template <class Tree>
std::shared_ptr<const Structure> open_heap(trace::TraceReader& trace) {
    return std::make_shared<Tree>(static_cast<std::uint32_t>(trace.column<Photon>("photon").size()));
}

// Kd-trees with buckets.

class BucketSearch final : public PhotonSearch {
public:
    BucketSearch(std::span<const Photon> photons, const BucketKd::Config& config, bool tells_found,
                 std::string text)
        : tree_(photons, config, text), structure_(tree_.share_shape()), tells_found_(tells_found) {
        if (tells_found) structure_ = std::make_shared<WithFound>(structure_, std::move(text));
    }
    std::shared_ptr<const Structure> structure() const override { return structure_; }
    Recording record(std::span<const Vec3> points, std::uint32_t k, float radius,
                     bool tells_candidates) const override {
        return record_walks(tree_, points, k, radius, {tells_found_, tells_candidates});
    }
    std::span<const std::uint32_t> photon_at() const override { return tree_.photon_at(); }
    void store(trace::TraceWriter& writer) const override {
        writer.column("tree_child").append(tree_.shape().children());
        writer.column("tree_leaf_begin").append(tree_.shape().leaf_begin());
        writer.column("tree_photon").append(tree_.photon_at());
    }

private:
    BucketKd tree_;
    std::shared_ptr<const Structure> structure_;
    bool tells_found_;
};

/// What cells are grown by: the radius of the searches, or, without one, the median distance of the k-th
/// nearest photon of 256 photons.
float expected_radius(std::span<const Photon> heap, std::uint32_t k, float radius) {
    if (std::isfinite(radius) || heap.empty()) return std::isfinite(radius) ? radius : 0;
    constexpr std::size_t most_samples = 256;
    const PhotonKd tree(heap);
    const std::size_t samples = std::min(most_samples, heap.size());
    NearestSet found(std::min(k, tree.size()));
    std::vector<float> squares;
    for (std::size_t i = 0; i < samples; ++i) {
        nearest(tree, heap[i * heap.size() / samples].position, found);
        squares.push_back(found.disc_radius2());
    }
    std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(samples / 2),
                     squares.end());
    return std::sqrt(squares[samples / 2]);
}

template <SplitRule rule>
std::unique_ptr<PhotonSearch> build_buckets(std::span<const Photon> heap, const trace::Parameters& given,
                                            std::string text, std::uint32_t k, float radius) {
    return std::make_unique<BucketSearch>(
        heap,
        BucketKd::Config{.rule = rule,
                         .leaf_photons = given.count("leaf"),
                         .radius = rule == SplitRule::voxel_volume ? expected_radius(heap, k, radius) : 0,
                         .bounds = given.count("bounds") == 1},
        tells_found(given), std::move(text));
}

std::shared_ptr<const Structure> open_tree(trace::TraceReader& trace) {
    const std::uint64_t photons = trace.column<Photon>("photon").size();
    const std::span<const std::uint32_t> children = trace.column<std::uint32_t>("tree_child"),
                                         leaf_begin = trace.column<std::uint32_t>("tree_leaf_begin");
    const std::uint64_t inner = children.size() / 2, leaves = leaf_begin.empty() ? 0 : leaf_begin.size() - 1;
    if (leaf_begin.empty() || leaf_begin.front() != 0 || leaf_begin.back() != photons)
        refuse_row(trace.folder(), "tree_leaf_begin", leaf_begin.empty() ? 0 : leaf_begin.size() - 1,
                   leaf_begin.empty() ? "nothing" : fmt::format("{}", leaf_begin.back()),
                   fmt::format("0 to {}, the photons", photons));
    for (std::uint64_t l = 0; l < leaves; ++l)
        if (leaf_begin[l + 1] <= leaf_begin[l])
            refuse_row(trace.folder(), "tree_leaf_begin", l + 1, fmt::format("{}", leaf_begin[l + 1]),
                       fmt::format("more than {}", leaf_begin[l]));
    if (children.size() % 2 != 0 || inner != (leaves == 0 ? 0 : leaves - 1))
        throw trace::DataError(fmt::format("{}: found {} rows, expected {}, two for each leaf but one",
                                           (trace.folder() / "tree_child.npy").string(), children.size(),
                                           leaves == 0 ? 0 : 2 * (leaves - 1)));
    // Each element but the root is the child of one that comes before it, or a leaf; so there is no cycle.
    std::vector<bool> met(inner + leaves);
    for (std::uint64_t c = 0; c < children.size(); ++c) {
        const std::uint64_t child = children[c];
        if (child >= inner + leaves || child <= c / 2 || met[child])
            refuse_row(trace.folder(), "tree_child", c, fmt::format("{}", child),
                       fmt::format("an element above {} and below {} that is no other's child", c / 2,
                                   inner + leaves));
        met[child] = true;
    }
    return std::make_shared<PhotonTree>(trace.info().structure, std::vector(children.begin(), children.end()),
                                        std::vector(leaf_begin.begin(), leaf_begin.end()));
}

constexpr StructureEntry table[] = {
    {LeftBalanced::structure_name,
     "left-balanced kd-tree in an array, a photon a node (Jensen 2001); what a capture searches", 1,
     heap_parameters, build_heap<LeftBalanced>, open_heap<LeftBalanced>},
    {StackFree::structure_name,
     "the same tree searched without a stack: parents are read again on the way back (Wald 2022)",
     1,
     {},
     build_heap<StackFree>,
     open_heap<StackFree>},
    {"median-kd",
     "kd-tree with buckets: full leaves, split at the median of the longest side (Friedman et al. 1977)", 1,
     bucket_parameters, build_buckets<SplitRule::median>, open_tree},
    {"midpoint-kd",
     "kd-tree with buckets: the middle of the cell's longest side, sliding (Maneewongvatana & Mount 1999)", 1,
     bucket_parameters, build_buckets<SplitRule::midpoint>, open_tree},
    {"voxel-volume-kd",
     "kd-tree with buckets: least volume of cells grown by the search's radius (Wald et al. 2004)", 1,
     bucket_parameters, build_buckets<SplitRule::voxel_volume>, open_tree},
    {"grid", "uniform grid, searched in shells of cells; an entry a cell, as many as photons / cell", 1,
     cell_parameters, build_listed<PhotonGrid>, open_listed<PhotonGrid>},
    {"hashed-grid", "cells with photons in a hash table with open addressing, searched in shells", 1,
     cell_parameters, build_listed<HashedGrid>, open_listed<HashedGrid>},
    {"octree", "octree of pointers over photons in Morton order, nearest octant first", 1, leaf_parameters,
     build_listed<PhotonOctree>, open_listed<PhotonOctree>},
    {"bvh", "bounding volume hierarchy, halved along the longest side; a node holds both children's boxes", 1,
     leaf_parameters, build_listed<PhotonBvh>, open_listed<PhotonBvh>},
    {"block-hashing",
     "blocks of photons along a Hilbert curve, named by hash tables (Ma & McCool 2002); finds not all", 1,
     hashing_parameters, build_listed<BlockHashing>, open_listed<BlockHashing>, false},
    {brought_structure,
     "whatever another program has walked: elements and visits are columns (docs/bringing_walks.md)",
     1,
     {},
     nullptr,
     open_brought},
};

}  // namespace

std::span<const StructureEntry> structures() {
    return table;
}

StructureSpec parse_structure(std::string_view spec) {
    const auto [which, behind] = trace::named_spec("structure", spec, structures());
    const StructureEntry& entry = table[which];
    trace::Parameters parameters(entry.name, entry.parameters, behind);
    std::string text(entry.name);
    for (const trace::Parameter& parameter : entry.parameters) {
        const std::uint32_t value = parameters.count(parameter.name);
        const auto [least, most] = range_of(parameter.name);
        trace::require_range(entry.name, parameter.name, value, least, most);
        if (value == 0) continue;  // as if there were no such parameter
        text += fmt::format("{}{}={}", text.size() == entry.name.size() ? ":" : ",", parameter.name, value);
    }
    return {&entry, std::move(parameters), std::move(text)};
}

std::unique_ptr<PhotonSearch> build(const StructureSpec& spec, std::span<const Photon> heap, std::uint32_t k,
                                    float radius) {
    if (!spec.entry->build)
        throw trace::UsageError(fmt::format(
            "structure {}: found photons to search, expected columns of visits", spec.entry->name));
    return spec.entry->build(heap, spec.parameters, spec.text, k, radius);
}

std::shared_ptr<const Structure> open_structure(trace::TraceReader& trace) {
    if (is_ray_structure(trace.info().structure)) return open_ray_structure(trace);
    const std::string file = (trace.folder() / "trace.json").string();
    const StructureEntry* entry = nullptr;
    bool found = false;
    try {
        const StructureSpec spec = parse_structure(trace.info().structure);
        entry = spec.entry;
        found = tells_found(spec.parameters);
    } catch (const trace::UsageError& error) {
        throw trace::DataError(fmt::format("{}: {}", file, error.what()));
    }
    if (trace.info().structure_version != entry->version)
        throw trace::DataError(
            fmt::format("{}: structure_version: found {}, expected {}: walk the trace again (regather walk)",
                        file, trace.info().structure_version, entry->version));
    if (const std::uint64_t photons = entry->build ? trace.column<Photon>("photon").size() : 0;
        photons >= std::uint64_t{1} << 31)
        throw trace::DataError(fmt::format("{}: found {} rows, expected fewer than 2^31",
                                           (trace.folder() / "photon.npy").string(), photons));
    std::shared_ptr<const Structure> structure = entry->open(trace);
    if (found) structure = std::make_shared<WithFound>(std::move(structure), trace.info().structure);
    return structure;
}

std::vector<Vec3> record_positions(trace::TraceReader& trace) {
    if (!trace.has("photon")) return {};
    const std::span<const Photon> photons = trace.column<Photon>("photon");
    std::vector<Vec3> positions(photons.size());
    if (!trace.has("tree_photon")) {
        for (std::size_t i = 0; i < photons.size(); ++i) positions[i] = photons[i].position;
        return positions;
    }
    const std::span<const std::uint32_t> photon_at = trace.column<std::uint32_t>("tree_photon");
    for (std::size_t place = 0; place < photons.size(); ++place) {
        if (photon_at[place] >= photons.size())
            refuse_row(trace.folder(), "tree_photon", place, fmt::format("{}", photon_at[place]),
                       fmt::format("a photon below {}", photons.size()));
        positions[place] = photons[photon_at[place]].position;
    }
    return positions;
}

}  // namespace regather::spatial
