// study/computation/sampling_operations.h -- what each strategy of gather rays keeps and computes a shaded
// point, side by side.
#pragma once
#include <string_view>

#include "capture/sampling/gather_distribution.h"
#include "results/table.h"

namespace regather::study {

/// Of a spec, or of every strategy with its defaults where it is "all": bytes, searches and rays a point;
/// operations by kind to make its table and to draw a ray; a line a kind of surface where they differ. Throws
/// as capture::parse_sampling().
results::Table sampling_operations(std::string_view spec);

}  // namespace regather::study
