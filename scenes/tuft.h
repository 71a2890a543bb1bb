// scenes/tuft.h -- a tuft of grass: blades as bent ribbons. Lengths in metres.
#pragma once
#include <cstdint>

#include "meshes/surface.h"
#include "trace/vec.h"

namespace regather::scenes {

using meshes::Surface;
using trace::Vec3;

/// Blades that start in a level disc and bend outward, each drawn from the seed. A blade is a flat ribbon of
/// `segments` - 1 quads and a triangle at its tip; it narrows towards the tip, is not closed and can be seen
/// from both sides. Its height and width are 60 to 100 % of those given.
struct Tuft {
    Vec3 center;  ///< Of the disc.
    float radius = 0.05f;
    std::uint32_t blades = 20;   ///< >= 1.
    float height = 0.2f;         ///< Of a tip above the disc: at most this.
    float width = 0.006f;        ///< Of a blade where it starts: at most this.
    float reach = 0.1f;          ///< From a blade's start to below its tip: at most this, at least a tenth.
    std::uint32_t segments = 3;  ///< Of a blade, >= 1.
    std::uint32_t seed = 0;
};

std::uint64_t triangle_count(const Tuft&);
Surface tessellate(const Tuft&);  ///< With smooth normals along each blade.

}  // namespace regather::scenes
