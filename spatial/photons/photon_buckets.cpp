#include "spatial/photons/photon_buckets.h"

#include <fmt/format.h>
#include <immintrin.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "trace/bounds.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

constexpr std::uint32_t lanes = 8;
constexpr std::size_t prune_slack = 8;   ///< A prune may keep so many more than k: found with fewer looks.
constexpr std::size_t least_spare = 64;  ///< Candidates beyond k that make a prune worth while.
constexpr std::uint32_t task_leaves = 512;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// For a mask of lanes: the numbers of its lanes in front.
constexpr auto make_packing() {
    std::array<std::array<std::uint8_t, lanes>, 256> table{};
    for (unsigned mask = 0; mask < 256; ++mask) {
        unsigned used = 0;
        for (std::uint8_t lane = 0; lane < lanes; ++lane)
            if (mask >> lane & 1) table[mask][used++] = lane;
    }
    return table;
}
constexpr auto packing = make_packing();

__m256i packing_of(unsigned mask) {
    return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(packing[mask].data())));
}

/// One layer of a sorting network: of each lane and its partner, the lane in `upper` gets the smaller.
template <int upper>
__m256i exchanged(__m256i keys, __m256i partners) {
    return _mm256_blend_epi32(_mm256_max_epi32(keys, partners), _mm256_min_epi32(keys, partners), upper);
}

/// Eight signed integers, greatest first: the network of 19 comparators in 6 layers (Knuth, volume 3,
/// section 5.3.4).
__m256i descending(__m256i keys) {
    keys = exchanged<0xcc>(keys, _mm256_shuffle_epi32(keys, 0x4e));
    keys = exchanged<0xf0>(keys, _mm256_permute2x128_si256(keys, keys, 1));
    keys = exchanged<0xaa>(keys, _mm256_shuffle_epi32(keys, 0xb1));
    keys = exchanged<0x30>(keys, _mm256_permute4x64_epi64(keys, 0xd8));
    keys =
        exchanged<0x50>(keys, _mm256_permutevar8x32_epi32(keys, _mm256_setr_epi32(0, 4, 2, 6, 1, 5, 3, 7)));
    return exchanged<0x54>(keys,
                           _mm256_permutevar8x32_epi32(keys, _mm256_setr_epi32(0, 2, 1, 4, 3, 6, 5, 7)));
}

/// The sum as trace::dot() forms it.
__m256 squared_length(__m256 x, __m256 y, __m256 z) {
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
}

/// From a coordinate to the intervals [min, max]; 0 inside. A NaN bound gives NaN: of two operands, max takes
/// the second when one is NaN.
__m256 outside(__m256 at, const float* min, const float* max) {
    const __m256 below = _mm256_max_ps(_mm256_setzero_ps(), _mm256_sub_ps(_mm256_load_ps(min), at));
    return _mm256_max_ps(_mm256_sub_ps(at, _mm256_load_ps(max)), below);
}

std::size_t count_within(const float* distances2, std::size_t count, float bound2) {
    const __m256 bound = _mm256_set1_ps(bound2);
    __m256i within = _mm256_setzero_si256();
    for (std::size_t i = 0; i < count; i += lanes)
        within = _mm256_sub_epi32(
            within, _mm256_castps_si256(_mm256_cmp_ps(_mm256_loadu_ps(distances2 + i), bound, _CMP_LE_OQ)));
    alignas(32) std::uint32_t part[lanes];
    _mm256_store_si256(reinterpret_cast<__m256i*>(part), within);
    return part[0] + part[1] + part[2] + part[3] + part[4] + part[5] + part[6] + part[7];
}

template <class Record>
void prefetch(const Record& record) {
    for (std::size_t at = 0; at < sizeof(Record); at += 64)
        _mm_prefetch(reinterpret_cast<const char*>(&record) + at, _MM_HINT_T0);
}

struct PlacedNode {
    Vec3 position;
    std::uint32_t node;
};

