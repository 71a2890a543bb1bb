// study/half_vector.h -- the Blinn-Phong lobe in double precision, in the variables that its sampler should
// find evenly: u = cos^(exponent + 1) of the angle between half vector and normal, v = azimuth / 2 pi. The
// normal is (0, 0, 1).
#pragma once
#include <utility>

#include "capture/light/bsdf.h"
#include "trace/vec.h"

namespace regather::study {

class HalfVectorLobe {
public:
    /// Seen from `degrees` off the normal; a specular albedo of 1 and nothing diffuse.
    HalfVectorLobe(float exponent, double degrees);

    const capture::Material& material() const { return material_; }
    trace::Vec3 incoming() const { return incoming_; }

    struct Sample {
        trace::Vec3d direction;
        double along;  ///< incoming . half
        double power;  ///< (n . half)^exponent
    };
    Sample at(double u, double v) const;
    /// The u from which on half vectors of azimuth v give a direction on the surface's side; below it there
    /// is none.
    double least_u(double v) const;
    std::pair<double, double> place_of(trace::Vec3 direction) const;  ///< (u, v)

private:
    capture::Material material_;
    trace::Vec3 incoming_;
    double exponent_;
};

}  // namespace regather::study
