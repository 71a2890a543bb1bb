// charts/subject.h -- rows of the other kinds in the terms of series.h: what was replayed through which
// cache, so that an ordering has the same name and look in every chart.
#pragma once
#include <algorithm>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "charts/chart.h"
#include "charts/series.h"

namespace regather::charts {

/// The columns that tell what was replayed. traffic_bytes is 0, as results stand elsewhere.
template <class R>
results::Row subject_of(const R& row) {
    results::Row out;
    out.scene = row.scene;
    out.ordering = row.ordering;
    out.tile = row.tile;
    out.bins = row.bins;
    out.parameters = row.parameters;
    if constexpr (requires { row.layout; }) {
        out.layout = row.layout;
        out.policy = row.policy;
    }
    out.cache_bytes = row.cache_bytes;
    out.line_bytes = row.line_bytes;
    out.ways = row.ways;
    out.traffic_bytes = 0;
    return out;
}

inline bool same_subject(const results::Row& a, const results::Row& b) {
    const auto key = [](const results::Row& row) {
        return std::tie(row.scene, row.ordering, row.tile, row.bins, row.parameters, row.layout, row.policy,
                        row.cache_bytes, row.line_bytes, row.ways);
    };
    return key(a) == key(b);
}

/// A curve made of rows of another kind; curve.rows holds its one subject.
template <class R>
struct Subject {
    Curve curve;
    std::vector<const R*> rows;
};
template <class R>
struct Subjects {
    std::vector<results::Row> keys;  ///< Where the curves' rows lie.
    std::vector<Subject<R>> all;
    results::Geometry cache;
    std::string skipped;
};

/// What a chart of one cache shows of `rows`: that cache (else the commonest), tiles and bins held as in
/// series.h.
template <class R>
Subjects<R> subjects(std::span<const R* const> rows, const ChartOptions& options) {
    Subjects<R> out;
    for (const R* row : rows) {
        const results::Row key = subject_of(*row);
        if (std::none_of(out.keys.begin(), out.keys.end(),
                         [&](const results::Row& k) { return same_subject(k, key); }))
            out.keys.push_back(key);
    }
    const auto common = results::commonest_geometry(out.keys);
    if (!common) {
        out.skipped = "no row has cache_bytes, line_bytes and ways";
        return out;
    }
    out.cache = options.cache.value_or(*common);
    std::erase_if(out.keys, [&](const results::Row& key) { return results::geometry_of(key) != out.cache; });
    for (const Curve& curve : curves(out.keys, Along::cache, {out.cache, options.tile, options.bins})) {
        Subject<R>& subject = out.all.emplace_back(Subject<R>{curve, {}});
        for (const R* row : rows)
            if (same_subject(subject_of(*row), *curve.rows.front())) subject.rows.push_back(row);
    }
    if (out.all.empty()) out.skipped = "no row has the cache " + results::geometry_text(out.cache);
    return out;
}

/// The curves alone, for the caption.
template <class R>
std::vector<Curve> curves_of(const Subjects<R>& subjects) {
    std::vector<Curve> out;
    for (const Subject<R>& subject : subjects.all) out.push_back(subject.curve);
    return out;
}

}  // namespace regather::charts
