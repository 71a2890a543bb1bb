#include "capture/sampling/operations.h"

#include <algorithm>
#include <cmath>

namespace regather::capture {
namespace {

/// Comparisons of a binary search among so many parts.
double steps(double parts) {
    return parts > 1 ? std::ceil(std::log2(parts)) : 0;
}

// Parts that strategies share. Each is a function of the same name or place, read line by line.
constexpr Operations turned{.multiply = 9, .add = 6};  // Frame::to_world(), to_local()
constexpr Operations framed{.multiply = 9, .add = 3, .divide = 1};
constexpr Operations on_disc{.multiply = 3, .add = 1, .compare = 1, .function = 4};  // cosine_hemisphere()
constexpr Operations cosine_pdf{.multiply = 4, .add = 2, .compare = 1};
constexpr Operations two_numbers{.random = 2};
constexpr Operations glossy_pdf{.multiply = 34, .add = 26, .divide = 5, .compare = 6, .function = 3};
constexpr Operations glossy_draw{
    .multiply = 45, .add = 30, .divide = 6, .compare = 4, .function = 6, .random = 3};
constexpr Operations glossy_brdf{.multiply = 36, .add = 22, .divide = 2, .compare = 5, .function = 4};
constexpr Operations part_found{.add = 2, .divide = 1, .compare = 3, .read = 2};  // behind the search

constexpr Operations cosine_draw = on_disc + turned + cosine_pdf + two_numbers;

Operations scattering_draw(bool glossy) {
    return glossy ? glossy_draw + glossy_pdf : cosine_draw;
}
Operations scattering_pdf(bool glossy) {
    return glossy ? glossy_pdf : cosine_pdf;
}

Operations searched(double parts) {
    return part_found + steps(parts) * Operations{.compare = 1, .read = 1};
}

/// A HemisphereTable.
struct TableCost {
    double rows, columns;

