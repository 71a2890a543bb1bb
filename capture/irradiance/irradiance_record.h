// capture/irradiance/irradiance_record.h -- irradiance that is kept for the points about the one it was
// gathered at (Ward, Rubinstein & Clear, "A Ray Tracing Solution for Diffuse Interreflection", SIGGRAPH
// 1988).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "trace/vec.h"

namespace regather::capture {

using trace::Vec3;
using trace::Vec3d;

/// A point on a surface that irradiance is asked for at.
struct IrradiancePoint {
    Vec3 position;  ///< [scene units]
    Vec3 normal;    ///< Unit length, on the side that is lit.
};

/// What a record keeps: all numbers are finite.
struct IrradianceRecord {
    Vec3 position, normal;
    Vec3 irradiance;                            ///< [W / m^2]
    std::array<Vec3, 3> rotation, translation;  ///< As IrradianceEstimate's.
    Vec3 axis;                                  ///< Unit length, in the surface: the direction of `longer`.
    float longer = 0, shorter = 0;  ///< Ward's R along the axis and across it, at least 0 [scene units].
};
static_assert(sizeof(IrradianceRecord) == 128 && std::is_trivially_copyable_v<IrradianceRecord>);

/// Ward's error d / R + sqrt(1 - n . n') of what a record says at the point, whose inverse is the record's
/// weight w. 0 at the record's own point; infinite away from a record whose R is 0.
inline double error_at(const IrradianceRecord& record, const IrradiancePoint& point) {
    const Vec3d step = Vec3d(point.position) - Vec3d(record.position);
    const double along = dot(step, Vec3d(record.axis)), step2 = dot(step, step);
    const double longer = record.longer, shorter = record.shorter;
    double turns = std::sqrt(std::max(0.0, 1 - dot(Vec3d(point.normal), Vec3d(record.normal))));
    if (step2 == 0) return turns;
    if (!(shorter > 0)) return std::numeric_limits<double>::infinity();
    if (shorter == longer) return std::sqrt(step2) / longer + turns;
    const double across2 = std::max(0.0, step2 - along * along);
    return std::sqrt(along * along / (longer * longer) + across2 / (shorter * shorter)) + turns;
}

/// A record does not see what stands between it and a point behind it (Ward et al. 1988): further behind the
/// plane midway between both surfaces' than this share of R.
inline constexpr double behind_share = 0.05;

inline bool is_behind(const IrradianceRecord& record, const IrradiancePoint& point) {
    const Vec3d step = Vec3d(point.position) - Vec3d(record.position);
    const Vec3d normals = Vec3d(point.normal) + Vec3d(record.normal);
    return dot(step, normals) / 2 < -behind_share * static_cast<double>(record.shorter);
}

/// Whether the record serves the point: w > 1 / tolerance, and the point is not behind it.
inline bool serves(const IrradianceRecord& record, const IrradiancePoint& point, double tolerance) {
    return error_at(record, point) < tolerance && !is_behind(record, point);
}

/// How far from its point a record serves any point.
inline double reach_of(const IrradianceRecord& record, double tolerance) {
    return tolerance * static_cast<double>(record.longer);
}

/// The weighted mean of what records say of a point, each by its gradients (Ward & Heckbert 1992).
class IrradianceMean {
public:
    explicit IrradianceMean(const IrradiancePoint& point) : point_(point) {}

    void add(const IrradianceRecord& record) {
        // The weight at the record's own point is large, not infinite.
        const double weight = 1 / std::max(error_at(record, point_), 0x1p-20);
        const Vec3d step = Vec3d(point_.position) - Vec3d(record.position);
        const Vec3d turn = trace::cross(Vec3d(record.normal), Vec3d(point_.normal));
        Vec3d here = record.irradiance;
        for (int c = 0; c < 3; ++c) {
            const auto i = static_cast<std::size_t>(c);
            here[c] = std::max(0.0, here[c] + dot(turn, Vec3d(record.rotation[i])) +
                                        dot(step, Vec3d(record.translation[i])));
        }
        sum_ += here * weight;
        weights_ += weight;
    }
    bool empty() const { return weights_ == 0; }
    /// [W / m^2] Finite and at least 0; 0 of no records.
    Vec3 irradiance() const {
        if (empty()) return {};
        constexpr double most = std::numeric_limits<float>::max();
        const Vec3d mean = sum_ * (1 / weights_);
        return trace::to_float({std::min(mean.x, most), std::min(mean.y, most), std::min(mean.z, most)});
    }

private:
    IrradiancePoint point_;
    Vec3d sum_;
    double weights_ = 0;
};

}  // namespace regather::capture
