#include "replay/treelet_queues.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <memory>
#include <vector>

#include "replay/layouts/catalogue.h"
#include "replay/treelets.h"
#include "replay/walk_run.h"
#include "trace/error.h"

namespace regather::replay {
namespace {

using cachesim::Access;

constexpr std::uint64_t alignment = 4096;

std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + alignment - 1) / alignment * alignment;
}

/// The same hierarchy, no entry of whose stack is on chip: its decoder tells of each.
spatial::RayTree with_whole_stack(const spatial::RayTree& tree) {
    return {"treelets", tree.shape(), {.on_chip = 0, .any_hit = tree.stack().any_hit}};
}

/// Which of many counts is the greatest, the first of equals: a tournament.
class Greatest {
public:
    explicit Greatest(std::uint32_t counts) : first_(std::bit_ceil(std::max(counts, 1u))), counts_(first_) {
        winner_.resize(2 * std::size_t{first_});
        for (std::uint32_t c = 0; c < first_; ++c) winner_[first_ + c] = c;
        for (std::uint32_t node = first_; node-- > 1;) winner_[node] = winner_[2 * node];
    }
    std::uint32_t place() const { return winner_[1]; }
    std::uint64_t count() const { return counts_[place()]; }
    void set(std::uint32_t place, std::uint64_t count) {
        counts_[place] = count;
        for (std::uint32_t node = (first_ + place) / 2; node > 0; node /= 2) {
            const std::uint32_t left = winner_[2 * node], right = winner_[2 * node + 1];
            winner_[node] = counts_[right] > counts_[left] ? right : left;
        }
    }

private:
    std::uint32_t first_;
    std::vector<std::uint64_t> counts_;
    std::vector<std::uint32_t> winner_;  // a heap of places; the counts' own from first_ on
};

class Queues {
public:
    Queues(const WalkStore& walks, const Layout& layout, const TreeletConfig& config,
           std::uint64_t onchip_bytes, const TreeletSink& sink)
        : walks_(walks),
          layout_(layout),
          sink_(sink),
          tree_(hierarchy_of(walks)),
          whole_stack_(with_whole_stack(tree_)),
          decoder_(whole_stack_.decoder()),
          treelets_(tree_, layout, config.treelet_bytes),
          first_place_(tree_.inner_nodes() + tree_.leaves()),
          memory_(treelet_memory(tree_, layout, config.rays)),
          on_chip_(std::min(tree_.stack().on_chip.value_or(memory_.stack_places), memory_.stack_places)),
          queues_(treelets_.count()),
          fullest_(treelets_.count()) {
        assert(config.rays > 0);
        run_.treelets = treelets_.count();
        run_.state_bytes =
            std::uint64_t{config.rays} * (ray_record_bytes + std::uint64_t{on_chip_} * stack_entry_bytes);
        run_.in_memory = run_.state_bytes > onchip_bytes;
    }

    TreeletRun run(std::span<const std::uint32_t> permutation, std::uint32_t most,
                   const QueriesDone& before) {
        std::uint64_t made = 0;
        std::vector<std::uint32_t> taken;
        for (;;) {
            for (; under_way_ < most && made < permutation.size(); ++made) {
                if (before) before(made);
                make(permutation[made]);
            }
            if (fullest_.count() == 0) return run_;
            const std::uint32_t treelet = fullest_.place();
            taken.swap(queues_[treelet]);
            fullest_.set(treelet, 0);
            ++run_.queue_runs;
            for (const std::uint32_t ray : taken) {
                if (run_.in_memory) save(ray, Access::read);
                stay(ray);
            }
            taken.clear();
        }
    }

private:
    /// A ray under way: the rest of its walk, with every entry of its stack.
    struct Ray {
        std::vector<std::uint32_t> elements;
        std::size_t at = 0;
        std::uint32_t height = 0;  // of its stack
    };

    void make(std::uint32_t query) {
        const auto [fault, elements] = decoder_->decode(walks_.walk(query));
        if (fault != spatial::WalkFault::none) refuse_walk(walks_, query, fault);
        std::uint32_t ray = static_cast<std::uint32_t>(rays_.size());
        if (free_.empty()) {
            rays_.emplace_back();
        } else {
            ray = free_.back();
            free_.pop_back();
        }
        rays_[ray].elements.assign(elements.begin(), elements.end());
        rays_[ray].at = 0;
        rays_[ray].height = 0;
        run_.most_under_way = std::max(run_.most_under_way, ++under_way_);
        stay(ray);
    }

