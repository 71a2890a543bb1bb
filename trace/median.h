// trace/median.h -- the middle of some numbers.
#pragma once
#include <vector>

namespace regather::trace {

/// Of an even number of values the mean of the middle two. At least one value.
double median(std::vector<double> values);

}  // namespace regather::trace