/// Orders the items such that each 16 are a bucket: halves at a power of two of buckets, as far as there are
/// any.
void split(std::span<PlacedNode> items) {
    constexpr std::size_t bucket = PhotonBuckets::bucket_photons;
    if (items.size() <= bucket) return;
    const std::size_t leaves = (items.size() + bucket - 1) / bucket;
    const std::size_t left = std::bit_ceil(leaves) / 2 * bucket;
    trace::Bounds3 box;
    for (const PlacedNode& item : items) box.include(item.position);
    const Vec3 side = box.extent();
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(left), items.end(),
                     [axis](const PlacedNode& a, const PlacedNode& b) {
                         const float x = a.position[axis], y = b.position[axis];
                         return x < y || (x == y && a.node < b.node);
                     });
    const std::span<PlacedNode> low = items.first(left), high = items.subspan(left);
    if (leaves > task_leaves)
        tbb::parallel_invoke([&] { split(low); }, [&] { split(high); });
    else
        split(low), split(high);
}

}  // namespace

PhotonBuckets::PhotonBuckets(std::span<const Photon> photons) {
    if (photons.size() >= std::size_t{1} << 31)
        throw trace::DataError(fmt::format("photons: found {}, expected fewer than 2^31", photons.size()));
    size_ = static_cast<std::uint32_t>(photons.size());
    std::vector<PlacedNode> items(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i) {
        if (!trace::is_finite(photons[i].position))
            throw trace::DataError(fmt::format("photon {}: found a position that is not finite", i));
        items[i] = {photons[i].position, static_cast<std::uint32_t>(i)};
    }
    split(items);
    leaves_.resize((items.size() + bucket_photons - 1) / bucket_photons);
    tbb::parallel_for(std::size_t{0}, leaves_.size(), [&](std::size_t number) {
        Leaf& leaf = leaves_[number];
        for (std::size_t lane = 0; lane < bucket_photons; ++lane) {
            const std::size_t i = number * bucket_photons + lane;
            const Vec3 at =
                i < items.size() ? items[i].position : Vec3{not_a_number, not_a_number, not_a_number};
            leaf.x[lane] = at.x;
            leaf.y[lane] = at.y;
            leaf.z[lane] = at.z;
            leaf.node[lane] = i < items.size() ? items[i].node : 0;
        }
    });
    add_boxes();
}

void PhotonBuckets::add_boxes() {
    std::vector<trace::Bounds3> boxes(leaves_.size());
    for (std::size_t number = 0; number < leaves_.size(); ++number)
        for (std::size_t lane = 0; lane < bucket_photons;
             ++lane)  // a comparison with NaN is false: not included
            boxes[number].include(
                Vec3{leaves_[number].x[lane], leaves_[number].y[lane], leaves_[number].z[lane]});

    std::vector<std::vector<Inner>> levels;  // from the leaves' parents up
    while (boxes.size() > 1) {
        std::vector<Inner> level((boxes.size() + fan_out - 1) / fan_out);
        std::vector<trace::Bounds3> around(level.size());
        for (std::size_t i = 0; i < level.size() * fan_out; ++i) {
            Inner& parent = level[i / fan_out];
            const bool exists = i < boxes.size();
            for (int axis = 0; axis < 3; ++axis) {
                parent.min[axis][i % fan_out] = exists ? boxes[i].min[axis] : not_a_number;
                parent.max[axis][i % fan_out] = exists ? boxes[i].max[axis] : not_a_number;
            }
            if (exists) around[i / fan_out].include(boxes[i]);
        }
        boxes = std::move(around);
        levels.push_back(std::move(level));
    }
    std::reverse(levels.begin(), levels.end());
    for (std::size_t level = 2; level < levels.size(); ++level)
        levels[level].resize(levels[level - 1].size() * fan_out);  // so that one rule finds all children
    for (const std::vector<Inner>& level : levels) inner_.insert(inner_.end(), level.begin(), level.end());
    if (levels.size() >= 2)
        child_offset_ = 1 + static_cast<std::int64_t>(levels[1].size()) - std::int64_t{fan_out};
}

