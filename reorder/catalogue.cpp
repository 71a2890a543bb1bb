#include "reorder/catalogue.h"

#include <fmt/format.h>

#include <algorithm>

#include "reorder/curve_sorted.h"
#include "reorder/direction_binned.h"
#include "reorder/hashed.h"
#include "reorder/leaf_sorted.h"
#include "reorder/naive.h"
#include "reorder/random.h"
#include "reorder/ray_sorted.h"
#include "reorder/shared_library.h"
#include "reorder/tiled.h"
#include "trace/error.h"
#include "trace/range.h"
#include "trace/text.h"
#include "trace/word.h"

namespace regather::reorder {
namespace {

constexpr Parameter tile{"tile", "16", "edge of a square tile [pixels], 1 to 65536"};
constexpr Parameter optional_tile{
    "tile", "", "edge of a square tile [pixels], 1 to 65536; none: the whole image at once"};
constexpr Parameter curve_bits{"bits", "", "of the code, an axis, 1 to 21; default 21, in tiles 16"};
constexpr Parameter bins{"bins", "16", "n x n direction bins of equal solid angle: n, 1 to 4096"};
constexpr Parameter passes{"passes", "", "over a tile, 1 to bins x bins, which is the default"};
constexpr Parameter state{"state", "store",
                          "what later passes need of a pixel: store | recast (its eye ray)"};
constexpr Parameter buckets{"buckets", "512", "number of buckets; buckets x capacity at most 2^26"};
constexpr Parameter capacity{"capacity", "64", "queries a bucket holds"};
constexpr Parameter cells{"cells", "16", "of the hash grid along the longest axis, 1 to 2097152"};

constexpr Parameter random_parameters[] = {{"seed", "1", "a whole number"}};
constexpr Parameter tiled_parameters[] = {
    tile, {"rows", "left-to-right", "of a tile: left-to-right | alternating"}};
constexpr Parameter direction_parameters[] = {tile, bins, passes, state};
constexpr Parameter curve_parameters[] = {optional_tile, curve_bits};
constexpr Parameter swizzle_parameters[] = {optional_tile, {"bits", "4", "top bits taken, an axis, 1 to 8"}};
constexpr Parameter hashed_parameters[] = {buckets, capacity, cells};
constexpr Parameter direction_hashed_parameters[] = {tile, bins, passes, state, buckets, capacity, cells};
constexpr Parameter leaf_parameters[] = {optional_tile};
constexpr Parameter origin_direction_parameters[] = {optional_tile,
                                                     {"bits", "8", "of a coordinate of the key, 1 to 12"}};
constexpr Parameter origin_end_parameters[] = {optional_tile,
                                               {"bits", "8", "of a coordinate of the key, 1 to 10"}};

using Made = std::unique_ptr<Ordering>;

Made make_naive(Parameters&) {
    return std::make_unique<Naive>();
}

Made make_random(Parameters& given) {
    return std::make_unique<Random>(given.number("seed"));
}

Made make_tiled(Parameters& given) {
    return std::make_unique<Tiled>(
        TiledConfig{.tile = given.count("tile"),
                    .rows = given.choice("rows", {"left-to-right", "alternating"}) == 0 ? Rows::left_to_right
                                                                                        : Rows::alternating});
}

DirectionBinnedConfig direction_config(Parameters& given) {
    DirectionBinnedConfig config;
    config.tile = given.count("tile");
    config.bins = given.count("bins");
    trace::require_range("direction-binned", "bins", config.bins, 1, max_bins);  // its square is a default
    config.passes = given.count_or("passes", config.bins * config.bins);
    trace::require_range("direction-binned", "passes", config.passes, 1,
                         config.bins * config.bins);  // 0 means all to the class
    config.state = given.choice("state", {"store", "recast"}) == 0 ? PixelState::store : PixelState::recast;
    return config;
}

HashedConfig hashed_config(Parameters& given) {
    return {.buckets = given.count("buckets"),
            .capacity = given.count("capacity"),
            .cells = given.count("cells")};
}

Made make_direction_binned(Parameters& given) {
    return std::make_unique<DirectionBinned>(direction_config(given));
}

Made make_hashed(Parameters& given) {
    return std::make_unique<Hashed>(hashed_config(given));
}

Made make_direction_binned_hashed(Parameters& given) {
    return std::make_unique<DirectionBinnedHashed>(direction_config(given), hashed_config(given));
}

template <Curve curve>
Made make_curve(Parameters& given) {
    const auto edge = given.given_count("tile");
    return std::make_unique<CurveSorted>(
        CurveSortedConfig{.curve = curve, .tile = edge, .bits = given.count_or("bits", edge ? 16 : 21)});
}

template <LeafColumn column>
Made make_leaf(Parameters& given) {
    return std::make_unique<LeafSorted>(
        LeafSortedConfig{.column = column, .tile = given.given_count("tile")});
}

template <RayKey key>
Made make_ray(Parameters& given) {
    return std::make_unique<RaySorted>(
        RaySortedConfig{.key = key, .tile = given.given_count("tile"), .bits = given.count("bits")});
}

constexpr Entry entries[] = {
    {"naive", "capture order: pixels in row order", {}, make_naive},
    {"random", "random order, the worst case", random_parameters, make_random},
    {"tiled", "square tiles, each in row order", tiled_parameters, make_tiled},
    {"direction-binned", "several passes over a tile, each with gather rays of like direction",
     direction_parameters, make_direction_binned},
    {"hilbert", "sorted along a Hilbert curve", curve_parameters, make_curve<Curve::hilbert>},
    {"morton", "sorted along a Morton curve", curve_parameters, make_curve<Curve::morton>},
    {"swizzle", "sorted by a few interleaved top bits", swizzle_parameters, make_curve<Curve::swizzle>},
    {"hashed", "through bounded buckets by position, fullest first", hashed_parameters, make_hashed},
    {"direction-binned+hashed", "direction-binned, then hashed", direction_hashed_parameters,
     make_direction_binned_hashed},
    {"kd-leaf", "sorted by the leaf of the kd-tree that the gather ray ended in", leaf_parameters,
     make_leaf<LeafColumn::kd>},
    {"bvh-leaf", "sorted by the leaf of the BVH that the gather ray ended in", leaf_parameters,
     make_leaf<LeafColumn::bvh>},
    {"origin-direction", "rays sorted by origin and direction", origin_direction_parameters,
     make_ray<RayKey::origin_direction>},
    {"origin-end", "rays sorted by origin and end point", origin_end_parameters,
     make_ray<RayKey::origin_end>},
    {"origin-guess", "rays sorted by origin and the end that a coarse model gives", origin_end_parameters,
     make_ray<RayKey::origin_guess>},
};

ParsedOrdering load_library(std::string_view path, std::string_view parameters) {
    auto library = std::make_unique<SharedLibrary>(path, std::string(parameters));
    OrderingSpec spec{.name = library->name(), .tile = {}, .bins = {}, .text = library->name()};
    if (!parameters.empty()) spec.text += fmt::format(":{}", parameters);
    return {std::move(spec), std::move(library)};
}

}  // namespace

std::span<const Entry> catalogue() {
    return entries;
}

ParsedOrdering parse_ordering(std::string_view spec) {
    // A library's directory may hold a colon; what follows ".so:" is its parameters.
    const std::size_t library = spec.find(".so:");
    const std::size_t colon =
        library != std::string_view::npos ? library + 3 : std::min(spec.find(':'), spec.size());
    const std::string_view name = spec.substr(0, colon);
    const std::string_view text = spec.substr(std::min(colon + 1, spec.size()));
    if (name.find('/') != std::string_view::npos || name.ends_with(".so")) return load_library(name, text);

    const auto entry = std::find_if(std::begin(entries), std::end(entries),
                                    [name](const Entry& known) { return known.name == name; });
    if (entry == std::end(entries)) {
        std::vector<std::string_view> names;
        for (const Entry& known : entries) names.push_back(known.name);
        throw trace::UsageError(fmt::format("unknown ordering {}; nearest: {}; known: {}",
                                            trace::in_quotes(name), trace::nearest_words(name, names).front(),
                                            trace::listed(names)));
    }
    Parameters parameters(name, entry->parameters, text);
    ParsedOrdering parsed;
    parsed.ordering = entry->make(parameters);
    const auto has = [entry](std::string_view wanted) {
        return std::any_of(entry->parameters.begin(), entry->parameters.end(),
                           [wanted](const Parameter& known) { return known.name == wanted; });
    };
    parsed.spec.name = name;
    if (has("tile")) parsed.spec.tile = parameters.given_count("tile");
    if (has("bins")) parsed.spec.bins = parameters.given_count("bins");
    parsed.spec.text = parsed.spec.name;
    if (const std::string values = parameters.text(); !values.empty()) parsed.spec.text += ":" + values;
    return parsed;
}

std::unique_ptr<Ordering> make_ordering(std::string_view spec) {
    return parse_ordering(spec).ordering;
}

}  // namespace regather::reorder
