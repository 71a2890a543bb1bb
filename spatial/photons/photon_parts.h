// spatial/photons/photon_parts.h -- photons in buckets that a search reads whole: one behind the other in
// memory, each cut into parts of at most 64, which are the elements of a structure.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/photons/nearest.h"
#include "trace/photon.h"

namespace regather::spatial {

class PhotonParts {
public:
    static constexpr std::uint32_t most_photons = 64;

    /// Appends a bucket: photons by their numbers, in this order.
    void add(std::span<const std::uint32_t> bucket, std::span<const Photon> photons) {
        for (std::size_t i = 0; i < bucket.size(); ++i) {
            if (i > 0 && i % most_photons == 0) begin_.push_back(size());
            photon_at_.push_back(bucket[i]);
            positions_.push_back(photons[bucket[i]].position);
        }
        if (!bucket.empty()) begin_.push_back(size());
    }

    std::uint32_t count() const { return static_cast<std::uint32_t>(begin_.size() - 1); }
    /// Photons.
    std::uint32_t size() const { return static_cast<std::uint32_t>(photon_at_.size()); }
    /// Of each part, and the number of photons.
    std::span<const std::uint32_t> begin() const { return begin_; }
    /// By place: which photon lies there.
    std::span<const std::uint32_t> photon_at() const { return photon_at_; }

    /// Offers the photons of part `part`, which is element `element`.
    template <class Listener>
    void read(std::uint32_t part, std::uint32_t element, Vec3 point, NearestSet& found,
              Listener& listener) const {
        listener.visit(element);
        for (std::uint32_t place = begin_[part]; place < begin_[part + 1]; ++place) {
            const Vec3 to_point = point - positions_[place];
            const bool entered = found.offer(trace::dot(to_point, to_point), photon_at_[place]);
            if constexpr (requires { listener.look(place, entered); })
                listener.look(photon_at_[place], entered);
        }
    }

private:
    std::vector<std::uint32_t> begin_{0}, photon_at_;
    std::vector<Vec3> positions_;
};

/// Throws trace::DataError for a photon at NaN or infinity and for 2^31 or more photons.
void check_photons(std::span<const Photon> photons);

}  // namespace regather::spatial
