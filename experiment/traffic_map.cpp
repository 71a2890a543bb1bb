#include "experiment/traffic_map.h"

#include <fmt/format.h>

#include "replay/pixel_traffic.h"
#include "trace/error.h"

namespace regather::experiment {

std::vector<TrafficMap> traffic_maps(trace::TraceReader& trace, const Orderings& orderings,
                                     const cachesim::CacheConfig& cache, const ProgressListener& progress) {
    const trace::TraceInfo& info = trace.info();
    const std::uint64_t pixels = std::uint64_t{info.image_width} * info.image_height;
    if (pixels > most_map_pixels)
        throw trace::DataError(fmt::format(
            "{}: found an image of {} x {} pixels, expected at most {} pixels for a map of them",
            (trace.folder() / "trace.json").string(), info.image_width, info.image_height, most_map_pixels));
    const Measurement measurement(trace, orderings.reads, reorder::default_onchip_bytes);
    const auto query_pixel = trace.column<std::uint32_t>("query_pixel");
    std::vector<TrafficMap> maps;
    for (const reorder::ParsedOrdering& parsed : orderings.all)
        maps.push_back(
            {parsed.spec.text,
             replay::pixel_traffic(
                 measurement.walks(), measurement.layout(), measurement.order(*parsed.ordering).permutation,
                 query_pixel, pixels, cache,
                 listening(progress, "replaying " + parsed.spec.text, "queries", measurement.queries()))});
    return maps;
}

}  // namespace regather::experiment
