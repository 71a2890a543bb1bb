// tests/spatial/photons.h -- photons for tests: on lines, in clusters, on planes, twice in one place.
#pragma once
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/photon.h"

namespace regather::spatial {

inline std::vector<trace::Photon> photons_on_a_line(const std::vector<float>& x) {
    std::vector<trace::Photon> photons(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) photons[i].position.x = x[i];
    return photons;
}

/// A small linear congruential generator: tests need numbers that never change.
class Numbers {
public:
    explicit Numbers(std::uint64_t seed = 1) : state_(seed) {}
    float uniform() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<float>(state_ >> 40) * 0x1p-24f;
    }

private:
    std::uint64_t state_;
};

inline std::vector<trace::Photon> uniform_photons(std::size_t count, std::uint64_t seed = 1) {
    Numbers numbers(seed);
    std::vector<trace::Photon> photons(count);
    for (trace::Photon& p : photons) p.position = {numbers.uniform(), numbers.uniform(), numbers.uniform()};
    return photons;
}

/// With one parameter, as the other clouds.
inline std::vector<trace::Photon> uniform_cloud(std::size_t count) {
    return uniform_photons(count);
}

inline std::vector<trace::Photon> coplanar_photons(std::size_t count) {
    std::vector<trace::Photon> photons = uniform_photons(count);
    for (trace::Photon& p : photons) p.position.z = 0.25f;
    return photons;
}

/// Ten clusters, each a thousandth of the box wide.
inline std::vector<trace::Photon> clustered_photons(std::size_t count) {
    Numbers numbers(7);
    std::array<trace::Vec3, 10> centres;
    for (trace::Vec3& c : centres) c = {numbers.uniform(), numbers.uniform(), numbers.uniform()};
    std::vector<trace::Photon> photons(count);
    for (std::size_t i = 0; i < count; ++i)
        photons[i].position = centres[i % centres.size()] +
                              trace::Vec3{numbers.uniform(), numbers.uniform(), numbers.uniform()} * 1e-3f;
    return photons;
}

/// Each position three times.
inline std::vector<trace::Photon> duplicate_photons(std::size_t count) {
    std::vector<trace::Photon> photons = uniform_photons(count);
    for (std::size_t i = 0; i < count; ++i) photons[i].position = photons[i / 3 * 3].position;
    return photons;
}

/// Up to `most` photons on a coarse grid, so that equal coordinates and equal places are common.
inline rc::Gen<std::vector<trace::Photon>> any_photons(int most) {
    return rc::gen::exec([most] {
        const int count = *rc::gen::inRange(0, most);
        std::vector<trace::Photon> photons(static_cast<std::size_t>(count));
        const int grid = *rc::gen::element(1, 2, 8, 1000);
        const auto coordinate = [grid] { return static_cast<float>(*rc::gen::inRange(0, grid)); };
        for (trace::Photon& p : photons) p.position = {coordinate(), coordinate(), coordinate()};
        return photons;
    });
}

inline std::vector<std::array<float, 3>> sorted_positions(std::span<const trace::Photon> photons) {
    std::vector<std::array<float, 3>> positions;
    for (const trace::Photon& p : photons) positions.push_back({p.position.x, p.position.y, p.position.z});
    std::sort(positions.begin(), positions.end());
    return positions;
}

}  // namespace regather::spatial
