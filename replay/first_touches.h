// replay/first_touches.h -- the first touches of lines by each walk (WalkLines::first()), found once for a
// layout and held in memory: no order of the walks changes them, so a replay reads them and decodes no walk.
//
// Packed: of each walk the number of its lines, the lines counted from the layout's first one, and the ranks,
// both in as many bits as the greatest of the walk needs (replay/packed_numbers.h): 18 + 7 or 8 bits a line
// for a million photons of 20 bytes on lines of 128.
#pragma once
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "replay/layout.h"
#include "replay/packed_numbers.h"
#include "replay/replay.h"
#include "replay/walk_lines.h"
#include "replay/walk_store.h"

namespace regather::replay {

class FirstTouches {
public:
    /// Of all walks, for each of `line_sizes` (powers of two, each once), as far as they fit into
    /// `most_bytes`: the others are not held, and left to be decoded. On all cores. Throws as
    /// count_revisits().
    FirstTouches(const WalkStore& walks, const Layout& layout, std::span<const std::uint32_t> line_sizes,
                 std::uint64_t most_bytes, const QueriesDone& progress = {});

    std::span<const std::uint32_t> line_sizes() const { return line_sizes_; }
    bool holds(std::uint64_t query) const { return query < places_.size() && places_[query] != nullptr; }
    std::uint64_t held_queries() const { return held_queries_; }
    std::uint64_t bytes() const { return bytes_; }

    /// Of all walks, held or not.
    struct Totals {
        std::uint64_t visited_nodes = 0, raw_bytes = 0;  ///< As in Replayed.
        std::vector<std::uint64_t> accesses;             ///< As in CacheTraffic; by line size.
    };
    const Totals& totals() const { return totals_; }

    /// Start loading what read(query) will look at: its place first, some queries later its first lines.
    void prefetch_place(std::uint64_t query) const {
        if (query < places_.size()) __builtin_prefetch(&places_[query]);
    }
    void prefetch(std::uint64_t query) const {
        if (!holds(query)) return;
        for (std::size_t byte = 0; byte < 512; byte += 64) __builtin_prefetch(places_[query] + byte);
    }

    /// One thread at a time; outlived by the FirstTouches.
    class Reader {
    public:
        explicit Reader(const FirstTouches& of) : of_(of) {}
        /// Of a query that is held: calls use(s, first) for line_sizes()[s], in their order. `first` is valid
        /// until it returns.
        template <class Use>
        void read(std::uint64_t query, Use&& use) {
            const std::uint8_t* at = of_.places_[query];
            for (std::size_t s = 0; s < of_.line_sizes_.size(); ++s) {
                Head head;
                std::memcpy(&head, at, sizeof head);
                at += sizeof head;
                if (lines_.size() < head.lines) {
                    numbers_.resize(2 * head.lines + unpacked_padding);
                    ranks_.resize(2 * head.lines + unpacked_padding);
                    lines_.resize(2 * head.lines);
                }
                unpack(at, head.line_bits, head.lines, numbers_.data());
                at += packed_bytes(head.lines, head.line_bits);
                unpack(at, head.rank_bits, head.lines, ranks_.data());
                at += packed_bytes(head.lines, head.rank_bits);
                const std::uint64_t first_line = of_.first_lines_[s];
                for (std::size_t i = 0; i < head.lines; ++i)
                    lines_[i] = cachesim::Line{first_line + numbers_[i]};
                use(s, WalkLines::First{{lines_.data(), head.lines}, {ranks_.data(), head.lines}});
            }
        }

    private:
        const FirstTouches& of_;
        std::vector<std::uint32_t> numbers_, ranks_;
        std::vector<cachesim::Line> lines_;
    };

private:
    /// Before the lines and ranks of a walk.
    struct Head {
        std::uint32_t lines = 0;
        std::uint8_t line_bits = 0, rank_bits = 0;
        std::uint16_t unused = 0;
    };
    static_assert(sizeof(Head) == 8);
    class Maker;
    struct Free {
        void operator()(std::uint8_t* chunk) const;
    };

    std::vector<std::uint32_t> line_sizes_;
    std::vector<std::uint64_t> first_lines_;   // by line size: the layout's first
    std::vector<const std::uint8_t*> places_;  // by query: its first head, or null
    std::vector<std::unique_ptr<std::uint8_t[], Free>> chunks_;
    std::uint64_t bytes_ = 0, held_queries_ = 0;
    Totals totals_;
};

}  // namespace regather::replay
