// tests/spatial/recorded_visits.h -- a listener of searches that keeps their visits, and records them as a
// walk.
#pragma once
#include <cstdint>
#include <vector>

#include "spatial/list_walk.h"

namespace regather::spatial {

struct RecordedVisits {
    std::vector<std::uint32_t> visited;
    ListWalkRecorder recorder;
    void visit(std::uint32_t element) {
        visited.push_back(element);
        recorder.visit(element);
    }
};

}  // namespace regather::spatial
