// Every line held is a node in two lists: its set's, from the line used last to the line used longest ago,
// and its hash bucket's. One access takes the same time whatever the ways.
#include <bit>
#include <vector>

#include "cachesim/engine.h"

namespace regather::cachesim {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

struct Node {
    std::uint64_t line;
    std::uint32_t newer, older;  // in the set
    std::uint32_t next;          // in the bucket
    std::uint32_t state;
};

struct Set {
    std::uint32_t newest = none, oldest = none, used = 0;
};

class ListEngine final : public LruCache::Engine {
public:
    explicit ListEngine(const CacheConfig& config)
        : ways_(config.ways == fully_associative ? config.size_bytes / config.line_bytes : config.ways),
          sets_(config.sets()) {
        grow(64);
    }

    void access(const Run& run, RegionStats& stats) override {
        const std::uint32_t dirty = dirty_by(run.region);
        std::uint64_t misses = 0;
        for (std::size_t i = 0; i < run.lines.size(); ++i) {
            const std::uint64_t line = static_cast<std::uint64_t>(run.lines[i]);
            Set& set = sets_[line & (sets_.size() - 1)];
            std::uint32_t node = find(line);
            if (node == none) {
                ++misses;
                node = fetch(line, set, stats);
            } else if (node != set.newest) {
                leave(set, node);
                enter(set, node);
            }
            if (run.kind(i) == Access::write) nodes_[node].state = dirty;
        }
        stats[static_cast<std::size_t>(run.region)].misses += misses;
    }

    void flush(RegionStats& stats) override {
        for (const Node& node : nodes_) write_back(node, stats);
        nodes_.clear();
        std::fill(sets_.begin(), sets_.end(), Set{});
        std::fill(buckets_.begin(), buckets_.end(), none);
    }

private:
    std::uint32_t& bucket(std::uint64_t line) { return buckets_[line * 0x9e3779b97f4a7c15 >> bucket_shift_]; }

    std::uint32_t find(std::uint64_t line) {
        std::uint32_t node = bucket(line);
        while (node != none && nodes_[node].line != line) node = nodes_[node].next;
        return node;
    }

    /// A node for a line that is not held: the set's oldest if the set is full.
    std::uint32_t fetch(std::uint64_t line, Set& set, RegionStats& stats) {
        std::uint32_t node;
        if (set.used == ways_) {
            node = set.oldest;
            write_back(nodes_[node], stats);
            leave(set, node);
            std::uint32_t* link = &bucket(nodes_[node].line);
            while (*link != node) link = &nodes_[*link].next;
            *link = nodes_[node].next;
        } else {
            ++set.used;
            if (nodes_.size() == buckets_.size()) grow(2 * buckets_.size());
            node = static_cast<std::uint32_t>(nodes_.size());
            nodes_.emplace_back();
        }
        nodes_[node].line = line;
        nodes_[node].state = clean;
        std::uint32_t& first = bucket(line);
        nodes_[node].next = first;
        first = node;
        enter(set, node);
        return node;
    }

    void leave(Set& set, std::uint32_t node) {
        const auto [newer, older] = std::pair(nodes_[node].newer, nodes_[node].older);
        (newer == none ? set.newest : nodes_[newer].older) = older;
        (older == none ? set.oldest : nodes_[older].newer) = newer;
    }

    void enter(Set& set, std::uint32_t node) {
        nodes_[node].newer = none;
        nodes_[node].older = set.newest;
        (set.newest == none ? set.oldest : nodes_[set.newest].newer) = node;
        set.newest = node;
    }

    static void write_back(const Node& node, RegionStats& stats) {
        if (node.state != clean) ++stats[node.state - 1].writebacks;
    }

    void grow(std::size_t bucket_count) {
        buckets_.assign(bucket_count, none);
        bucket_shift_ = 64 - std::countr_zero(bucket_count);
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            std::uint32_t& first = bucket(nodes_[i].line);
            nodes_[i].next = first;
            first = i;
        }
    }

    std::uint64_t ways_;
    std::vector<Set> sets_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> buckets_;
    int bucket_shift_ = 0;
};

}  // namespace

std::unique_ptr<LruCache::Engine> make_list_engine(const CacheConfig& config) {
    return std::make_unique<ListEngine>(config);
}

}  // namespace regather::cachesim
