#include "trace/median.h"

#include <algorithm>

namespace regather::trace {
namespace {

/// The one with as many values before it as behind it, or one more; those before it are not larger.
std::vector<double>::iterator selected_middle(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return middle;
}

}  // namespace

double median(std::vector<double> values) {
    const auto middle = selected_middle(values);
    if (values.size() % 2 == 1) return *middle;
    return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

double upper_median(std::vector<double> values) {
    return *selected_middle(values);
}

}  // namespace regather::trace
