#include "experiment/workload.h"

#include <fmt/format.h>

#include "trace/error.h"

namespace regather::experiment {

reorder::Workload workload(trace::TraceReader& trace, const reorder::Reads& reads) {
    const trace::TraceInfo& info = trace.info();
    if (info.image_width == 0 || info.image_height == 0)
        throw trace::DataError(fmt::format("{}: {}: found 0, expected at least one pixel",
                                           (trace.folder() / "trace.json").string(),
                                           info.image_width == 0 ? "image_width" : "image_height"));
    const auto wanted = [&](bool read, const char* column) {
        return read || (reads.captured && trace.has(column));
    };
    reorder::Workload work;
    work.position = trace.column<trace::Vec3>("query_position");
    work.pixel = trace.column<std::uint32_t>("query_pixel");
    if (wanted(reads.direction, "query_direction"))
        work.direction = trace.column<trace::Vec3>("query_direction");
    if (wanted(reads.leaf_kd, "query_leaf_kd")) work.leaf_kd = trace.column<std::uint32_t>("query_leaf_kd");
    if (wanted(reads.leaf_bvh, "query_leaf_bvh"))
        work.leaf_bvh = trace.column<std::uint32_t>("query_leaf_bvh");
    if (wanted(reads.end, "query_end")) work.end = trace.column<trace::Vec3>("query_end");
    if (wanted(reads.guess, "query_guess")) work.guess = trace.column<trace::Vec3>("query_guess");
    work.bounds = trace::bounds_of(work.position);
    work.image_width = info.image_width;
    work.image_height = info.image_height;
    work.folder = trace.folder();
    return work;
}

reorder::Workload middle_of(const reorder::Workload& work, std::uint64_t count) {
    const std::size_t first = (work.position.size() - count) / 2;
    const auto part = [&](auto column) { return column.empty() ? column : column.subspan(first, count); };
    reorder::Workload middle = work;
    middle.position = part(work.position);
    middle.direction = part(work.direction);
    middle.pixel = part(work.pixel);
    middle.leaf_kd = part(work.leaf_kd);
    middle.leaf_bvh = part(work.leaf_bvh);
    middle.end = part(work.end);
    middle.guess = part(work.guess);
    middle.bounds = trace::bounds_of(middle.position);
    return middle;
}

}  // namespace regather::experiment