Candidates::Candidates(std::uint32_t capacity, float radius)
    : capacity_(capacity),
      radius2_(radius * radius),
      prune_from_(capacity + std::max(least_spare, std::size_t{capacity} / 2)),
      distance2_(prune_from_ + PhotonBuckets::bucket_photons + lanes),
      node_(distance2_.size()) {}

void Candidates::clear() {
    count_ = 0;
    bound2_ = capacity_ == 0 ? -1.0f : radius2_;
}

void Candidates::keep_within(float distance2) {
    const __m256 bound = _mm256_set1_ps(distance2);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; i += lanes) {
        const __m256 distances = _mm256_loadu_ps(&distance2_[i]);
        const __m256i nodes = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(&node_[i]));
        const auto mask =
            static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(distances, bound, _CMP_LE_OQ)));
        const __m256i pack = packing_of(mask);
        _mm256_storeu_ps(&distance2_[kept], _mm256_permutevar8x32_ps(distances, pack));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(&node_[kept]),
                            _mm256_permutevar8x32_epi32(nodes, pack));
        kept += static_cast<std::size_t>(std::popcount(mask));
    }
    count_ = kept;
    bound2_ = std::min(bound2_, distance2);
}

void Candidates::select_exactly() {
    std::vector<std::uint64_t> keys(count_);
    for (std::size_t i = 0; i < count_; ++i)
        keys[i] = std::uint64_t{std::bit_cast<std::uint32_t>(distance2_[i])} << 32 | node_[i];
    std::nth_element(keys.begin(), keys.begin() + (capacity_ - 1), keys.end());
    count_ = capacity_;
    for (std::size_t i = 0; i < count_; ++i) {
        distance2_[i] = std::bit_cast<float>(static_cast<std::uint32_t>(keys[i] >> 32));
        node_[i] = static_cast<std::uint32_t>(keys[i]);
    }
    bound2_ = distance2_[capacity_ - 1];
}

// Looks for a bound that capacity to capacity + slack candidates are within. The number of photons on a
// surface grows with the squared distance, so the first guesses are by proportion; then the bits of the bound
// are halved.
void Candidates::prune(std::size_t slack) {
    _mm256_storeu_ps(&distance2_[count_], _mm256_set1_ps(not_a_number));
    __m256 greatest = _mm256_setzero_ps();
    for (std::size_t i = 0; i < count_; i += lanes)
        greatest =
            _mm256_max_ps(_mm256_loadu_ps(&distance2_[i]), greatest);  // of NaN and a number: the number
    alignas(32) float part[lanes];
    _mm256_store_ps(part, greatest);
    const float most = *std::max_element(part, part + lanes);

    // Fewer than capacity are within `low`, all are within `high`; distances as bits, which sort as they do.
    std::int32_t low = -1, high = std::bit_cast<std::int32_t>(most);
    double low_count = 0, high_count = static_cast<double>(count_), low_value = 0, high_value = most;
    const double wanted = static_cast<double>(capacity_) + static_cast<double>(slack) / 2;
    for (int look = 0; high - low > 1; ++look) {
        std::int32_t middle = low + (high - low) / 2;
        if (look < 8) {
            const double guess =
                low_value + (high_value - low_value) * ((wanted - low_count) / (high_count - low_count));
            if (guess < high_value)  // false for NaN
                middle =
                    std::clamp(std::bit_cast<std::int32_t>(static_cast<float>(guess)), low + 1, high - 1);
        }
        const float bound = std::bit_cast<float>(middle);
        const std::size_t within = count_within(distance2_.data(), count_, bound);
        if (within < capacity_) {
            low = middle;
            low_value = bound;
            low_count = static_cast<double>(within);
        } else if (within > capacity_ + slack) {
            high = middle;
            high_value = bound;
            high_count = static_cast<double>(within);
        } else {
            keep_within(bound);
            return;
        }
    }
    keep_within(std::bit_cast<float>(high));
    if (count_ > capacity_) select_exactly();  // ties
}

