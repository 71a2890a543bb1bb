// cachesim/machines/line_store.h -- one array of lines of a hierarchy's level: a PolicyCache decides who
// stays, and beside it stands what a level must know of each line: which sectors are there, which are dirty,
// by whom.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "cachesim/policies/policy_cache.h"

namespace regather::cachesim {

/// Sectors of a line, bit 0 the lowest address.
using Sectors = std::uint32_t;
inline constexpr std::uint32_t max_sectors = 32;

struct LineState {
    Sectors valid = 0, dirty = 0;                  ///< Dirty sectors are valid.
    trace::Region owner = trace::Region::other;    ///< Who used the line last here, or brought it.
    trace::Region writer = trace::Region::other;   ///< Who wrote a dirty sector last.
    trace::Region fetcher = trace::Region::other;  ///< Whose access prefetched it.
    bool prefetched = false;                       ///< And not used since.
};

struct HeldLine {
    Line line{};
    LineState state;
};

class LineStore {
public:
    explicit LineStore(const PolicyConfig& config);

    LineState* find(Line line);  ///< Not a use; null if not held. Valid until the next insert or remove.
    const LineState* find(Line line) const;
    /// Whether find() gave this: not of another store, and not null.
    bool has(const LineState* state) const {
        return state >= states_.data() && state < states_.data() + states_.size();
    }
    void use(const LineState* state) { cache_.use_at(slot_of(state)); }  ///< has() it.
    struct Inserted {
        LineState* state;
        std::optional<HeldLine> gone;  ///< What had to go for it.
    };
    Inserted insert(Line line, const LineState& state);  ///< A line that is not held.
    std::optional<LineState> remove(Line line);
    /// Takes out everything, set by set and way by way.
    std::vector<HeldLine> drain();

private:
    std::size_t slot_of(const LineState* state) const {
        return static_cast<std::size_t>(state - states_.data());
    }

    PolicyCache cache_;
    std::vector<LineState> states_;  // by slot of the cache
};

}  // namespace regather::cachesim
