// capture/irradiance/irradiance_metric.h -- how far about its point a record of irradiance serves: the one
// table of metrics.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "capture/irradiance/irradiance_estimate.h"
#include "capture/irradiance/irradiance_record.h"
#include "capture/irradiance/occlusion_hessian.h"
#include "trace/parameters.h"

namespace regather::capture {

/// What was gathered at a point.
struct GatheredHemisphere {
    const HemisphereGrid& grid;
    IrradiancePoint point;
    std::span<const Incoming> incoming;  ///< About Frame(point.normal), by the grid's cells.
    double spacing = 0;  ///< Between the surface's points of neighbouring pixels [scene units]; not above 0,
                         ///< or not finite: not known, and then it bounds nothing.
    double far = 1;      ///< As far as anything is looked at, above 0 and finite [scene units].
};

struct MetricInput {
    const GatheredHemisphere& gathered;
    const Frame& frame;
    const IrradianceEstimate& estimate;
    double tolerance;
    const trace::Parameters& given;
};

struct RecordReach {
    PlaneEllipse radii;   ///< Ward's R.
    bool raised = false;  ///< To what a record reaches at least, beyond what its light allows.
};

struct IrradianceMetric {
    std::string_view name, summary;
    std::span<const trace::Parameter> parameters;
    RecordReach (*reach)(const MetricInput& input);
};

/// The one table of metrics.
std::span<const IrradianceMetric> irradiance_metrics();

/// What a spec NAME:parameter=value,... asked for.
struct IrradianceCacheSpec {
    const IrradianceMetric* metric;
    trace::Parameters parameters;
    std::string text;  ///< All parameters, defaults too; a spec again.

    double tolerance() const { return parameters.count("tolerance") / 100.0; }  ///< Ward's a.
    /// Of a record; 0: not said.
    std::uint32_t rays() const { return parameters.count("rays"); }
    /// Pixels between the points of the first round of seeding, a power of two.
    std::uint32_t overture() const { return parameters.count("overture"); }
    /// From a record's begin to its end, and places to wait in, as WaitingConfig's.
    std::uint32_t latency() const { return parameters.count("latency"); }
    std::uint32_t entries() const { return parameters.count("entries"); }
    /// Whether a record's R is at most a neighbour's and the distance to it (Krivanek et al. 2006).
    bool clamps_neighbours() const { return parameters.count("neighbours") != 0; }
};
/// Throws trace::UsageError for an unknown metric, names the nearest and lists all, and for its parameters.
IrradianceCacheSpec parse_irradiance_cache(std::string_view spec);

/// Of any samples; its numbers are finite.
IrradianceRecord make_record(const IrradianceCacheSpec& spec, const GatheredHemisphere& gathered);

}  // namespace regather::capture
