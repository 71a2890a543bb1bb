#include "charts/envelope.h"

#include <algorithm>
#include <limits>

#include "results/benefit.h"
#include "results/budget.h"

namespace regather::charts {
namespace {

/// At `budget`, or the largest number where the ordering needs more.
std::uint64_t least_net(const Envelope& envelope, std::uint64_t budget) {
    std::uint64_t net = std::numeric_limits<std::uint64_t>::max();
    for (const Step& step : envelope.steps)
        if (step.budget_bytes <= budget) net = step.net_bytes;
    return net;
}

}  // namespace

std::optional<std::uint64_t> budget_bytes(const results::Row& row) {
    if (!row.cache_bytes) return {};
    return *row.cache_bytes + (results::stays_on_chip(row) ? row.buffered_bytes.value_or(0) : 0);
}

std::vector<Envelope> envelopes(std::span<const results::Row> rows) {
    std::vector<Envelope> out;
    for (const results::Row& row : rows) {
        const auto budget = budget_bytes(row), net = results::net_traffic(row);
        if (!budget || !net) continue;
        auto own = std::find_if(out.begin(), out.end(),
                                [&](const Envelope& e) { return e.ordering == row.ordering; });
        if (own == out.end()) own = out.insert(own, {row.ordering, {}});
        own->steps.push_back({*budget, *net, &row});
    }
    for (Envelope& envelope : out) {
        std::stable_sort(envelope.steps.begin(), envelope.steps.end(), [](const Step& a, const Step& b) {
            return a.budget_bytes != b.budget_bytes ? a.budget_bytes < b.budget_bytes
                                                    : a.net_bytes < b.net_bytes;
        });
        std::vector<Step> kept;
        for (const Step& step : envelope.steps)
            if (kept.empty() || step.net_bytes < kept.back().net_bytes) kept.push_back(step);
        envelope.steps = std::move(kept);
    }
    return out;
}

std::vector<Reign> reigns(std::span<const Envelope> envelopes) {
    std::vector<std::uint64_t> budgets;
    for (const Envelope& envelope : envelopes)
        for (const Step& step : envelope.steps) budgets.push_back(step.budget_bytes);
    std::sort(budgets.begin(), budgets.end());
    budgets.erase(std::unique(budgets.begin(), budgets.end()), budgets.end());
    std::vector<Reign> out;
    for (const std::uint64_t budget : budgets) {
        std::size_t winner = 0;
        for (std::size_t e = 1; e < envelopes.size(); ++e)
            if (least_net(envelopes[e], budget) < least_net(envelopes[winner], budget)) winner = e;
        if (out.empty() || out.back().winner != winner) out.push_back({budget, winner});
    }
    return out;
}

}  // namespace regather::charts
