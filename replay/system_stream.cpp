#include "replay/system_stream.h"

#include <tbb/parallel_for.h>

namespace regather::replay {

SystemStream::SystemStream(std::span<cachesim::Hierarchy> systems, std::size_t parts) : systems_(systems) {
    for (const cachesim::Hierarchy& system : systems) {
        Charged& charged = charged_.emplace_back();
        charged.before = system.counts();
        cachesim::HierarchyCounts nothing = charged.before;
        nothing -= charged.before;
        charged.parts.assign(parts, nothing);
    }
}

void SystemStream::drain() {
    tbb::parallel_for(std::size_t{0}, systems_.size(), [&](std::size_t s) {
        std::size_t begin = 0;
        for (const Stretch& stretch : stretches_) {
            if (charged_[s].running != stretch.part) {
                charge(charged_[s], systems_[s]);
                charged_[s].running = stretch.part;
            }
            systems_[s].access(std::span(accesses_).subspan(begin, stretch.end - begin), stretch.region);
            begin = stretch.end;
        }
    });
    accesses_.clear();
    stretches_.clear();
}

std::vector<std::vector<cachesim::HierarchyCounts>> SystemStream::finish() {
    drain();
    std::vector<std::vector<cachesim::HierarchyCounts>> counts;
    for (std::size_t s = 0; s < systems_.size(); ++s) {
        systems_[s].flush();
        charge(charged_[s], systems_[s]);
        counts.push_back(charged_[s].parts);
    }
    return counts;
}

void SystemStream::charge(Charged& charged, const cachesim::Hierarchy& system) {
    const cachesim::HierarchyCounts now = system.counts();
    cachesim::HierarchyCounts& part = charged.parts[charged.running];
    part += now;
    part -= charged.before;
    charged.before = now;
}

}  // namespace regather::replay
