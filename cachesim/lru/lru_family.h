// cachesim/lru/lru_family.h -- every LRU cache of one line size in one pass: set-associative ones for each
// number of sets and all ways up to a limit, fully associative ones of every size, and the classes of their
// misses. Exact. Mattson et al. 1970 (stack algorithms); Hill & Smith, IEEE ToC 1989 (all associativities);
// Hill 1987 (classes).
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "cachesim/cache.h"

namespace regather::cachesim {

/// All caches of `sets` sets (a power of two up to 2^24) and 1 to `ways` ways (up to 32).
struct FamilyLevel {
    std::uint64_t sets = 1;
    std::uint32_t ways = 16;
    friend bool operator==(const FamilyLevel&, const FamilyLevel&) = default;
};

struct FamilyConfig {
    std::vector<FamilyLevel> levels;
    bool distances = true;  ///< Fully associative caches, too.
    bool conflicts = true;  ///< Conflict misses, too; asks for distances.
    std::uint64_t stamps = std::uint64_t{1}
                           << 21;  ///< Time stamps before they are numbered anew; 1.2 bits each.
};

/// What the accesses did. Counts of parts of a stream add up.
struct FamilyCounts {
    struct Level {
        FamilyLevel level;
        std::vector<std::uint64_t> misses;  ///< [w - 1]: of w ways.
        std::vector<std::uint64_t>
            conflicts;  ///< Likewise; misses that a fully associative cache of the same size does not have.
        friend bool operator==(const Level&, const Level&) = default;
    };
    std::uint64_t accesses = 0, compulsory = 0;
    std::vector<Level> levels;
    std::vector<std::uint64_t>
        by_distance;  ///< [d]: accesses whose line was touched before, and d different ones since.

    /// With `sets` and `ways` that are in the family.
    std::uint64_t misses(std::uint64_t sets, std::uint32_t ways) const;
    std::uint64_t conflicts(std::uint64_t sets, std::uint32_t ways) const;
    /// Of a fully associative cache of `lines` lines.
    std::uint64_t full_misses(std::uint64_t lines) const;
    FamilyCounts& operator+=(const FamilyCounts& other);
    friend bool operator==(const FamilyCounts&, const FamilyCounts&) = default;

private:
    const Level& level(std::uint64_t sets, std::uint32_t ways) const;
};

class LruFamily {
public:
    /// Throws trace::UsageError for a level that is not as above. At most 2^26 different lines.
    explicit LruFamily(const FamilyConfig& config);
    ~LruFamily();
    LruFamily(LruFamily&&) noexcept;
    LruFamily& operator=(LruFamily&&) noexcept;

    /// In this order, one after the other.
    void access(std::span<const Line> lines);

    /// The first touches of a walk, which touches each of its lines once or several times: `lines` are
    /// different ones in the order of their first touches, `last_rank[i]` is the place of line i in the order
    /// of their last touches. What these first touches do is the same as in access() of the whole walk; the
    /// other touches are not counted: see revisit().
    void access_first(std::span<const Line> lines, std::span<const std::uint32_t> last_rank);

    /// All touches of a walk, of which only those of lines that it touched before are counted. How deep these
    /// lie does not depend on what ran before the walk, so one count serves every order of the walks: for any
    /// order the sum of access_first() and revisit() over the walks is access() of all their touches.
    void revisit(std::span<const Line> lines);

    const FamilyCounts& counts();  ///< So far.

private:
    class Batch;
    class Engine;
    std::unique_ptr<Engine> engine_;
};

}  // namespace regather::cachesim