void Candidates::finish() {
    if (count_ > capacity_) prune(0);
}

void nearest(const PhotonBuckets& tree, Vec3 point, Candidates& found) {
    found.clear();
    if (tree.size() == 0 || found.capacity_ == 0 || !trace::is_finite(point)) return;
    const __m256 x = _mm256_set1_ps(point.x), y = _mm256_set1_ps(point.y), z = _mm256_set1_ps(point.z);
    const auto first_leaf = static_cast<std::int32_t>(tree.inner_.size());
    const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), number = _mm256_set1_epi32(lanes - 1);

    // What is still to be visited, the nearest of siblings on top: the bits of the squared distance to its
    // box, rounded down to make room for the number of the lane, and the node. Ten levels reach 2^31 photons;
    // a push writes all lanes.
    std::int32_t to_box[10 * lanes + lanes], node[10 * lanes + lanes];
    to_box[0] = 0;
    node[0] = 0;
    std::size_t pending = 1;
    while (pending != 0) {
        --pending;
        if (std::bit_cast<float>(to_box[pending] & ~7) > found.bound2_) continue;
        const std::int32_t at = node[pending];
        if (at < first_leaf) {
            const PhotonBuckets::Inner& inner = tree.inner_[static_cast<std::size_t>(at)];
            const __m256 distance2 =
                squared_length(outside(x, inner.min[0], inner.max[0]), outside(y, inner.min[1], inner.max[1]),
                               outside(z, inner.min[2], inner.max[2]));
            const __m256 reached = _mm256_cmp_ps(distance2, _mm256_set1_ps(found.bound2_), _CMP_LE_OQ);
            const __m256i keys =
                _mm256_or_si256(_mm256_andnot_si256(number, _mm256_castps_si256(distance2)), lane);
            const __m256i nearest_last =
                descending(_mm256_blendv_epi8(_mm256_set1_epi32(-1), keys, _mm256_castps_si256(reached)));
            const std::int64_t first = at == 0 ? 1 : std::int64_t{lanes} * at + tree.child_offset_;
            const __m256i children = _mm256_add_epi32(_mm256_set1_epi32(static_cast<std::int32_t>(first)),
                                                      _mm256_and_si256(nearest_last, number));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(to_box + pending), nearest_last);
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(node + pending), children);
            for (int left = std::popcount(static_cast<unsigned>(_mm256_movemask_ps(reached))); left > 0;
                 --left) {
                const std::int32_t child = node[pending++];
                if (child < first_leaf)
                    prefetch(tree.inner_[static_cast<std::size_t>(child)]);
                else
                    prefetch(tree.leaves_[static_cast<std::size_t>(child - first_leaf)]);
            }
            continue;
        }
        const PhotonBuckets::Leaf& leaf = tree.leaves_[static_cast<std::size_t>(at - first_leaf)];
        const __m256 bound = _mm256_set1_ps(found.bound2_);
        std::size_t count = found.count_;
        for (std::size_t i = 0; i < PhotonBuckets::bucket_photons; i += lanes) {
            const __m256 distance2 = squared_length(_mm256_sub_ps(x, _mm256_load_ps(leaf.x + i)),
                                                    _mm256_sub_ps(y, _mm256_load_ps(leaf.y + i)),
                                                    _mm256_sub_ps(z, _mm256_load_ps(leaf.z + i)));
            const auto mask =
                static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(distance2, bound, _CMP_LE_OQ)));
            const __m256i pack = packing_of(mask);
            const __m256i numbers = _mm256_load_si256(reinterpret_cast<const __m256i*>(leaf.node + i));
            _mm256_storeu_ps(found.distance2_.data() + count, _mm256_permutevar8x32_ps(distance2, pack));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(found.node_.data() + count),
                                _mm256_permutevar8x32_epi32(numbers, pack));
            count += static_cast<std::size_t>(std::popcount(mask));
        }
        found.count_ = count;
        if (count >= found.prune_from_) found.prune(prune_slack);
    }
    found.finish();
}

}  // namespace regather::spatial
