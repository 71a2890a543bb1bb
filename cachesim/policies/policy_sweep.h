// cachesim/policies/policy_sweep.h -- one stream of byte accesses through many caches of any policy, each as
// if it were alone, with the class of every miss (miss_class.h). Plain LRU caches (write-back, allocating,
// lines modulo a power of two of sets) run as LruCache, opt ones as OptCache after the end of the stream, all
// others as PolicyCache. Caches are simulated side by side on the threads of oneTBB; the counts do not depend
// on their number.
//
// Memory beside the caches, for each line size: 40 to 65 bytes a different line for the classes; for opt see
// opt_cache.h.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cachesim/lines.h"
#include "cachesim/miss_class.h"
#include "cachesim/policies/policy.h"

namespace regather::cachesim {

struct PolicyRow {
    PolicyConfig config;
    PolicyStats stats;
    std::optional<MissClasses> classes;  ///< Their sum is stats.misses.
};

struct PolicySweepOptions {
    bool classes = true;  ///< Without them plain LRU caches are several times faster.
    std::uint64_t opt_limit = std::uint64_t{1} << 28;  ///< [line accesses]; 2 GiB for each line size.
};

class PolicySweep {
public:
    /// check()s each config. With opt among them access() throws trace::UsageError for a stream of more than
    /// `opt_limit` line accesses of one size.
    explicit PolicySweep(std::span<const PolicyConfig> configs, const PolicySweepOptions& options = {});
    ~PolicySweep();
    PolicySweep(PolicySweep&&) noexcept;
    PolicySweep& operator=(PolicySweep&&) noexcept;

    /// In this order. All are charged to trace::Region::other.
    void access(std::span<const ByteAccess> accesses);
    /// At the end, once: runs opt, then writes back the dirty lines still held. In the order of the configs.
    /// `progress` hears of the line accesses that opt has done, and of how many there are.
    std::vector<PolicyRow> finish(const std::function<void(std::uint64_t, std::uint64_t)>& progress);

    class Group;  ///< The caches of one line size. policy_sweep.cpp
private:
    std::vector<PolicyConfig> configs_;
    std::vector<std::unique_ptr<Group>> groups_;
};

}  // namespace regather::cachesim
