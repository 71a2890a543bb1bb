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

/// Of a sample: `bias` is allowed, and 4.5 of its own standard errors on top, which chance exceeds once in
/// 150,000 times. A sample that scatters so much that more than `most` would be allowed says nothing: throws
/// std::runtime_error, so that the case has failed.
Reading sampled(double error, double bias, double standard_error, double most = 0.1);

struct Case {
    std::string name;
    std::string quantity;  ///< What the error is of.
    std::string reason;    ///< Why that much is allowed.
    std::function<Reading(Effort)> measure;
    bool timed = false;      ///< The error is a ratio of measured times: not for tests.
    bool full_only = false;  ///< In a quick run hardly a photon or a path comes through: left out of it.
};

/// The groups' cases, one file each.
std::vector<Case> scale_and_place_cases();
std::vector<Case> stiff_transport_cases();
std::vector<Case> long_sum_cases();
std::vector<Case> peaked_lobe_cases();
std::vector<Case> sampler_cases();
std::vector<Case> guide_cases();
std::vector<Case> leak_cases();
std::vector<Case> degenerate_geometry_cases();
std::vector<Case> degenerate_map_cases();
std::vector<Case> irradiance_record_cases();
std::vector<Case> keys_on_boxes_cases();

}  // namespace regather::study
