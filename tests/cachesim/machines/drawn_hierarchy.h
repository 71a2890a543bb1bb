// tests/cachesim/machines/drawn_hierarchy.h -- hierarchies small enough to draw: levels of one set, and what
// each holds after each access.
#pragma once
#include <string>
#include <vector>

#include "cachesim/machines/hierarchy.h"

namespace regather::cachesim {

inline constexpr auto photons = trace::Region::photons, buffer = trace::Region::reorder_buffer;

/// One set of so many ways, lines of 64 B.
inline LevelConfig one_set(std::string name, std::uint32_t ways, Inclusion inclusion = Inclusion::neither) {
    LevelConfig level;
    level.name = std::move(name);
    level.cache.geometry = {64ull * ways, 64, ways};
    level.inclusion = inclusion;
    return level;
}

/// Lines have letters: A is line 0.
class Drawn {
public:
    explicit Drawn(const std::vector<LevelConfig>& levels) : hierarchy(levels, DramConfig{.row_bytes = 64}) {}

    /// What the levels hold afterwards, nearest first: "AB|ABC".
    std::string read(char letter, trace::Region region = photons) {
        return access(letter, Access::read, region);
    }
    std::string write(char letter, trace::Region region = photons) {
        return access(letter, Access::write, region);
    }
    std::string contents() const {
        std::string text;
        for (std::size_t level = 0; level < hierarchy.levels(); ++level) {
            if (level > 0) text += '|';
            for (char letter = 'A'; letter <= 'Z'; ++letter)
                if (hierarchy.holds(level, line(letter))) text += letter;
        }
        return text;
    }
    LevelStats at(std::size_t level, trace::Region region = photons) const {
        return hierarchy.stats(level, region);
    }

    Hierarchy hierarchy;

private:
    static Line line(char letter) { return Line{static_cast<std::uint64_t>(letter - 'A')}; }
    std::string access(char letter, Access kind, trace::Region region) {
        const ByteAccess bytes{static_cast<std::uint64_t>(letter - 'A') * 64 + 4, 8, kind};
        hierarchy.access({&bytes, 1}, region);
        return contents();
    }
};

inline void read(Hierarchy& hierarchy, std::uint64_t address, std::uint64_t bytes,
                 trace::Region region = photons) {
    const ByteAccess access{address, bytes, Access::read};
    hierarchy.access({&access, 1}, region);
}
inline void write(Hierarchy& hierarchy, std::uint64_t address, std::uint64_t bytes,
                  trace::Region region = photons) {
    const ByteAccess access{address, bytes, Access::write};
    hierarchy.access({&access, 1}, region);
}

}  // namespace regather::cachesim
