// experiment/workload.h -- the columns of a trace as orderings look at them.
#pragma once
#include <cstdint>

#include "reorder/ordering.h"
#include "trace/folder.h"

namespace regather::experiment {

/// The columns that are read, or, of Reads::captured, are there. The reader outlives it. Throws
/// trace::DataError for a missing one, and for an image without pixels.
reorder::Workload workload(trace::TraceReader& trace, const reorder::Reads& reads);

/// `count` queries from the middle of the capture, at least 1 and no more than there are.
reorder::Workload middle_of(const reorder::Workload& work, std::uint64_t count);

}  // namespace regather::experiment
