// study/compensated.h -- a sum whose error does not grow with the number of summands: Neumaier,
// "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen", ZAMM 54, 1974. In double: |error|
// <= 2^-53 |sum| + 2^-105 n sum |x|. Needs strict floating point (no -ffast-math). The order of the summands
// still matters to the last bit.
#pragma once
#include <cmath>

namespace regather::study {

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

}  // namespace regather::study
