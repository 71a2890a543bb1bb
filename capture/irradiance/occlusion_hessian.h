// capture/irradiance/occlusion_hessian.h -- how irradiance bends when the point moves over its surface:
// second derivatives of what a mesh through the hemisphere's samples sends (Schwarzhaupt, Jensen & Jarosz,
// "Practical Hessian-Based Error Control for Irradiance Caching", SIGGRAPH Asia 2012), and the ellipse that a
// record may serve.
#pragma once
#include <span>

#include "capture/irradiance/irradiance_estimate.h"
#include "capture/light/bsdf.h"

namespace regather::capture {

/// A symmetric matrix over a plane.
struct PlaneHessian {
    double xx = 0, xy = 0, yy = 0;
    PlaneHessian& operator+=(PlaneHessian o) { return *this = {xx + o.xx, xy + o.xy, yy + o.yy}; }
    friend PlaneHessian operator*(PlaneHessian h, double s) { return {h.xx * s, h.xy * s, h.yy * s}; }
};

/// An edge's part of the irradiance of a polygon of radiance 1 is half the angle that it spans, times the
/// cosine between the normal of that angle's plane and the surface's (Lambert 1760; Arvo, "The Irradiance
/// Jacobian for Partially Occluded Polyhedral Sources", SIGGRAPH 1994). This is its second derivative as the
/// point moves in the plane z = 0, whose normal is z. Corners are relative to the point; those of a
/// polygon that turn about the normal from x towards y count as light. 0 for an edge that points at the
/// point, or has no length.
PlaneHessian edge_hessian(Vec3d from, Vec3d to);

/// Of the sum of the channels, in the plane of the frame's tangent and bitangent [W / m^2 / scene unit^2].
/// Neighbouring samples make triangles between the places that they met, each with the light of its
/// farthest corner: behind the edge of what is near, what is far comes into sight (Schwarzhaupt et al.; so
/// does radiance). What was met beyond `far` [scene units, above 0], or not at all, lies at `far`. Nothing is
/// known beyond the last row, so its outer border counts for nothing. 0 for a grid of one row.
PlaneHessian occlusion_hessian(const HemisphereGrid& grid, const Frame& frame,
                               std::span<const Incoming> incoming, double far);

/// An ellipse's half axes, x at least y, and the direction of the longer one in the plane.
struct PlaneEllipse {
    double longer = 0, shorter = 0;
    double x = 1, y = 0;
};
/// Where the error of going without second derivatives, lambda r^2 / 2 at r along each principal direction,
/// makes `error` [scene unit^2, above 0] in all over a disc: radius (4 error / (pi lambda))^(1/4), lambda
/// relative to `irradiance` (Schwarzhaupt et al.). The longer half axis is at most twice the shorter and at
/// most `longest`.
PlaneEllipse ellipse_of(PlaneHessian hessian, double irradiance, double error, double longest);

}  // namespace regather::capture
