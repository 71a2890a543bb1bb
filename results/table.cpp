#include "results/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "results/benefit.h"
#include "results/geometry.h"
#include "results/parameters.h"

namespace regather::results {
namespace {

constexpr std::array<const char*, 12> header = {"ordering",  "tile",     "bins",    "traffic",
                                                "+-",        "of naive", "x floor", "3C [%]",
                                                "ops/query", "buffer",   "reorder", "net"};
/// Columns that are there only when one of their cells is not empty.
constexpr bool is_optional(std::size_t column) {
    return column == 4 || column == 7 || column == 11;
}
using Cells = std::array<std::string, header.size()>;
constexpr std::size_t longest_ordering = 30, widest = 120;

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

Cells cells_of(const Row& row, std::span<const Row* const> block) {
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

std::string block_text(std::span<const Row* const> block) {
    std::vector<Cells> lines(1);
    std::copy(header.begin(), header.end(), lines[0].begin());
    for (const Row* row : block) lines.push_back(cells_of(*row, block));
    std::array<std::size_t, header.size()> widths{};  // 0: left away
    std::size_t others = 0;
    for (std::size_t c = 0; c < header.size(); ++c) {
        const bool shown =
            !is_optional(c) ||
            std::any_of(lines.begin() + 1, lines.end(), [&](const Cells& line) { return !line[c].empty(); });
        if (!shown) continue;
        for (const Cells& line : lines) widths[c] = std::max(widths[c], line[c].size());
        if (c > 0) others += 2 + widths[c];
    }
    const std::size_t most =
        std::min(longest_ordering, std::max<std::size_t>(widest - std::min(others, widest), 12));
    for (Cells& line : lines)
        if (line[0].size() > most) line[0] = line[0].substr(0, most - 3) + "...";
    widths[0] = std::min(widths[0], most);

    std::string out = heading(*block.front()) + '\n';
    for (const Cells& line : lines) {
        std::string text = fmt::format("{:<{}}", line[0], widths[0]);
        for (std::size_t c = 1; c < line.size(); ++c)
            if (widths[c] > 0) fmt::format_to(std::back_inserter(text), "  {:>{}}", line[c], widths[c]);
        out += text.substr(0, text.find_last_not_of(' ') + 1) + '\n';
    }
    if (widths[7] > 0) out += "3C = compulsory / capacity / conflict misses\n";
    if (widths[4] > 0) out += "+- = half the 95 % confidence interval of the sampled misses\n";
    if (widths[11] > 0) out += "net = traffic of photons and of reorder buffers\n";
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
