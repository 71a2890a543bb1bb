// study/case.h -- one stiff or extreme case: what it measures, against which truth, and how much error is
// allowed.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace regather::study {

enum class Effort {
    quick,  ///< Fewer rays, photons and samples, for tests.
    full,
};

/// Passed when `error` is a number and at most `allowed`.
struct Reading {
    double error = 0, allowed = 0;
};

struct Case {
    std::string name;
    std::string quantity;  ///< What the error is of.
    std::string reason;    ///< Why that much is allowed.
    std::function<Reading(Effort)> measure;
    bool timed = false;  ///< The error is a ratio of measured times: not for tests.
};

/// The groups' cases, one file each.
std::vector<Case> scale_and_place_cases();
std::vector<Case> stiff_transport_cases();
std::vector<Case> long_sum_cases();
std::vector<Case> peaked_lobe_cases();
std::vector<Case> sampler_cases();
std::vector<Case> leak_cases();
std::vector<Case> degenerate_geometry_cases();
std::vector<Case> degenerate_map_cases();
std::vector<Case> keys_on_boxes_cases();

}  // namespace regather::study
