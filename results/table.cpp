#include "results/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "results/geometry.h"
#include "results/series.h"

namespace regather::results {
namespace {

constexpr std::array<const char*, 9> header = {"ordering", "tile",      "bins",   "traffic", "of naive",
                                               "x floor",  "ops/query", "buffer", "reorder"};
using Cells = std::array<std::string, header.size()>;
constexpr std::size_t longest_ordering = 30;

std::string heading(const Row& row) {
    std::vector<std::string> parts = {row.scene};
    if (row.frame) parts.push_back(fmt::format("frame {}", *row.frame));
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

std::string bytes(const Count& count) {
    return count ? decimal_bytes(*count) : "";
}
std::string number(const Count& count) {
    return count ? fmt::to_string(*count) : "";
}

bool same_name(const Row& a, const Row& b) {
    return a.ordering == b.ordering && a.tile == b.tile && a.bins == b.bins;
}

Cells cells_of(const Row& row, std::span<const Row* const> block) {
    const auto naive =
        std::find_if(block.begin(), block.end(), [](const Row* other) { return other->ordering == "naive"; });
    const bool ambiguous = std::any_of(block.begin(), block.end(), [&](const Row* other) {
        return same_name(row, *other) && other_parameters(row) != other_parameters(*other);
    });
    std::string ordering = row.ordering;
    if (const std::string parameters = other_parameters(row); ambiguous && !parameters.empty())
        ordering += " (" + parameters + ")";
    if (ordering.size() > longest_ordering) ordering = ordering.substr(0, longest_ordering - 3) + "...";
    const std::string share =
        naive == block.end() ? "" : ratio(row.traffic_bytes, (*naive)->traffic_bytes, 100);
    return {ordering,
            number(row.tile),
            row.bins ? fmt::format("{0}x{0}", *row.bins) : "",
            bytes(row.traffic_bytes),
            share.empty() ? "" : share + " %",
            ratio(row.traffic_bytes, row.compulsory_bytes, 1),
            per_query(row),
            bytes(row.buffered_bytes),
            bytes(row.reorder_bytes)};
}

std::string block_text(std::span<const Row* const> block) {
    std::vector<Cells> lines(1);
    std::copy(header.begin(), header.end(), lines[0].begin());
    for (const Row* row : block) lines.push_back(cells_of(*row, block));
    std::array<std::size_t, header.size()> widths{};
    for (const Cells& line : lines)
        for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());

    std::string out = heading(*block.front()) + '\n';
    for (const Cells& line : lines) {
        std::string text = fmt::format("{:<{}}", line[0], widths[0]);
        for (std::size_t c = 1; c < line.size(); ++c)
            fmt::format_to(std::back_inserter(text), "  {:>{}}", line[c], widths[c]);
        out += text.substr(0, text.find_last_not_of(' ') + 1) + '\n';
    }
    const std::string floor = floor_text(*block.front());
    return floor.empty() ? out : out + floor + '\n';
}

}  // namespace

std::string table(std::span<const Row> rows) {
    std::vector<std::pair<std::string, std::vector<const Row*>>> blocks;
    for (const Row& row : rows) {
        const std::string title = heading(row) + floor_text(row);
        auto block =
            std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.first == title; });
        if (block == blocks.end()) block = blocks.insert(block, {title, {}});
        block->second.push_back(&row);
    }
    std::string out;
    for (const auto& [title, block] : blocks) {
        if (!out.empty()) out += '\n';
        out += block_text(block);
    }
    return out;
}

}  // namespace regather::results
