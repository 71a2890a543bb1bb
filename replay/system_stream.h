// replay/system_stream.h -- byte accesses on their way to memory systems of several levels, in stretches of
// one region. Each system gets all of them as if it were alone; they run side by side on the threads of
// oneTBB.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "cachesim/machines/hierarchy.h"

namespace regather::replay {

class SystemStream {
public:
    /// The systems outlive the stream. Accesses belong to one of `parts`; at first to part 0.
    explicit SystemStream(std::span<cachesim::Hierarchy> systems, std::size_t parts = 1);

    /// What comes from here on belongs to this part.
    void begin_part(std::size_t part) { part_ = part; }
    void append(const cachesim::ByteAccess& access, trace::Region region) {
        if (accesses_.size() >= most_waiting) drain();
        if (stretches_.empty() || stretches_.back().region != region || stretches_.back().part != part_)
            stretches_.push_back({region, part_, 0});
        accesses_.push_back(access);
        stretches_.back().end = accesses_.size();
    }
    /// Passes on all that waits.
    void drain();
    /// Drains, and empties the systems (Hierarchy::flush()). By system, then by part: what was counted while
    /// the part's accesses ran; of the last one that ran, also while the systems were emptied.
    std::vector<std::vector<cachesim::HierarchyCounts>> finish();

private:
    struct Stretch {
        trace::Region region;
        std::size_t part, end;
    };
    struct Charged {
        std::vector<cachesim::HierarchyCounts> parts;
        cachesim::HierarchyCounts before;  // when the running part began
        std::size_t running = 0;
    };
    static constexpr std::size_t most_waiting = 1 << 16;

    static void charge(Charged& charged, const cachesim::Hierarchy& system);

    std::span<cachesim::Hierarchy> systems_;
    std::size_t part_ = 0;
    std::vector<cachesim::ByteAccess> accesses_;
    std::vector<Stretch> stretches_;
    std::vector<Charged> charged_;  // by system
};

}  // namespace regather::replay
