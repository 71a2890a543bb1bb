// cachesim/policies/policy_cache.h -- one exact cache of any policy but opt (policy.h), of any number of sets
// and ways, with 64-bit lines and counts. Its steps are open, so that hierarchies can be built of them
// (line_store.h); access() is a whole cache between its user and memory, and counts. Up to 32 ways a set is
// searched way by way, above through a hash table.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cachesim/cache.h"
#include "cachesim/policies/policy.h"
#include "trace/region.h"

namespace regather::cachesim {

/// A line held. `region`: who wrote a dirty line last; who brought a clean line in.
struct Resident {
    Line line{};
    bool dirty = false;
    trace::Region region = trace::Region::other;
    friend bool operator==(const Resident&, const Resident&) = default;
};

class PolicyCache {
public:
    /// check()s it. Throws trace::UsageError for Policy::opt.
    explicit PolicyCache(const PolicyConfig& config);
    ~PolicyCache();
    PolicyCache(PolicyCache&&) noexcept;
    PolicyCache& operator=(PolicyCache&&) noexcept;

    // ---- the steps: they count nothing ----

    /// Where `line` is held: set x ways + way, the same for as long as it stays. What a level knows of its
    /// lines can stand beside the cache, by slot (line_store.h).
    std::size_t slot(Line line) const;  ///< nowhere, if it is not held.
    static constexpr std::size_t nowhere = ~std::size_t{0};
    std::optional<Resident> at(std::size_t slot) const;  ///< None: the way is empty.
    struct Placed {
        std::size_t slot;
        std::optional<Resident> evicted;
    };
    /// Brings in `line`, which must not be held, and returns what had to go for it, if anything. `dirty` is
    /// taken as it is, with every WritePolicy.
    Placed place(Line line, bool dirty, trace::Region region);
    void use_at(std::size_t slot);     ///< The policy learns of a use. Of a slot that holds a line.
    void remove_at(std::size_t slot);  ///< The way becomes empty. Of a slot that holds a line.
    /// Takes out everything.
    void clear();

    // ---- a whole cache, which counts ----

    struct Outcome {
        bool hit;
        std::optional<Resident> evicted;
    };
    /// One access to `bytes` bytes of the line; reads do not ask for `bytes`.
    Outcome access(Line line, Access kind, trace::Region region, std::uint32_t bytes);
    /// Evicts everything, so that dirty lines are counted as written back.
    void flush();

    const PolicyConfig& config() const { return config_; }
    const PolicyStats& stats(trace::Region region) const { return stats_[static_cast<std::size_t>(region)]; }
    PolicyStats total() const;
    std::uint64_t traffic_bytes() const { return total().traffic_bytes(config_.geometry.line_bytes); }

    class Sets;  ///< The lines held and what the policy remembers of them. policy_cache.cpp
private:
    PolicyConfig config_;
    std::array<PolicyStats, trace::region_count> stats_{};
    std::unique_ptr<Sets> sets_;
};

}  // namespace regather::cachesim
