// A billion contributions to one number, against the exact integer sum.
#include <cmath>
#include <cstdint>

#include "capture/reference/moments.h"
#include "study/case.h"
#include "study/compensated.h"

namespace regather::study {
namespace {

/// The bits of splitmix64 (Steele, Lea, Flood 2014): the upper 24, so that each summand is a float and the
/// sum an integer.
std::uint32_t summand(std::uint64_t i) {
    std::uint64_t x = (i + 1) * 0x9e3779b97f4a7c15;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
    x = (x ^ x >> 27) * 0x94d049bb133111eb;
    return static_cast<std::uint32_t>((x ^ x >> 31) >> 40);
}

/// Relative error of a way to add up `Sum`, which takes floats and gives a value.
template <class Sum>
double error_of(Effort effort) {
    const std::uint64_t count = effort == Effort::quick ? 20'000'000 : 1'000'000'000;
    Sum sum;
    std::uint64_t exact = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint32_t bits = summand(i);
        exact += bits;
        sum.add(static_cast<float>(bits) * 0x1p-24f);
    }
    const double truth = static_cast<double>(exact) * 0x1p-24;
    return std::fabs(sum.value() - truth) / truth;
}

struct InFloat {
    float sum = 0;
    void add(float x) { sum += x; }
    double value() const { return sum; }
};
struct InDouble {
    double sum = 0;
    void add(float x) { sum += double{x}; }
    double value() const { return sum; }
};
struct CompensatedFloat {
    Compensated<float> sum;
    void add(float x) { sum += x; }
    double value() const { return sum.value(); }
};
struct CompensatedDouble {
    Compensated<double> sum;
    void add(float x) { sum += double{x}; }
    double value() const { return sum.value(); }
};
/// What a pixel of the path tracer does: mean and spread, sample by sample.
struct RunningMean {
    capture::MomentsOf<1> moments;
    std::uint64_t count = 0;
    void add(float x) { moments.add({double{x}}, ++count); }
    double value() const { return moments.mean[0] * static_cast<double>(count); }
};

/// 1e9 times the largest float that is no power of two, then the same taken off again, with a 1 in between.
Reading cancelled(Effort) {
    Compensated<double> sum;
    for (int i = 0; i < 1000; ++i) {
        sum += 1e17;
        sum += 1.0;
        sum += -1e17;
    }
    return {std::fabs(sum.value() - 1000) / 1000, 0};
}

Case summed(const char* name, double (*error)(Effort), double allowed, const char* reason) {
    return {name, "relative error of the sum", reason, [=](Effort effort) {
                return Reading{error(effort), allowed};
            }};
}

}  // namespace

std::vector<Case> long_sum_cases() {
    return {
        summed("1e9 in float (for comparison, not used)", error_of<InFloat>, 1,
               "stops to grow at 2^24 times the mean summand: nothing is promised"),
        summed("1e9 in double (film, photon tally)", error_of<InDouble>, 1e9 * 0x1p-53, "n 2^-53"),
        summed("1e9 in compensated float (for comparison, not used)", error_of<CompensatedFloat>, 1,
               "the sum of the lost parts is a float too, and stops as well"),
        summed("1e9 in compensated double", error_of<CompensatedDouble>, 0x1p-52,
               "2^-53 and the last rounding"),
        summed("1e9 in a running mean (path tracer)", error_of<RunningMean>, 1e9 * 0x1p-53, "n 2^-53"),
        {"large numbers that cancel, compensated double", "relative error of the sum",
         "exact: the lost parts are kept", cancelled},
    };
}

}  // namespace regather::study
