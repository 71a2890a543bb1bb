// capture/trace_columns.h -- which columns of a trace a capture writes, which it leaves out and why, and the
// writing.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "capture/gather_pass.h"
#include "capture/query_pass.h"
#include "scenes/needs.h"
#include "trace/folder.h"

namespace regather::capture {

/// Which optional columns are stored.
struct Columns {
    bool rays = true, direction = true, leaf_kd = true, leaf_bvh = true, stratum = true;
};
// Columns that the scene has no need of (scenes/needs.h) are left out in any case.

class TraceColumns {
public:
    /// Scene, needs and writer outlive the object. Rays belong to the global map's trace. `gathered`: whether
    /// gather rays ask the queries; what the eye asks for has no stratum.
    TraceColumns(const Scene& scene, const Columns& columns, const scenes::Needs& needs,
                 trace::TraceWriter& writer, bool gathered);
    ~TraceColumns();
    TraceColumns(const TraceColumns&) = delete;
    TraceColumns& operator=(const TraceColumns&) = delete;

    void write_photons(std::span<const trace::Photon> heap);
    /// The next pixels'.
    void write_queries(const Queries& queries, const Gathered& gathered);
    void write_rays(const PixelWork& work);

    /// leaves_kd and leaves_bvh, of the trees whose labels are stored: every label is below.
    void count_leaves(trace::Json& counts) const;
    std::vector<trace::LeftOut> left_out() const;

private:
    class LeafLabels;
    bool has_rays(RayKind kind) const;
    bool has_strata() const { return columns_.stratum && gathered_; }

    Columns columns_;
    const scenes::Needs& needs_;
    trace::TraceWriter& writer_;
    bool gathered_;
    std::unique_ptr<LeafLabels> labels_;
};

}  // namespace regather::capture
