// results/parameters.h -- an ordering's parameters as a row's spec tells them: "hilbert:tile=16,bits=10".
#pragma once
#include <string>
#include <string_view>

#include "results/row.h"

namespace regather::results {

/// "hilbert:tile=16,bits=10" -> "bits=10": what the columns tile and bins do not imply already.
std::string other_parameters(const Row& row);

/// The whole number from 1 up that `spec` gives to `name`: 16 for "tile" of "hilbert:tile=16,bits=10".
/// Nothing where it gives none.
Count parameter(std::string_view spec, std::string_view name);

/// What stands before the colon of a spec: "hilbert" of "hilbert:tile=16".
inline std::string spec_name(std::string_view spec) {
    return std::string(spec.substr(0, spec.find(':')));
}

}  // namespace regather::results
