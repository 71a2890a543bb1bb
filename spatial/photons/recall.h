// spatial/photons/recall.h -- how much of the truth a search that is not exact finds.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "spatial/photons/block_hashing.h"
#include "trace/json.h"

namespace regather::spatial {

struct Recall {
    std::uint64_t nearest =
        0;                    ///< The k nearest photons within the radius, as looking at every one has them.
    std::uint64_t found = 0;  ///< How many of these the search found.

    /// found / nearest; 1 where there is nothing to find.
    double share() const {
        return nearest == 0 ? 1 : static_cast<double>(found) / static_cast<double>(nearest);
    }
    Recall& operator+=(const Recall& other) {
        nearest += other.nearest;
        found += other.found;
        return *this;
    }
    friend bool operator==(const Recall&, const Recall&) = default;
};

/// Over all points. `heap`: what `hashing` was built over, photons in the order of left_balanced(). The same
/// on any number of threads.
Recall recall_of(const BlockHashing& hashing, std::span<const Photon> heap, std::span<const Vec3> points,
                 std::uint32_t k, float radius);

/// ", recall 0.9731 of 4000 nearest photons"; empty where there is no recall.
std::string text_of(const std::optional<Recall>& recall);

/// Of trace.json's counts.
inline constexpr std::string_view nearest_count = "nearest_photons", nearest_found_count = "nearest_found";
/// Sets `nearest_photons` and `nearest_found` of trace.json's counts, or takes them out where there is no
/// recall.
void set_recall(trace::Json& counts, const std::optional<Recall>& recall);

}  // namespace regather::spatial
