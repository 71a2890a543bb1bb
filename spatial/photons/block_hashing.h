// spatial/photons/block_hashing.h -- photons in blocks along a Hilbert curve, which several hash tables name
// (Ma & McCool, "Low Latency Photon Mapping Using Block Hashing", Graphics Hardware 2002; hash tables after
// Gionis, Indyk & Motwani, "Similarity Search in High Dimensions via Hashing", 1999). Each table has its own
// thresholds along each axis, drawn so that as many photons lie between any two; a position's bucket is the
// box between thresholds that it lies in. A bucket names the blocks with photons in it. A search reads one
// bucket a table and looks at the photons of the blocks they name: no step waits for the one before, and
// photons in other blocks are missed.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "spatial/listed.h"
#include "spatial/photons/photon_parts.h"

namespace regather::spatial {

/// Elements: the buckets of Region::directory, table by table, x first, then y and z; then the blocks, along
/// the curve, each below the bucket of its first photon in the first table.
class BlockHashing {
public:
    struct Config {
        std::uint32_t tables = 16;  ///< 1 to most_tables. The first of more are the same as fewer.
        std::uint32_t block = 16;   ///< Photons of a block, but for the last one; 1 to 64.
        std::uint32_t blocks = 0;   ///< Most that a search looks at; 0: all that its buckets name.
    };
    static constexpr std::uint32_t most_tables = 64,
                                   most_named = 16;              ///< Blocks that a bucket names.
    static constexpr std::uint32_t node_bytes = 4 * most_named;  ///< Of a bucket.

    /// The i-th photon is node i of what a search finds. Along each axis a table has one threshold less than
    /// the cube root of the number of blocks, rounded up; position j of these is a coordinate drawn from the
    /// j-th of as many equal parts of all photons' coordinates in order. Of more than most_named blocks a
    /// bucket names those with the most photons in it, of as many the smaller numbers. Throws as
    /// check_photons(), and trace::DataError for 2^31 elements or more.
    BlockHashing(std::span<const Photon> photons, const Config& config, std::string name = "block-hashing");

    std::shared_ptr<const Listed> share_structure() const { return structure_; }
    /// The blocks.
    const PhotonParts& parts() const { return parts_; }
    std::uint32_t size() const { return parts_.size(); }
    std::uint32_t tables() const { return config_.tables; }
    /// Of each table.
    std::uint32_t buckets() const { return along_ * along_ * along_; }
    /// Ascending; a coordinate lies behind as many as are not above it.
    std::span<const float> thresholds(std::uint32_t table, int axis) const {
        return std::span(thresholds_)
            .subspan((std::size_t{table} * 3 + static_cast<std::size_t>(axis)) * (along_ - 1), along_ - 1);
    }
    /// The element that a finite position hashes to.
    std::uint32_t bucket(std::uint32_t table, Vec3 position) const;
    /// Most photons first.
    std::span<const std::uint32_t> named(std::uint32_t bucket) const {
        return std::span(named_).subspan(first_named_[bucket],
                                         first_named_[bucket + 1] - first_named_[bucket]);
    }
    /// Of blocks that one bucket of each table names: those that most name first, of as many the smaller
    /// number; cut at Config::blocks. `blocks` is what the buckets name, one behind the other, and becomes
    /// the result.
    void choose(std::vector<std::uint32_t>& blocks) const;

private:
    Config config_;
    std::uint32_t along_ = 1;  // buckets along an axis
    PhotonParts parts_;
    std::vector<float> thresholds_;
    std::vector<std::uint32_t> first_named_, named_;  // by bucket, and one more; blocks
    std::shared_ptr<const Listed> structure_;
};

/// Fills `found` with the nearest photons of `point` among those of the blocks that are looked at; equal
/// distances by number. The listener is told a bucket of each table, then the blocks.
template <class Listener = Unheard>
void nearest(const BlockHashing& hashing, Vec3 point, NearestSet& found, Listener&& listener = {}) {
    found.clear();
    if (hashing.size() == 0 || !trace::is_finite(point)) return;
    std::vector<std::uint32_t> blocks;
    blocks.reserve(std::size_t{hashing.tables()} * BlockHashing::most_named);
    for (std::uint32_t table = 0; table < hashing.tables(); ++table) {
        const std::uint32_t bucket = hashing.bucket(table, point);
        listener.visit(bucket);
        const std::span<const std::uint32_t> named = hashing.named(bucket);
        blocks.insert(blocks.end(), named.begin(), named.end());
    }
    hashing.choose(blocks);
    const std::uint32_t first_block = hashing.tables() * hashing.buckets();
    for (const std::uint32_t block : blocks)
        hashing.parts().read(block, first_block + block, point, found, listener);
}

}  // namespace regather::spatial
