// trace/median.h -- the middle of some numbers.
#pragma once
#include <vector>

namespace regather::trace {

/// Of an even number of values the mean of the middle two. At least one value.
double median(std::vector<double> values);

/// Of an even number of values the larger of the middle two: always one of the values. At least one value.
double upper_median(std::vector<double> values);

}  // namespace regather::trace
