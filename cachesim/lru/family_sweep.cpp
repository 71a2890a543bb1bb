#include "cachesim/lru/family_sweep.h"

#include <fmt/format.h>
#include <tbb/parallel_for_each.h>

#include <bit>

#include "trace/error.h"

namespace regather::cachesim {
namespace {

constexpr std::uint64_t most_sets = std::uint64_t{1} << 16;

FamilyConfig config_of(std::uint32_t ways, bool classes) {
    FamilyConfig config{.levels = {}, .distances = true, .conflicts = classes};
    for (std::uint64_t sets = 1; sets <= most_sets; sets *= 2) config.levels.push_back({sets, ways});
    return config;
}

}  // namespace

FamilySweep::FamilySweep(std::span<const std::uint32_t> line_sizes, std::uint32_t ways, bool classes)
    : classes_(classes) {
    for (const std::uint32_t line_bytes : line_sizes) {
        if (!std::has_single_bit(line_bytes))
            throw trace::UsageError(fmt::format("line_bytes: found {}, expected a power of two", line_bytes));
        sizes_.push_back({line_bytes, {}, LruFamily(config_of(ways, classes))});
    }
}

void FamilySweep::access(std::span<const ByteAccess> accesses) {
    tbb::parallel_for_each(sizes_, [&](LineSize& size) {
        size.lines.clear();
        for (const ByteAccess& access : accesses)
            append_lines(size.lines, access.address, access.bytes, size.line_bytes);
        size.family.access(size.lines);
    });
}

std::vector<FamilyRow> FamilySweep::rows() {
    std::vector<FamilyRow> rows;
    for (LineSize& size : sizes_) {
        const FamilyCounts& counts = size.family.counts();
        const auto add = [&](std::uint64_t lines, std::uint32_t ways, std::uint64_t misses,
                             std::uint64_t conflicts) {
            rows.push_back({{counts.compulsory, misses - counts.compulsory - conflicts, conflicts},
                            {lines * size.line_bytes, size.line_bytes, ways},
                            counts.accesses,
                            misses});
        };
        for (const FamilyCounts::Level& level : counts.levels)
            for (std::uint32_t ways = 1; ways <= level.level.ways; ++ways)
                add(level.level.sets * ways, ways, level.misses[ways - 1],
                    classes_ ? level.conflicts[ways - 1] : 0);
        for (std::uint64_t lines = 1;; lines *= 2) {
            const std::uint64_t misses = counts.full_misses(lines);
            add(lines, fully_associative, misses, 0);
            if (misses == counts.compulsory) break;  // it holds all there is
        }
    }
    return rows;
}

}  // namespace regather::cachesim
