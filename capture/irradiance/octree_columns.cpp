#include "capture/irradiance/octree_columns.h"

#include "spatial/listed_columns.h"
#include "spatial/photons/structures.h"

namespace regather::capture {

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

void finish_searches(trace::TraceWriter& writer, const IrradianceOctree& octree, trace::TraceInfo& info) {
    const spatial::StructureSpec spec = spatial::parse_structure(spatial::brought_structure);
    const std::shared_ptr<const spatial::Listed> structure = octree.share_structure(spec.text);
    spatial::store_elements(writer, *structure);
    info.structure = spec.text;
    info.structure_version = spec.entry->version;
    info.left_out.push_back({"photon", "records of irradiance are searched"});
}

}  // namespace regather::capture
