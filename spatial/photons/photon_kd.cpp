#include "spatial/photons/photon_kd.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "trace/bounds.h"
#include "trace/error.h"

namespace regather::spatial {
namespace {

struct PlacedPhoton {
    Vec3 position;
    std::uint32_t photon;
};

constexpr std::size_t task_photons = 8192;

/// Photons in the left subtree of a left-balanced tree of n >= 2.
std::size_t left_count(std::size_t n) {
    const std::size_t last_level = std::bit_floor(n);  // slots of the deepest level
    const std::size_t on_last_level = n - (last_level - 1);
    return (last_level / 2 - 1) + std::min(on_last_level, last_level / 2);
}

class Builder {
public:
    Builder(std::span<const Photon> photons, std::vector<Photon>& heap, std::vector<std::uint32_t>& from)
        : photons_(photons), heap_(heap), from_(from) {}

    void build(std::span<PlacedPhoton> items, std::size_t slot) {
        if (items.empty()) return;
        trace::Bounds3 box;
        for (const PlacedPhoton& item : items) box.include(item.position);
        const Vec3 side = box.extent();
        const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;

        const std::size_t left = items.size() == 1 ? 0 : left_count(items.size());
        std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(left), items.end(),
                         [axis](const PlacedPhoton& a, const PlacedPhoton& b) {
                             const float x = a.position[axis], y = b.position[axis];
                             return x < y || (x == y && a.photon < b.photon);
                         });
        Photon& node = heap_[slot - 1] = photons_[items[left].photon];
        from_[slot - 1] = items[left].photon;
        node.flags = static_cast<std::uint16_t>((node.flags & ~3u) | static_cast<unsigned>(axis));

        const std::span<PlacedPhoton> low = items.first(left), high = items.subspan(left + 1);
        if (items.size() > task_photons) {
            tbb::task_group tasks;
            tasks.run([this, low, slot] { build(low, 2 * slot); });
            build(high, 2 * slot + 1);
            tasks.wait();
        } else {
            build(low, 2 * slot);
            build(high, 2 * slot + 1);
        }
    }

private:
    std::span<const Photon> photons_;
    std::vector<Photon>& heap_;
    std::vector<std::uint32_t>& from_;
};

}  // namespace

std::vector<Photon> left_balanced(std::span<const Photon> photons) {
    std::vector<std::uint32_t> from;
    return left_balanced(photons, from);
}

std::vector<Photon> left_balanced(std::span<const Photon> photons, std::vector<std::uint32_t>& from) {
    if (photons.size() >= (std::size_t{1} << 31))
        throw trace::DataError(fmt::format("photons: found {}, expected fewer than 2^31", photons.size()));
    std::vector<PlacedPhoton> items(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i) {
        if (!trace::is_finite(photons[i].position))
            throw trace::DataError(fmt::format("photon {}: found a position that is not finite", i));
        items[i] = {photons[i].position, static_cast<std::uint32_t>(i)};
    }
    std::vector<Photon> heap(photons.size());
    from.resize(photons.size());
    Builder(photons, heap, from).build(items, 1);
    return heap;
}

std::uint32_t first_disorder(const PhotonKd& tree) {
    const std::span<const Photon> nodes = tree.nodes();
    std::atomic<std::uint32_t> first{tree.size()};
    // Each photon against all of its ancestors: on which side of each split does it lie?
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, tree.size(), 4096), [&](const auto& range) {
        for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
            bool fits = trace::is_finite(nodes[i].position) && PhotonKd::axis(nodes[i]) < 3;
            for (std::uint64_t slot = i + std::uint64_t{1}; fits && slot > 1; slot /= 2) {
                const Photon& parent = nodes[slot / 2 - 1];
                if (PhotonKd::axis(parent) == 3) break;
                const float delta =
                    nodes[i].position[PhotonKd::axis(parent)] - parent.position[PhotonKd::axis(parent)];
                fits = slot % 2 == 0 ? delta <= 0 : delta >= 0;
            }
            if (!fits) {
                std::uint32_t seen = first.load();
                while (i < seen && !first.compare_exchange_weak(seen, i)) {
                }
                return;
            }
        }
    });
    return first.load();
}

}  // namespace regather::spatial
