// capture/compensated.h -- a sum whose error does not grow with the number of summands: Neumaier,
// "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen", ZAMM 54, 1974. In double: |error|
// <= 2^-53 |sum| + 2^-105 n sum |x|. Needs strict floating point (no -ffast-math). The order of the summands
// still matters to the last bit.
#pragma once
#include <cmath>

#include "trace/vec.h"

namespace regather::capture {

template <class Number = double>
class Compensated {
public:
    Compensated& operator+=(Number x) {
        const Number sum = sum_ + x;
        lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
        sum_ = sum;
        return *this;
    }
    /// As if the other's summands had come after this one's.
    Compensated& operator+=(const Compensated& other) {
        *this += other.sum_;
        lost_ += other.lost_;
        return *this;
    }
    Number value() const { return sum_ + lost_; }

private:
    Number sum_ = 0, lost_ = 0;
};

/// Three of them: colours in float, added up in double.
class CompensatedRgb {
public:
    CompensatedRgb& operator+=(trace::Vec3 colour) {
        r_ += double{colour.x};
        g_ += double{colour.y};
        b_ += double{colour.z};
        return *this;
    }
    CompensatedRgb& operator+=(const CompensatedRgb& other) {
        r_ += other.r_;
        g_ += other.g_;
        b_ += other.b_;
        return *this;
    }
    trace::Vec3 value() const {
        return {static_cast<float>(r_.value()), static_cast<float>(g_.value()),
                static_cast<float>(b_.value())};
    }

private:
    Compensated<double> r_, g_, b_;
};

}  // namespace regather::capture
