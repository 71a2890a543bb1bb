#include "capture/trace_columns.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <optional>

#include "spatial/rays/triangle_bvh.h"
#include "spatial/rays/triangle_kd.h"

namespace regather::capture {
namespace {

template <class T>
void append(trace::TraceWriter& writer, std::string_view name, std::span<const T> rows) {
    writer.column(name).append(rows);
}
template <class T>
void append(trace::TraceWriter& writer, std::string_view name, const std::vector<T>& rows) {
    append(writer, name, std::span<const T>(rows));
}

/// What says whether a scene makes rays of this kind; null: every scene does.
const scenes::Need* need_of(const scenes::Needs& needs, RayKind kind) {
    if (kind == RayKind::shadow) return &needs.shadow_rays;
    return kind == RayKind::specular ? &needs.specular_rays : nullptr;
}

constexpr const char* ray_fields[] = {"origin", "direction", "extent", "pixel"};
std::string ray_column(RayKind kind, const char* field) {
    return fmt::format("ray_{}_{}", ray_kind_names[static_cast<std::size_t>(kind)], field);
}

}  // namespace

/// Labels of the leaves that the queries' hits lie in (the paper, section 6.3.2, "Other interesting
/// reorderings").
class TraceColumns::LeafLabels {
public:
    LeafLabels(const Scene& scene, const Columns& columns) {
        if (columns.leaf_kd) kd_.emplace(scene.vertices, scene.triangles);
        if (columns.leaf_bvh) bvh_.emplace(scene.vertices, scene.triangles);
    }
    std::vector<std::uint32_t> kd(const Queries& queries) const {
        return labels(queries.size(), [&](std::size_t q) { return kd_->leaf_of(queries.position[q]); });
    }
    std::vector<std::uint32_t> bvh(const Queries& queries) const {
        return labels(queries.size(),
                      [&](std::size_t q) { return bvh_->leaf_of_triangle(queries.triangle[q]); });
    }

    void count(trace::Json& counts) const {
        if (kd_) counts["leaves_kd"] = kd_->leaf_count();
        if (bvh_) counts["leaves_bvh"] = bvh_->leaf_count();
    }

private:
    template <class Label>
    static std::vector<std::uint32_t> labels(std::size_t count, const Label& label) {
        std::vector<std::uint32_t> result(count);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t q) { result[q] = label(q); });
        return result;
    }
    std::optional<spatial::TriangleKd> kd_;
    std::optional<spatial::TriangleBvh> bvh_;
};

TraceColumns::TraceColumns(const Scene& scene, const Columns& columns, const scenes::Needs& needs,
                           trace::TraceWriter& writer, bool gathered)
    : columns_(columns),
      needs_(needs),
      writer_(writer),
      gathered_(gathered),
      labels_(std::make_unique<LeafLabels>(scene, columns)) {}

TraceColumns::~TraceColumns() = default;

bool TraceColumns::has_rays(RayKind kind) const {
    const scenes::Need* need = need_of(needs_, kind);
    return columns_.rays && (!need || need->needed);
}

void TraceColumns::write_photons(std::span<const trace::Photon> heap) {
    append(writer_, "photon", heap);
}

void TraceColumns::write_queries(const Queries& queries, const Gathered& gathered) {
    append(writer_, "query_position", queries.position);
    append(writer_, "query_pixel", queries.pixel);
    append(writer_, "query_weight", queries.weight);
    if (columns_.direction) append(writer_, "query_direction", queries.direction);
    if (columns_.leaf_kd) append(writer_, "query_leaf_kd", labels_->kd(queries));
    if (columns_.leaf_bvh) append(writer_, "query_leaf_bvh", labels_->bvh(queries));
    if (has_strata()) append(writer_, "query_stratum", queries.stratum);
    append(writer_, "query_walk_bytes", gathered.walk_bytes);
    append(writer_, "walk", gathered.walks);
}

void TraceColumns::write_rays(const PixelWork& work) {
    for (std::size_t k = 0; k < work.rays.size(); ++k) {
        const auto kind = static_cast<RayKind>(k);
        if (!has_rays(kind)) continue;
        const Rays& rays = work.rays[k];
        append(writer_, ray_column(kind, "origin"), rays.origin);
        append(writer_, ray_column(kind, "direction"), rays.direction);
        append(writer_, ray_column(kind, "extent"), rays.extent);
        append(writer_, ray_column(kind, "pixel"), rays.pixel);
    }
}

void TraceColumns::count_leaves(trace::Json& counts) const {
    labels_->count(counts);
}

std::vector<trace::LeftOut> TraceColumns::left_out() const {
    std::vector<trace::LeftOut> parts;
    const auto leave_out = [&](const char* column, bool stored) {
        if (!stored) parts.push_back({column, "no ordering asked for it"});
    };
    leave_out("query_direction", columns_.direction);
    leave_out("query_leaf_kd", columns_.leaf_kd);
    leave_out("query_leaf_bvh", columns_.leaf_bvh);
    if (gathered_)
        leave_out("query_stratum", columns_.stratum);
    else
        parts.push_back({"query_stratum", "no gather rays ask these queries"});
    for (std::size_t k = 0; k < ray_kind_names.size(); ++k) {
        const auto kind = static_cast<RayKind>(k);
        if (has_rays(kind)) continue;
        for (const char* field : ray_fields)
            parts.push_back({ray_column(kind, field),
                             columns_.rays ? need_of(needs_, kind)->reason : "no replay asked for rays"});
    }
    return parts;
}

}  // namespace regather::capture
