// charts/series.h -- which rows form one curve of a chart, what the curve is called and how it looks.
// A chart has one axis to run along; the other parameters are held at one value, so that a sweep over
// everything still gives a picture with one curve for each ordering.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "charts/figure.h"
#include "results/geometry.h"
#include "results/row.h"

namespace regather::charts {

enum class Along { tile, bins, cache };

/// Where the parameters that are not the axis are held. An ordering that was not measured at `tile` or `bins`
/// is shown at its nearest value (by ratio; of two equally near the smaller one).
struct Slice {
    results::Geometry cache;  ///< Along the cache axis, only its line size and ways count.
    std::uint64_t tile = 16, bins = 16;
    bool merge_frames = false;  ///< Rows that differ in their frame alone share a place: Curve::frames.
};

struct Curve {
    std::string label;
    std::string colour;
    int marker = 0;
    int variant = 0;    ///< Counts up among curves of one ordering; picks the dashes.
    bool flat = false;  ///< Its rows have no place on the axis (naive has no tiles): a level line.
    std::vector<const results::Row*> rows;  ///< Ascending along the axis; one row when flat.
    std::vector<std::vector<const results::Row*>>
        frames;  ///< Where frames share a curve: for each of `rows` those of all frames there, by frame.
};

double axis_value(const results::Row& row, Along along);  ///< Of a row that has one.

/// In the order of the rows' first appearance. Orderings that differ in a further column or parameter (frame,
/// layout, "rows=alternating") are curves of their own, named by what differs. Along `bins`, orderings
/// without bins are left out. Rows must outlive the curves. Throws trace::DataError when two rows contradict
/// each other.
std::vector<Curve> curves(std::span<const results::Row> rows, Along along, const Slice& slice);

/// A line in a curve's look, without points.
Line line_of(const Curve& curve);
/// In an ordering's look, whatever its parameters, among all of a picture.
Line line_of(const std::string& ordering, std::span<const std::string> all);

}  // namespace regather::charts