    /// The ray runs until its walk leaves the treelet, or ends.
    void stay(std::uint32_t number) {
        Ray& ray = rays_[number];
        if (ray.at < ray.elements.size()) {
            const std::uint32_t treelet = treelets_.of(ray.elements[ray.at]);
            for (; ray.at < ray.elements.size(); ++ray.at) {
                const std::uint32_t element = ray.elements[ray.at];
                if (element >= first_place_) {
                    touch_stack(number, element - first_place_);
                } else if (treelets_.of(element) == treelet) {
                    ++run_.visited_elements;
                    if (const Extent extent = layout_.extent(element); extent.bytes > 0)
                        sink_({extent.address, extent.bytes, Access::read}, layout_.region(element),
                              TreeletUse::walk);
                } else {
                    return push(number, treelets_.of(element));
                }
            }
        }
        free_.push_back(number);
        --under_way_;
    }

    void push(std::uint32_t ray, std::uint32_t treelet) {
        ++run_.pushes;
        run_.saved_entries += std::min(rays_[ray].height, on_chip_);
        queues_[treelet].push_back(ray);
        fullest_.set(treelet, queues_[treelet].size());
        if (run_.in_memory) save(ray, Access::write);
    }

    /// An entry is written on top, or the uppermost one is read.
    void touch_stack(std::uint32_t number, std::uint32_t place) {
        Ray& ray = rays_[number];
        const Access kind = place >= ray.height ? Access::write : Access::read;
        ray.height = kind == Access::write ? place + 1 : place;
        if (place < on_chip_) return;
        ++run_.visited_elements;
        sink_({stack_of(number) + std::uint64_t{place} * stack_entry_bytes, stack_entry_bytes, kind},
              trace::Region::stack, TreeletUse::walk);
    }

    /// The record, and what of the stack a running ray has on chip.
    void save(std::uint32_t ray, Access kind) {
        sink_({memory_.records + std::uint64_t{ray} * ray_record_bytes, ray_record_bytes, kind},
              trace::Region::reorder_buffer, TreeletUse::queue);
        if (const std::uint32_t entries = std::min(rays_[ray].height, on_chip_); entries > 0)
            sink_({stack_of(ray), std::uint64_t{entries} * stack_entry_bytes, kind}, trace::Region::stack,
                  TreeletUse::queue);
    }

    std::uint64_t stack_of(std::uint32_t ray) const {
        return memory_.stacks + std::uint64_t{ray} * memory_.stack_places * stack_entry_bytes;
    }

    const WalkStore& walks_;
    const Layout& layout_;
    const TreeletSink& sink_;
    const spatial::RayTree& tree_;
    spatial::RayTree whole_stack_;
    std::unique_ptr<spatial::WalkDecoder> decoder_;
    Treelets treelets_;
    std::uint32_t first_place_;
    TreeletMemory memory_;
    std::uint32_t on_chip_;
    std::vector<Ray> rays_;
    std::vector<std::uint32_t> free_;
    std::uint64_t under_way_ = 0;
    std::vector<std::vector<std::uint32_t>> queues_;  // by treelet: rays
    Greatest fullest_;
    TreeletRun run_;
};

}  // namespace

std::uint64_t TreeletRun::queue_bytes() const {
    return in_memory ? 2 * (pushes * ray_record_bytes + saved_entries * stack_entry_bytes) : 0;
}

TreeletMemory treelet_memory(const spatial::RayTree& tree, const Layout& layout, std::uint32_t rays) {
    TreeletMemory memory;
    memory.stack_places = with_whole_stack(tree).range_of(trace::Region::stack).count;
    memory.records = aligned(layout.end_byte());
    memory.stacks = aligned(memory.records + std::uint64_t{rays} * ray_record_bytes);
    memory.end = memory.stacks + std::uint64_t{rays} * memory.stack_places * stack_entry_bytes;
    return memory;
}

const spatial::RayTree& hierarchy_of(const WalkStore& walks) {
    if (const auto* const tree = dynamic_cast<const spatial::RayTree*>(&walks.structure())) return *tree;
    throw trace::UsageError(
        fmt::format("treelets: found walks through {}, expected those of rays through a hierarchy (regather "
                    "walk --rays)",
                    walks.structure().name()));
}

TreeletRun run_treelets(const WalkStore& walks, const Layout& layout,
                        std::span<const std::uint32_t> permutation, const TreeletConfig& config,
                        std::uint64_t onchip_bytes, const TreeletSink& sink, const QueriesDone& before) {
    return Queues(walks, layout, config, onchip_bytes, sink).run(permutation, config.rays, before);
}

}  // namespace regather::replay
