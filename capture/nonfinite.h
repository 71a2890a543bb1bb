// capture/nonfinite.h -- numbers that are none: a NaN or an infinity is stopped where it arises, counted by
// the stage that made it, and told; it never reaches a sum, and so no image. Zero takes its place: darker by
// one contribution, never brighter.
#pragma once
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "trace/vec.h"

namespace regather::capture {

/// Who computed the number.
enum class Stage : std::uint8_t {
    photon,    ///< Position, direction or power of a photon in flight.
    eye,       ///< Emission seen by an eye or specular ray.
    shadow,    ///< Direct light.
    gather,    ///< Weight of a gather ray, and of the query at its end.
    estimate,  ///< Radiance from the photons around a point.
    path,      ///< A path of the path tracer.
    pixel,     ///< A finished pixel: none of the others has seen it.
};
inline constexpr std::size_t stage_count = 7;
inline constexpr std::array<std::string_view, stage_count> stage_names{"photon",   "eye",  "shadow", "gather",
                                                                       "estimate", "path", "pixel"};

/// One a thread or block of work; added up in the end.
class Nonfinite {
public:
    /// `value`, or zero, counted, where a channel is no finite number.
    trace::Vec3 checked(Stage stage, trace::Vec3 value) {
        if (is_finite(value)) [[likely]]
            return value;
        count(stage);
        return {};
    }
    float checked(Stage stage, float value) {
        if (std::isfinite(value)) [[likely]]
            return value;
        count(stage);
        return 0;
    }
    void count(Stage stage, std::uint64_t values = 1) { counts_[static_cast<std::size_t>(stage)] += values; }

    Nonfinite& operator+=(const Nonfinite& other) {
        for (std::size_t s = 0; s < stage_count; ++s) counts_[s] += other.counts_[s];
        return *this;
    }
    std::uint64_t of(Stage stage) const { return counts_[static_cast<std::size_t>(stage)]; }
    std::uint64_t total() const {
        std::uint64_t sum = 0;
        for (const std::uint64_t count : counts_) sum += count;
        return sum;
    }
    /// "3 values were not finite and became 0: photon 1, shadow 2"; empty when there were none.
    std::string text() const {
        if (total() == 0) return "";
        std::string parts;
        for (std::size_t s = 0; s < stage_count; ++s)
            if (counts_[s] > 0)
                parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", stage_names[s], counts_[s]);
        return fmt::format("{} value{} not finite and became 0: {}", total(),
                           total() == 1 ? " was" : "s were", parts);
    }
    friend bool operator==(const Nonfinite&, const Nonfinite&) = default;

private:
    std::array<std::uint64_t, stage_count> counts_{};
};

}  // namespace regather::capture
