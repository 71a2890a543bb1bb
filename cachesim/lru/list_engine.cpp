// Every line held is in a chain of a hash table and in its set's list in order of use. One access takes the
// same time whatever the ways.
#include <vector>

#include "cachesim/line_chains.h"
#include "cachesim/lru/engine.h"
#include "cachesim/recency_list.h"

namespace regather::cachesim {

namespace {

struct Node : Links {
    std::uint64_t line = 0;
    std::uint32_t state = clean;
};

struct Set : RecencyList {
    std::uint32_t used = 0;
};

class ListEngine final : public LruCache::Engine {
public:
    explicit ListEngine(const CacheConfig& config)
        : ways_(config.ways == fully_associative ? config.size_bytes / config.line_bytes : config.ways),
          sets_(config.sets()) {
        held_.resize(64);
    }

    void access(const Run& run, RegionStats& stats) override {
        const std::uint32_t dirty = dirty_by(run.region);
        std::uint64_t misses = 0;
        for (std::size_t i = 0; i < run.lines.size(); ++i) {
            const std::uint64_t line = static_cast<std::uint64_t>(run.lines[i]);
            Set& set = sets_[line & (sets_.size() - 1)];
            std::uint32_t node = held_.find(line, [&](std::uint32_t at) { return nodes_[at].line; });
            if (node == no_entry) {
                ++misses;
                node = fetch(line, set, stats);
            } else {
                set.renew(nodes_, node);
            }
            if (run.kind(i) == Access::write) nodes_[node].state = dirty;
        }
        stats[static_cast<std::size_t>(run.region)].misses += misses;
    }

    void flush(RegionStats& stats) override {
        for (const Node& node : nodes_) write_back(node, stats);
        nodes_.clear();
        sets_.assign(sets_.size(), {});
        held_.clear();
    }

private:
    /// A node for a line that is not held: the set's oldest if the set is full.
    std::uint32_t fetch(std::uint64_t line, Set& set, RegionStats& stats) {
        std::uint32_t node;
        if (set.used == ways_) {
            node = set.oldest;
            write_back(nodes_[node], stats);
            set.leave(nodes_, node);
            held_.erase(nodes_[node].line, node);
        } else {
            ++set.used;
            if (nodes_.size() == held_.entries()) grow();
            node = static_cast<std::uint32_t>(nodes_.size());
            nodes_.emplace_back();
        }
        nodes_[node].line = line;
        nodes_[node].state = clean;
        held_.enter(line, node);
        set.enter(nodes_, node);
        return node;
    }

    void grow() {
        held_.resize(2 * nodes_.size());
        for (std::uint32_t node = 0; node < nodes_.size(); ++node) held_.enter(nodes_[node].line, node);
    }

    static void write_back(const Node& node, RegionStats& stats) {
        if (node.state != clean) ++stats[node.state - 1].writebacks;
    }

    std::uint64_t ways_;
    std::vector<Set> sets_;
    std::vector<Node> nodes_;
    LineChains held_;
};

}  // namespace

std::unique_ptr<LruCache::Engine> make_list_engine(const CacheConfig& config) {
    return std::make_unique<ListEngine>(config);
}

}  // namespace regather::cachesim