    explicit TableCost(const trace::Parameters& given)
        : rows(given.count("rows")), columns(given.count("columns")) {}
    double cells() const { return rows * columns; }
    std::uint32_t bytes() const { return static_cast<std::uint32_t>(4 * (cells() + rows)); }
    Operations cell_of() const {
        return Operations{.multiply = 3, .add = 1, .compare = 3} +
               steps(columns / 2) * Operations{.multiply = 2, .add = 1, .compare = 1, .read = 1};
    }
    Operations set() const {
        const Operations of_cell{.multiply = 1, .add = 5, .divide = 3, .compare = 1, .read = 4},
            of_row{.add = 2, .divide = 1, .compare = 1, .read = 1};
        return cells() * of_cell + rows * of_row;
    }
    Operations density() const { return {.multiply = 5, .add = 2, .read = 4}; }
    Operations draw() const {
        return searched(rows) + searched(columns) + Operations{.add = 2, .divide = 2, .compare = 1} +
               on_disc + density() + turned + two_numbers;
    }
    Operations pdf() const { return turned + cell_of() + density() + Operations{.compare = 1}; }
    /// Each cell times the BRDF towards its middle.
    Operations times_brdf() const {
        const Operations of_cell =
            Operations{.multiply = 3, .add = 7, .divide = 3, .read = 3} + on_disc + turned + glossy_brdf;
        return cells() * of_cell;
    }
};

Operations incident_table(const trace::Parameters& given) {
    const TableCost table(given);
    const Operations photon =
        turned + table.cell_of() + Operations{.multiply = 1, .add = 4, .compare = 1, .read = 2};
    Operations all = framed + given.count("k") * photon + table.set();
    if (given.count("smooth") != 0)
        all = all + table.cells() * Operations{.multiply = 2, .add = 5, .read = 13};
    if (given.count("shrink") != 0)
        all = all + table.cells() * Operations{.multiply = 2, .add = 5, .read = 4} +
              Operations{.add = 1, .divide = 2, .compare = 2};
    return all;
}

// Of the doubled sphere.
constexpr Operations doubling{.multiply = 13, .add = 4, .divide = 1, .compare = 1, .function = 1};
constexpr Operations halving{.multiply = 6, .add = 2, .divide = 2, .compare = 2, .function = 2};
constexpr Operations turned_about{.multiply = 22, .add = 11, .divide = 1, .compare = 1, .function = 3};
constexpr Operations witnessed = turned + doubling + Operations{.add = 2, .compare = 2};

/// A draw with its density, without what choosing a lobe and its density take.
constexpr Operations drawn_on_sphere = Operations{.multiply = 3, .add = 4, .divide = 2, .compare = 3} +
                                       turned_about + halving + turned + turned + doubling + two_numbers;

}  // namespace

SamplingCost cost_of_uniform(const trace::Parameters&, bool) {
    return {.sample = Operations{.multiply = 1, .add = 2} + on_disc + turned + two_numbers};
}

SamplingCost cost_of_cosine(const trace::Parameters&, bool) {
    return {.sample = cosine_draw};
}

SamplingCost cost_of_scattering(const trace::Parameters&, bool glossy) {
    return {.sample = scattering_draw(glossy)};
}

SamplingCost cost_of_incident(const trace::Parameters& given, bool) {
    const TableCost table(given);
    return {.bytes = table.bytes(), .searches = 1, .table = incident_table(given), .sample = table.draw()};
}

SamplingCost cost_of_combined(const trace::Parameters& given, bool glossy) {
    SamplingCost cost = cost_of_incident(given, glossy);
    if (glossy) cost.table = cost.table + TableCost(given).times_brdf();
    return cost;
}

SamplingCost cost_of_lobes(const trace::Parameters& given, bool) {
    const double photons = given.count("k"), lobes = given.count("lobes");
    const Operations photon = witnessed + Operations{.multiply = 1, .add = 2},
                     spread = turned_about + Operations{.multiply = 4, .add = 4, .divide = 2, .compare = 1},
                     part{.multiply = 10, .add = 10, .function = 1, .read = 13},
                     weight{.multiply = 1, .divide = 1},
                     maximised{.multiply = 8, .add = 6, .divide = 4, .compare = 2, .function = 1, .read = 9},
                     peak{.multiply = 3, .divide = 2, .compare = 1, .function = 1, .read = 2},
                     pair{.multiply = 17, .add = 8, .divide = 4, .compare = 3, .function = 5, .read = 10},
                     kept{.add = 1, .read = 5};
    Operations table =
        framed + photons * photon + lobes * (spread + kept) +
        given.count("iterations") * (photons * lobes * part + photons * weight + lobes * (peak + maximised));
    if (given.count("shrink") != 0) table = table + lobes * lobes * pair;
    const Operations of_lobe{.multiply = 8, .add = 7, .divide = 2, .compare = 1, .function = 2, .read = 5},
        away{.multiply = 2, .divide = 1, .compare = 3, .function = 2};
    return {.bytes = static_cast<std::uint32_t>(20 * lobes + 8),
            .searches = 1,
            .table = table,
            .sample = drawn_on_sphere + searched(lobes) + away + lobes * of_lobe};
}

SamplingCost cost_of_footprints(const trace::Parameters& given, bool) {
    const double photons = given.count("k"), bands = std::round(std::sqrt(photons)),
                 overlapping = std::min(photons, given.count("neighbours") + 1.0);
    const Operations by_turn{.add = 2, .divide = 2, .compare = 5, .function = 2, .read = 4},
        by_height{.compare = 1, .read = 2},
        photon = witnessed + Operations{.add = 3, .divide = 1, .read = 5},
        // A median of three, on average, looks at each distance 3.4 times (Knuth, 5.3.3).
        distance{.multiply = 3, .add = 5, .compare = 3.4, .read = 3};
    const Operations table = framed + photons * photon + photons * steps(photons) * by_height +
                             photons * steps(photons / bands) * by_turn +
                             (photons > given.count("neighbours") ? photons * photons : 0) * distance;
    const Operations looked_at{.multiply = 4, .add = 5, .compare = 2, .read = 5}, hit{.add = 2, .divide = 1},
        of_band{.multiply = 1, .add = 2, .read = 2};
    return {.bytes = static_cast<std::uint32_t>(20 * photons + 16 * bands + 8),
            .searches = 1,
            .table = table,
            .sample = drawn_on_sphere + searched(bands) + searched(photons / bands) +
                      Operations{.multiply = 2} + photons * looked_at + overlapping * hit + bands * of_band};
}

SamplingCost cost_of_mixture(const trace::Parameters& given, bool glossy) {
    SamplingCost cost = cost_of_incident(given, glossy);
    const double of_brdf = given.count("brdf") / 100.0;
    const bool power = given.choice("heuristic", {"balance", "power"}) == 1;
    // Both densities are asked again of what either has drawn.
    cost.sample = of_brdf * scattering_draw(glossy) + (1 - of_brdf) * cost.sample + scattering_pdf(glossy) +
                  TableCost(given).pdf() + Operations{.multiply = 2, .add = 2, .divide = 1, .compare = 3} +
                  (power ? Operations{.multiply = 2, .add = 1, .divide = 1} : Operations{});
    return cost;
}

SamplingCost cost_of_oracle(const trace::Parameters& given, bool glossy) {
    const TableCost table(given);
    const double probes = static_cast<double>(given.count("probes")) * given.count("probes");
    const Operations probe = on_disc + turned + Operations{.multiply = 1, .add = 7, .divide = 4};
    SamplingCost cost{.bytes = table.bytes(), .sample = table.draw()};
    cost.rays = static_cast<std::uint64_t>(probes * table.cells());
    cost.table = framed +
                 table.cells() * (probes * probe + Operations{.divide = 1, .function = 1, .read = 1}) +
                 table.set();
    if (glossy && given.count("brdf") != 0) cost.table = cost.table + table.times_brdf();
    return cost;
}

}  // namespace regather::capture
