#include "results/race_row.h"

#include <fmt/format.h>

namespace regather::results {
namespace {

constexpr Column race_columns[] = {
    column<&RaceRow::scene>("scene"),
    column<&RaceRow::structure>("structure", needed),
    column<&RaceRow::ordering>("ordering", Form::name, needed),
    column<&RaceRow::tile>("tile"),
    column<&RaceRow::bins>("bins"),
    column<&RaceRow::parameters>("parameters"),
    column<&RaceRow::queries>("queries", needed),
    column<&RaceRow::photons>("photons"),
    column<&RaceRow::k>("k"),
    column<&RaceRow::threads>("threads"),
    column<&RaceRow::repeats>("repeats"),
    column<&RaceRow::order_seconds_median>("order_seconds_median", Form::seconds, needed),
    column<&RaceRow::search_seconds_median>("search_seconds_median", Form::seconds, needed),
    column<&RaceRow::search_seconds_min>("search_seconds_min", Form::seconds),
    column<&RaceRow::search_seconds_max>("search_seconds_max", Form::seconds),
    column<&RaceRow::search_seconds_mad>("search_seconds_mad", Form::seconds),
    column<&RaceRow::net_gain_seconds>("net_gain_seconds", Form::signed_seconds),
    column<&RaceRow::radius>("radius"),
    column<&RaceRow::gathered>("gathered"),
};

}  // namespace

const RowKind& RaceRow::kind() {
    static constexpr RowKind kind{"race", race_columns};
    return kind;
}

Table race_table(std::span<const RaceRow> rows) {
    Table out({{"ordering", Align::left, {.most = 48}},
               {"structure", Align::left},
               {"order us"},
               {"search us"},
               {"+- mad"},
               {"net gain s"}});
    if (!rows.empty()) {
        const RaceRow& first = rows.front();
        const std::uint64_t threads = first.threads.value_or(0);
        out.title =
            fmt::format("{} | {} queries | {} photons | k {} | {} thread{} | medians of {} repeats",
                        first.scene, first.queries.value_or(0), first.photons.value_or(0),
                        first.k.value_or(0), threads, threads == 1 ? "" : "s", first.repeats.value_or(0));
    }
    for (const RaceRow& row : rows) {
        const auto per_query = [&](const Number& seconds) {
            return seconds && row.queries.value_or(0) > 0
                       ? fmt::format("{:.3f}", 1e6 * *seconds / static_cast<double>(*row.queries))
                       : "";
        };
        out.add({row.parameters.empty() ? row.ordering : row.parameters, row.structure,
                 per_query(row.order_seconds_median), per_query(row.search_seconds_median),
                 per_query(row.search_seconds_mad),
                 row.net_gain_seconds ? fmt::format("{:.3f}", *row.net_gain_seconds) : ""});
    }
    return out;
}

}  // namespace regather::results
