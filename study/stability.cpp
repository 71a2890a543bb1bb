#include "study/stability.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>

#include "trace/error.h"
#include "trace/text.h"

namespace regather::study {
namespace {

constexpr CaseGroup groups[] = {
    {"place", "the same scene scaled by 1e-6 .. 1e6 and moved by up to 1e6 of its size",
     scale_and_place_cases},
    {"transport", "albedos up to 0.9999, keyholes, powers over 12 decades", stiff_transport_cases},
    {"sums", "a billion contributions", long_sum_cases},
    {"lobes", "exponents 1 .. 1e6, grazing angles, indices of refraction 1.0001 and 5", peaked_lobe_cases},
    {"samplers", "chi-squared tests of every sampler", sampler_cases},
    {"guides", "gather rays guided by no photons, by powerless ones, by all from one direction, from below",
     guide_cases},
    {"leaks", "rays in closed boxes: how many leave", leak_cases},
    {"geometry", "slivers, duplicates, coincident walls, touching lights, cameras on surfaces",
     degenerate_geometry_cases},
    {"maps", "photons in a point, on a line, in a plane; radius zero; k = 1 and k = all; the 20-byte photon",
     degenerate_map_cases},
    {"records", "records of irradiance in the dark, under a sky, at an edge, at any scale",
     irradiance_record_cases},
    {"keys", "space-filling curves on boxes of extreme proportions", keys_on_boxes_cases},
};

}  // namespace

Reading sampled(double error, double bias, double standard_error, double most) {
    const double allowed = bias + 4.5 * standard_error;
    if (!(allowed <= most))
        throw std::runtime_error(fmt::format(
            "the sample scatters too much: an error of {:.2g} would be allowed, at most {:.2g} may", allowed,
            most));
    return {error, allowed};
}

std::span<const CaseGroup> case_groups() {
    return groups;
}

const CaseGroup& case_group(std::string_view name) {
    std::string names;
    for (const CaseGroup& group : groups) {
        if (group.name == name) return group;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", group.name);
    }
    throw trace::UsageError(
        fmt::format("group of cases: found {}, expected one of {}", trace::in_quotes(name), names));
}

results::StabilityRow run_case(const CaseGroup& group, const Case& one, Effort effort) {
    results::StabilityRow row;
    row.group = group.name;
    row.stability_case = one.name;
    row.quantity = one.quantity;
    row.reason = one.reason;
    row.passed = false;
    const auto start = std::chrono::steady_clock::now();
    try {
        const Reading reading = one.measure(effort);
        if (std::isfinite(reading.error)) row.error = reading.error;
        if (std::isfinite(reading.allowed)) row.allowed_error = reading.allowed;
        row.passed = row.error && row.allowed_error && reading.error <= reading.allowed;
    } catch (const std::exception& error) {
        row.reason = error.what();
    }
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return row;
}

std::vector<results::StabilityRow> run_cases(std::span<const CaseGroup* const> of, Effort effort,
                                             const experiment::ProgressListener& told) {
    std::vector<std::pair<const CaseGroup*, Case>> cases;
    for (const CaseGroup* group : of)
        for (Case& one : group->cases())
            if (effort == Effort::full || !one.full_only) cases.emplace_back(group, std::move(one));
    std::vector<results::StabilityRow> rows;
    for (const auto& [group, one] : cases) {
        if (told) told(fmt::format("{}: {}", group->name, one.name), "cases", rows.size(), cases.size());
        rows.push_back(run_case(*group, one, effort));
    }
    return rows;
}

}  // namespace regather::study
