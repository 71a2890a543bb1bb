// cachesim/policies/policy.h -- what a cache does when it must choose: which line goes, what a write does, in
// which set a line lives. Names, parameters and their limits; the caches are policy_cache.h and opt_cache.h.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "cachesim/cache.h"

namespace regather::cachesim {

/// lru:    the line used longest ago goes.
/// fifo:   the line fetched longest ago.
/// plru:   a tree of bits over the ways, each pointing away from the half used last (as drawn by Reineke,
/// Grund,
///         Berg and Wilhelm, "Timing predictability of cache replacement policies", 2007); ways: a power of
///         two.
/// srrip:  static re-reference interval prediction, 2 bits, hit priority (Jaleel, Theobald, Steely and Emer,
/// ISCA
///         2010): a hit sets 0, a fill 2; the lowest way at 3 goes, and while there is none all count up.
/// random: every way alike, drawn from a seed (Philox 4x32-10).
/// opt:    the line whose next use is farthest ahead (Belady 1966): the bound that no policy can beat. It
/// needs
///         the future: opt_cache.h.
/// With all of them a line that is missed fills the lowest empty way first, if there is one.
enum class Policy : std::uint8_t { lru, fifo, plru, srrip, random, opt };
inline constexpr std::array<std::string_view, 6> policy_names{"lru",   "fifo",   "plru",
                                                              "srrip", "random", "opt"};

/// back: a write makes its line dirty, and a dirty line is written back when it goes. through: every write
/// goes on at once, as the bytes written, and no line is dirty.
enum class WritePolicy : std::uint8_t { back, through };
inline constexpr std::array<std::string_view, 2> write_policy_names{"back", "through"};

/// allocate: a write that misses fetches its line. no_allocate: it goes on as the bytes written, and the
/// cache stays as it is.
enum class WriteMiss : std::uint8_t { allocate, no_allocate };
inline constexpr std::array<std::string_view, 2> write_miss_names{"allocate", "no-allocate"};

/// modulo: the line number modulo the sets, of which there may be any number. hashed: all groups of
/// log2(sets) bits of the line number, XORed (the XOR placement of Gonzalez, Valero, Topham and Parcerisa,
/// ICS 1997, carried on to the last bit); sets: a power of two.
enum class SetIndex : std::uint8_t { modulo, hashed };
inline constexpr std::array<std::string_view, 2> set_index_names{"modulo", "hashed"};

/// Throw trace::UsageError that quotes the known names.
Policy parse_policy(std::string_view name);
WritePolicy parse_write_policy(std::string_view name);
WriteMiss parse_write_miss(std::string_view name);
SetIndex parse_set_index(std::string_view name);
inline std::string_view name_of(Policy policy) {
    return policy_names[static_cast<std::size_t>(policy)];
}

struct PolicyConfig {
    CacheConfig geometry{};  ///< Any number of sets, unless `index` is hashed.
    Policy policy = Policy::lru;
    WritePolicy write = WritePolicy::back;
    WriteMiss write_miss = WriteMiss::allocate;
    SetIndex index = SetIndex::modulo;
    std::uint64_t seed = 0;  ///< Of random.

    std::uint64_t sets() const { return geometry.sets(); }
    std::uint64_t ways() const { return geometry.size_bytes / geometry.line_bytes / sets(); }
};

/// Throws trace::UsageError that names the field, what was found and what was expected. Opt takes allocate
/// only: to keep a line out is a choice of its own, and a bound would have to make it.
void check(const PolicyConfig& config);

/// The set of a line, from 0 up. `config` is check()ed.
class SetOfLine {
public:
    explicit SetOfLine(const PolicyConfig& config);
    std::uint64_t operator()(Line line) const;

private:
    enum class How : std::uint8_t { mask, modulo, fold } how_;
    unsigned bits_;
    std::uint64_t sets_;
};

/// Counts of one cache and one region (or their sum). Bytes moved are
/// (fetches + writebacks) x line_bytes + passed_bytes.
struct PolicyStats {
    std::uint64_t accesses = 0;       ///< Line accesses.
    std::uint64_t misses = 0;         ///< Accesses to a line not held.
    std::uint64_t fetches = 0;        ///< Lines fetched: the misses, without writes that did not allocate.
    std::uint64_t writebacks = 0;     ///< Dirty lines evicted, charged to the region that wrote them last.
    std::uint64_t passed_writes = 0;  ///< Writes that went on as they are: written through or not allocated.
    std::uint64_t passed_bytes = 0;   ///< Their bytes.

    std::uint64_t hits() const { return accesses - misses; }
    std::uint64_t traffic_bytes(std::uint32_t line_bytes) const {
        return (fetches + writebacks) * line_bytes + passed_bytes;
    }
    PolicyStats& operator+=(const PolicyStats& other);
    friend bool operator==(const PolicyStats&, const PolicyStats&) = default;
};

}  // namespace regather::cachesim
