// replay/walk_store.h -- the walks of a trace by query: where each starts, without a table of 8 bytes a
// query.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "spatial/structure.h"
#include "trace/folder.h"

namespace regather::replay {

/// Views into a trace; outlived by its reader. Memory of its own: half a byte a query.
class WalkStore {
public:
    /// Throws trace::DataError when the lengths do not add up to the bytes there are.
    explicit WalkStore(trace::TraceReader& trace);
    /// `file`: where the walks are from, for messages.
    WalkStore(std::shared_ptr<const spatial::Structure> structure, std::span<const std::uint32_t> walk_bytes,
              std::span<const std::uint8_t> walks, std::string file = "walk.npy");

    std::uint64_t queries() const { return walk_bytes_.size(); }
    const spatial::Structure& structure() const { return *structure_; }
    const std::string& file() const { return file_; }
    std::span<const std::uint8_t> walk(std::uint64_t query) const {
        std::uint64_t start = block_start_[query / block_queries];
        for (std::uint64_t q = query / block_queries * block_queries; q < query; ++q) start += walk_bytes_[q];
        return walks_.subspan(start, walk_bytes_[query]);
    }
    /// Starts loading what walk(query) will read.
    void prefetch(std::uint64_t query) const {
        __builtin_prefetch(&walk_bytes_[query / block_queries * block_queries]);
        __builtin_prefetch(&block_start_[query / block_queries]);
    }

private:
    static constexpr std::uint64_t block_queries = 16;
    std::shared_ptr<const spatial::Structure> structure_;
    std::span<const std::uint32_t> walk_bytes_;
    std::span<const std::uint8_t> walks_;
    std::vector<std::uint64_t> block_start_;
    std::string file_;
};

}  // namespace regather::replay
