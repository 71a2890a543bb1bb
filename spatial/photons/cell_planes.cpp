#include "spatial/photons/cell_planes.h"

#include <cmath>

namespace regather::spatial {
namespace {

constexpr std::uint32_t most_planes_along = 1u << 20;

/// Of a box, in doubles: floats may not hold it.
std::array<double, 3> sides_of(const trace::Bounds3& box) {
    std::array<double, 3> sides{};
    if (!box.empty())
        for (int axis = 0; axis < 3; ++axis)
            sides[static_cast<std::size_t>(axis)] = double{box.max[axis]} - double{box.min[axis]};
    return sides;
}

/// Cells of the size of which there are `along` along the longest side.
CellPlace counts_of(const std::array<double, 3>& sides, std::uint32_t along) {
    const double longest = std::max({sides[0], sides[1], sides[2]});
    CellPlace counts{1, 1, 1};
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (sides[axis] > 0)
            counts[axis] =
                std::clamp(static_cast<std::uint32_t>(std::ceil(sides[axis] / longest * along)), 1u, along);
    return counts;
}

}  // namespace

CellPlanes::CellPlanes(const trace::Bounds3& box, std::uint32_t along) {
    const std::array<double, 3> sides = sides_of(box);
    const CellPlace counts = counts_of(sides, along);
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const std::uint32_t count = counts[a];
        const double from = box.empty() ? 0 : double{box.min[axis]};
        std::vector<float>& planes = planes_[a];
        for (std::uint32_t i = 0; i < count; ++i)
            planes.push_back(static_cast<float>(from + sides[a] * (static_cast<double>(i) / count)));
        planes.push_back(box.empty() ? 0 : box.max[axis]);
    }
}

CellPlace CellPlanes::place(std::uint64_t number) const {
    CellPlace cell;
    cell[0] = static_cast<std::uint32_t>(number % count(0));
    cell[1] = static_cast<std::uint32_t>(number / count(0) % count(1));
    cell[2] = static_cast<std::uint32_t>(number / count(0) / count(1));
    return cell;
}

CellPlace CellPlanes::cell_of(Vec3 point) const {
    CellPlace cell;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float>& planes = planes_[static_cast<std::size_t>(axis)];
        const std::uint32_t last = count(axis) - 1;
        const float x = point[axis];
        // The last of the planes but one that is not above x: from a guess on.
        const double width = double{planes.back()} - double{planes.front()};
        const double guess = width > 0 ? (double{x} - double{planes.front()}) / width * (last + 1) : 0;
        std::uint32_t i = guess <= 0 ? 0 : guess >= last ? last : static_cast<std::uint32_t>(guess);
        while (i > 0 && x < planes[i]) --i;
        while (i < last && x >= planes[i + 1]) ++i;
        cell[static_cast<std::size_t>(axis)] = i;
    }
    return cell;
}

std::uint32_t cells_along(const trace::Bounds3& box, std::uint64_t cells) {
    const std::array<double, 3> sides = sides_of(box);
    std::uint32_t low = 1, high = most_planes_along + 1;  // low is few enough, high is too many
    if (std::max({sides[0], sides[1], sides[2]}) == 0) return 1;
    while (high - low > 1) {
        const std::uint32_t middle = low + (high - low) / 2;
        const CellPlace counts = counts_of(sides, middle);
        const double all = double{static_cast<double>(counts[0])} * counts[1] * counts[2];
        (all <= static_cast<double>(cells) ? low : high) = middle;
    }
    return low;
}

}  // namespace regather::spatial
