#include "capture/irradiance/octree_columns.h"

#include "spatial/listed_columns.h"
#include "spatial/photons/structures.h"

namespace regather::capture {
namespace {

constexpr std::size_t kept_searches = 1 << 14;  // until they are written

}  // namespace

void write_searches(trace::TraceWriter& writer, const OctreeSearches& searches, trace::TraceInfo& info) {
    const auto append = [&](const char* name, const auto& rows) {
        writer.column(name).append(std::span(rows));
    };
    append("query_position", searches.position);
    append("query_pixel", searches.pixel);
    append("query_walk_bytes", searches.walk_bytes);
    append("walk", searches.walks);
    info.queries += searches.size();
    info.visited_nodes += searches.visited;
}

void write_seeding(const IrradianceSeeding& seeding, std::uint32_t image_width, SeedingTrace lookups,
                   SeedingTrace insertions) {
    if (!lookups.writer && !insertions.writer) return;
    spatial::ListWalkRecorder walk;
    OctreeElements<spatial::ListWalkRecorder> elements{walk, seeding.octree().nodes()};
    OctreeSearches looked_up, inserted;
    const auto write = [](const SeedingTrace& to, OctreeSearches& searches) {
        if (to.writer) write_searches(*to.writer, searches, to.info);
        searches = {};
    };
    const auto told_to = [&](const SeedingTrace& to, OctreeSearches& searches) {
        return [&, to](std::uint32_t point, auto&& repeat) {
            repeat(elements);
            const SeedPoint& at = seeding.point(point);
            searches.add(at.point.position, at.row * image_width + at.column, walk);
            if (searches.size() == kept_searches) write(to, searches);
        };
    };
    seeding.tell_again(told_to(lookups, looked_up), told_to(insertions, inserted));
    write(lookups, looked_up);
    write(insertions, inserted);
}

void finish_searches(trace::TraceWriter& writer, const IrradianceOctree& octree, trace::TraceInfo& info) {
    const spatial::StructureSpec spec = spatial::parse_structure(spatial::brought_structure);
    const std::shared_ptr<const spatial::Listed> structure = octree.share_structure(spec.text);
    spatial::store_elements(writer, *structure);
    info.structure = spec.text;
    info.structure_version = spec.entry->version;
    info.left_out.push_back({"photon", "records of irradiance are searched"});
}

}  // namespace regather::capture
