#include "results/traffic_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "results/benefit.h"
#include "results/geometry.h"
#include "results/parameters.h"

namespace regather::results {
namespace {

constexpr Table::Limits if_any{.if_any = true};
const Table::Head heads[] = {{"ordering", Align::left, {.most = 30}},
                             {"tile"},
                             {"bins"},
                             {"traffic"},
                             {"+-", Align::right, if_any},
                             {"of naive"},
                             {"x floor"},
                             {"3C [%]", Align::right, if_any},
                             {"ops/query"},
                             {"buffer"},
                             {"reorder"},
                             {"net", Align::right, if_any}};

std::string heading(const Row& row) {
    std::vector<std::string> parts = {row.scene};
    if (row.frame) parts.push_back(fmt::format("frame {}", *row.frame));
    for (const auto& text : {row.sampling, row.irradiance_cache})
        if (!text.empty()) parts.push_back(text);
    if (row.queries)
        parts.push_back(fmt::format("{} queries", decimal_count(static_cast<double>(*row.queries))));
    if (const auto geometry = geometry_of(row)) parts.push_back(geometry_text(*geometry));
    for (const auto& text : {row.policy, row.structure, row.layout}) parts.push_back(text);
    return joined(parts, " | ");
}

std::string floor_text(const Row& row) {
    return row.compulsory_bytes ? fmt::format("floor = compulsory traffic, each line fetched once: {}",
                                              decimal_bytes(*row.compulsory_bytes))
                                : "";
}

/// Three significant digits without an exponent: "0.00711", "1.22", "10500".
std::string ratio(const Count& part, const Count& whole, double scale) {
    if (!part || !whole || *whole == 0) return "";
    const double value = scale * static_cast<double>(*part) / static_cast<double>(*whole);
    if (value == 0) return "0";
    if (value < 0.00005) return "<0.0001";
    int decimals = 2;
    for (double edge = 0.9995; decimals < 4 && value < edge; edge /= 10) ++decimals;
    return fmt::format("{:.{}f}", value, value < 9.995 ? decimals : value < 99.95 ? 1 : 0);
}

std::string per_query(const Row& row) {
    return ratio(row.key_ops, row.queries, 1);
}

/// Half the width of the 95 % interval of sampled misses, and so of their traffic: "1.3 %".
std::string uncertainty(const Row& row) {
    if (row.set_sampling.value_or(1) == 1 || !row.misses_low || !row.misses_high ||
        *row.misses_high < *row.misses_low)
        return "";
    const std::string half = ratio(*row.misses_high - *row.misses_low, row.misses, 50);
    return half.empty() ? "" : half + " %";
}

/// Compulsory / capacity / conflict as shares of their sum: "0/60/40".
std::string classes(const Row& row) {
    if (!row.compulsory || !row.capacity || !row.conflict) return "";
    const auto sum = static_cast<double>(*row.compulsory + *row.capacity + *row.conflict);
    if (sum == 0) return "";
    const auto share = [&](const Count& part) { return 100 * static_cast<double>(*part) / sum; };
    return fmt::format("{:.0f}/{:.0f}/{:.0f}", share(row.compulsory), share(row.capacity),
                       share(row.conflict));
}

std::string net(const Row& row) {
    const auto bytes = net_traffic(row);
    return row.buffer_traffic_bytes && bytes ? decimal_bytes(*bytes) : "";
}

std::string bytes(const Count& count) {
    return count ? decimal_bytes(*count) : "";
}
std::string number(const Count& count) {
    return count ? fmt::to_string(*count) : "";
}

bool same_name(const Row& a, const Row& b) {
    return a.ordering == b.ordering && a.tile == b.tile && a.bins == b.bins;
}

std::vector<std::string> cells_of(const Row& row, std::span<const Row* const> block) {
    const auto naive =
        std::find_if(block.begin(), block.end(), [](const Row* other) { return other->ordering == "naive"; });
    const bool ambiguous = std::any_of(block.begin(), block.end(), [&](const Row* other) {
        return same_name(row, *other) && other_parameters(row) != other_parameters(*other);
    });
    std::string ordering = row.ordering;
    if (const std::string parameters = other_parameters(row); ambiguous && !parameters.empty())
        ordering += " (" + parameters + ")";
    const std::string share =
        naive == block.end() ? "" : ratio(row.traffic_bytes, (*naive)->traffic_bytes, 100);
    return {ordering,
            number(row.tile),
            row.bins ? fmt::format("{0}x{0}", *row.bins) : "",
            bytes(row.traffic_bytes),
            uncertainty(row),
            share.empty() ? "" : share + " %",
            ratio(row.traffic_bytes, row.compulsory_bytes, 1),
            classes(row),
            per_query(row),
            bytes(row.buffered_bytes),
            bytes(row.reorder_bytes),
            net(row)};
}

Table block_table(std::span<const Row* const> block) {
    Table out(std::vector<Table::Head>(std::begin(heads), std::end(heads)));
    out.title = heading(*block.front());
    for (const Row* row : block) out.add(cells_of(*row, block));
    const std::vector<bool> shown = out.shown();
    if (shown[7]) out.notes.push_back("3C = compulsory / capacity / conflict misses");
    if (shown[4]) out.notes.push_back("+- = half the 95 % confidence interval of the sampled misses");
    if (shown[11]) out.notes.push_back("net = traffic of photons and of reorder buffers");
    if (const std::string floor = floor_text(*block.front()); !floor.empty()) out.notes.push_back(floor);
    return out;
}

}  // namespace

std::vector<Table> traffic_tables(std::span<const Row> rows) {
    std::vector<std::pair<std::string, std::vector<const Row*>>> blocks;
    for (const Row& row : rows) {
        const std::string title = heading(row) + floor_text(row);
        auto block =
            std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.first == title; });
        if (block == blocks.end()) block = blocks.insert(block, {title, {}});
        block->second.push_back(&row);
    }
    std::vector<Table> out;
    for (const auto& [title, block] : blocks) out.push_back(block_table(block));
    return out;
}

std::string traffic_text(std::span<const Row> rows) {
    return text_of(traffic_tables(rows), 120);
}

}  // namespace regather::results
