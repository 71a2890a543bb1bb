#include "results/benefit.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "trace/error.h"

namespace regather::results {
namespace {

bool comparable(const Row& a, const Row& b) {
    const auto key = [](const Row& row) {
        return std::tie(row.scene, row.frame, row.sampling, row.irradiance_cache, row.structure, row.layout,
                        row.policy, row.cache_bytes, row.line_bytes, row.ways, row.onchip_bytes,
                        row.set_sampling);
    };
    return key(a) == key(b);
}

}  // namespace

std::optional<std::uint64_t> buffer_traffic(const Row& row) {
    return row.buffer_traffic_bytes ? row.buffer_traffic_bytes : row.reorder_bytes;
}

std::optional<std::uint64_t> net_traffic(const Row& row) {
    const auto buffers = buffer_traffic(row);
    if (!row.traffic_bytes || !buffers) return {};
    return *row.traffic_bytes + *buffers;
}

void fill_net_benefit(std::span<Row> rows) {
    for (Row& row : rows) {
        row.net_benefit_bytes.reset();
        const Row* naive = nullptr;
        for (const Row& other : rows) {
            if (other.ordering != "naive" || !other.traffic_bytes || !comparable(row, other)) continue;
            if (naive != nullptr && naive->traffic_bytes != other.traffic_bytes)
                throw trace::DataError(
                    fmt::format("rows of \"naive\" contradict each other: the same cache with {} and with {} "
                                "bytes of traffic, expected one measurement",
                                *naive->traffic_bytes, *other.traffic_bytes));
            naive = &other;
        }
        const auto net = net_traffic(row);
        if (naive == nullptr || !net) continue;
        row.net_benefit_bytes =
            static_cast<std::int64_t>(*naive->traffic_bytes) - static_cast<std::int64_t>(*net);
    }
}

}  // namespace regather::results
