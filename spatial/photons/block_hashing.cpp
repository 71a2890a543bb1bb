#include "spatial/photons/block_hashing.h"

#include <Random123/philox.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <utility>

#include "spatial/curve.h"
#include "spatial/photons/photon_grid.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

/// Photons by their place on the curve; of one place by number.
std::vector<std::uint32_t> along_curve(std::span<const Photon> photons) {
    trace::Bounds3 box;
    for (const Photon& photon : photons) box.include(photon.position);
    const CellGrid cells(box, 1u << max_curve_bits);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> coded;
    coded.reserve(photons.size());
    for (std::uint32_t i = 0; i < photons.size(); ++i)
        coded.emplace_back(hilbert_code(morton_code(cells.cell_of(photons[i].position)), max_curve_bits), i);
    std::sort(coded.begin(), coded.end());
    std::vector<std::uint32_t> order;
    order.reserve(coded.size());
    for (const auto& [code, photon] : coded) order.push_back(photon);
    return order;
}

std::uint32_t cube_root_up(std::uint64_t x) {
    std::uint64_t root = 1;
    while (root * root * root < x) ++root;
    return static_cast<std::uint32_t>(root);
}

/// One of all coordinates from each of `count` equal parts of them; `sorted` holds as many or more.
std::vector<float> drawn(std::span<const float> sorted, std::uint32_t count, std::uint32_t table,
                         std::uint32_t axis) {
    std::vector<float> thresholds;
    for (std::uint32_t j = 0; j < count; ++j) {
        const std::uint64_t begin = std::uint64_t{sorted.size()} * j / count,
                            end = std::uint64_t{sorted.size()} * (j + 1) / count;
        const std::uint64_t bits = r123::Philox4x32()({{j, axis, table, 0}}, {{0, 0}})[0];
        thresholds.push_back(sorted[begin + (bits * (end - begin) >> 32)]);
    }
    return thresholds;
}

/// The blocks that the buckets of a table name.
struct Table {
    std::vector<std::uint32_t> count;  // by bucket
    std::vector<std::uint32_t> named;
};

/// `in_bucket`: of each photon of the blocks, bucket << 32 | block.
Table named_by(std::vector<std::uint64_t> in_bucket, std::uint32_t buckets) {
    std::sort(in_bucket.begin(), in_bucket.end());
    Table table;
    table.count.resize(buckets);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> blocks;  // of one bucket: ~photons, block
    for (std::size_t i = 0; i < in_bucket.size();) {
        const auto bucket = static_cast<std::uint32_t>(in_bucket[i] >> 32);
        blocks.clear();
        while (i < in_bucket.size() && in_bucket[i] >> 32 == bucket) {
            const std::size_t first = i;
            while (i < in_bucket.size() && in_bucket[i] == in_bucket[first]) ++i;
            blocks.emplace_back(~static_cast<std::uint32_t>(i - first),
                                static_cast<std::uint32_t>(in_bucket[first]));
        }
        std::sort(blocks.begin(), blocks.end());
        if (blocks.size() > BlockHashing::most_named) blocks.resize(BlockHashing::most_named);
        table.count[bucket] = static_cast<std::uint32_t>(blocks.size());
        for (const auto& [photons, block] : blocks) table.named.push_back(block);
    }
    return table;
}

}  // namespace

BlockHashing::BlockHashing(std::span<const Photon> photons, const Config& config, std::string name)
    : config_(config) {
    check_photons(photons);
    const std::vector<std::uint32_t> order = along_curve(photons);
    for (std::size_t at = 0; at < order.size(); at += config.block)
        parts_.add(std::span(order).subspan(at, std::min<std::size_t>(config.block, order.size() - at)),
                   photons);
    along_ = cube_root_up(parts_.count());
    const std::uint64_t elements = std::uint64_t{config.tables} * along_ * along_ * along_ + parts_.count();
    if (elements >= std::uint64_t{1} << 31)
        throw trace::DataError(
            fmt::format("{}: found {} buckets and blocks, expected fewer than 2^31", name, elements));

    std::array<std::vector<float>, 3> sorted;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<float>& all = sorted[static_cast<std::size_t>(axis)];
        for (const Photon& photon : photons) all.push_back(photon.position[axis]);
        std::sort(all.begin(), all.end());
    }
    for (std::uint32_t table = 0; table < config.tables; ++table)
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const std::vector<float> own = drawn(sorted[axis], along_ - 1, table, axis);
            thresholds_.insert(thresholds_.end(), own.begin(), own.end());
        }

    std::vector<Table> tables(config.tables);
    tbb::parallel_for(std::uint32_t{0}, config.tables, [&](std::uint32_t t) {
        std::vector<std::uint64_t> in_bucket;
        in_bucket.reserve(photons.size());
        for (std::uint32_t place = 0; place < order.size(); ++place) {
            const std::uint32_t own = bucket(t, photons[order[place]].position) - t * buckets();
            in_bucket.push_back(std::uint64_t{own} << 32 | place / config.block);
        }
        tables[t] = named_by(std::move(in_bucket), buckets());
    });
    first_named_.push_back(0);
    for (const Table& table : tables) {
        for (const std::uint32_t count : table.count) first_named_.push_back(first_named_.back() + count);
        named_.insert(named_.end(), table.named.begin(), table.named.end());
    }

    std::vector<std::uint32_t> above;
    for (std::uint32_t block = 0; block < parts_.count(); ++block)
        above.push_back(bucket(0, photons[order[parts_.begin()[block]]].position));
    structure_ = directory_structure(std::move(name), photons.empty() ? 0 : config.tables * buckets(), above,
                                     parts_, node_bytes);
}

std::uint32_t BlockHashing::bucket(std::uint32_t table, Vec3 position) const {
    std::uint32_t own = 0;
    for (int axis = 2; axis >= 0; --axis) {
        const std::span<const float> planes = thresholds(table, axis);
        own = own * along_ +
              static_cast<std::uint32_t>(std::upper_bound(planes.begin(), planes.end(), position[axis]) -
                                         planes.begin());
    }
    return table * buckets() + own;
}

void BlockHashing::choose(std::vector<std::uint32_t>& blocks) const {
    std::sort(blocks.begin(), blocks.end());
    std::array<std::uint64_t, std::size_t{most_tables} * most_named> ranked;  // by ~tables, block
    std::size_t count = 0;
    for (std::size_t i = 0; i < blocks.size();) {
        const std::size_t first = i;
        while (i < blocks.size() && blocks[i] == blocks[first]) ++i;
        ranked[count++] = std::uint64_t{most_tables - (i - first)} << 32 | blocks[first];
    }
    std::sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count));
    if (config_.blocks > 0) count = std::min<std::size_t>(count, config_.blocks);
    blocks.resize(count);
    for (std::size_t i = 0; i < count; ++i) blocks[i] = static_cast<std::uint32_t>(ranked[i]);
}

}  // namespace regather::spatial
