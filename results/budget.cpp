#include "results/budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "results/benefit.h"

namespace regather::results {
namespace {

constexpr std::uint64_t least_budget = 1024, most_budget = std::uint64_t{64} << 20;

std::string name_of(const Row& row) {
    return row.parameters.empty() ? row.ordering : row.parameters;
}

}  // namespace

bool stays_on_chip(const Row& row) {
    const std::uint64_t buffered = row.buffered_bytes.value_or(0);
    return row.onchip_bytes ? buffered <= *row.onchip_bytes : row.reorder_bytes.value_or(0) == 0;
}

std::optional<std::uint64_t> onchip_state(const Row& row) {
    return stays_on_chip(row) ? row.buffered_bytes : row.onchip_bytes;
}

const FrontStep* Front::within(std::uint64_t state_bytes) const {
    const FrontStep* best = nullptr;
    for (const FrontStep& step : steps)
        if (step.state_bytes <= state_bytes) best = &step;
    return best;
}

std::vector<Row> rows_of_shape(std::span<const Row> rows, std::optional<Geometry> cache) {
    std::vector<Row> out(rows.begin(), rows.end());
    std::erase_if(out, [](const Row& row) { return !geometry_of(row) || !net_traffic(row); });
    if (!cache) cache = commonest_geometry(out);
    std::erase_if(
        out, [&](const Row& row) { return row.line_bytes != cache->line_bytes || row.ways != cache->ways; });
    return out;
}

bool of_one_setting(std::span<const Row> rows) {
    const auto setting = [](const Row& row) {
        return std::tie(row.scene, row.frame, row.sampling, row.irradiance_cache, row.structure, row.layout,
                        row.policy);
    };
    return std::all_of(rows.begin(), rows.end(),
                       [&](const Row& row) { return setting(row) == setting(rows.front()); });
}

std::vector<Front> fronts(std::span<const Row> rows, Buffers buffers) {
    std::map<std::uint64_t, std::vector<FrontStep>> caches;
    for (const Row& row : rows) {
        const auto state = onchip_state(row), net = net_traffic(row);
        if (!state || !net || !row.cache_bytes) continue;
        if (buffers == Buffers::on_chip && !stays_on_chip(row)) continue;
        caches[*row.cache_bytes].push_back({*state, *net, &row});
    }
    std::vector<Front> out;
    for (auto& [cache, steps] : caches) {
        std::stable_sort(steps.begin(), steps.end(), [](const FrontStep& a, const FrontStep& b) {
            return std::tie(a.state_bytes, a.net_bytes) < std::tie(b.state_bytes, b.net_bytes);
        });
        Front& front = out.emplace_back(Front{cache, {}});
        for (const FrontStep& step : steps)
            if (front.steps.empty() || step.net_bytes < front.steps.back().net_bytes)
                front.steps.push_back(step);
    }
    return out;
}

std::vector<std::uint64_t> budgets() {
    std::vector<std::uint64_t> out;
    for (std::uint64_t budget = least_budget; budget <= most_budget; budget *= 4) out.push_back(budget);
    return out;
}

std::vector<Table> budget_tables(std::span<const Row> rows) {
    const std::vector<Front> kept = fronts(rows, Buffers::on_chip), any = fronts(rows, Buffers::anywhere);
    std::vector<Table> out;
    for (const Front& front : any) {
        const auto own = std::find_if(kept.begin(), kept.end(), [&](const Front& other) {
            return other.cache_bytes == front.cache_bytes;
        });
        Table& table = out.emplace_back(Table({{"best ordering", Align::left},
                                               {"on-chip state up to"},
                                               {"it keeps"},
                                               {"net traffic"},
                                               {"x floor", Align::right, {.if_any = true}},
                                               {"buffers", Align::left}}));
        Geometry geometry = *geometry_of(*front.steps.front().row);
        table.title = geometry_text(geometry);
        std::set<const Row*> told;
        for (const std::uint64_t budget : budgets())
            for (const FrontStep* step :
                 {own == kept.end() ? nullptr : own->within(budget), front.within(budget)}) {
                if (!step || !told.insert(step->row).second) continue;
                const Row& row = *step->row;
                const std::uint64_t floor = row.compulsory_bytes.value_or(0);
                table.add({name_of(row), binary_bytes(budget), binary_bytes(step->state_bytes),
                           decimal_bytes(step->net_bytes),
                           floor == 0 ? ""
                                      : fmt::format("{:.2f}", static_cast<double>(step->net_bytes) /
                                                                  static_cast<double>(floor)),
                           stays_on_chip(row) ? "on the chip" : "through memory"});
            }
    }
    return out;
}

std::vector<Row> front_rows(std::span<const Row> rows) {
    std::set<const Row*> on_front;
    for (const Buffers buffers : {Buffers::on_chip, Buffers::anywhere})
        for (const Front& front : fronts(rows, buffers))
            for (const FrontStep& step : front.steps) on_front.insert(step.row);
    std::vector<Row> out;
    for (const Row& row : rows)
        if (on_front.contains(&row)) out.push_back(row);
    return out;
}

}  // namespace regather::results
