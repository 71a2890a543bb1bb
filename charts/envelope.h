// charts/envelope.h -- the least net traffic that an ordering reaches within an on-chip budget, and which
// ordering wins at which budget. A budget [bytes] is spent on the cache and on the buffers that stay on the
// chip.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/row.h"

namespace regather::charts {

/// Cache, and the buffers when they fit into onchip_bytes; without onchip_bytes, when nothing of them goes
/// off the chip. Nothing without a cache.
std::optional<std::uint64_t> budget_bytes(const results::Row& row);

struct Step {
    std::uint64_t budget_bytes = 0;
    std::uint64_t net_bytes = 0;        ///< From this budget on, until the next step.
    const results::Row* row = nullptr;  ///< That reaches it.
};

/// Of one ordering over all its tiles, bins and parameters: budgets rise, net traffic falls, both strictly.
struct Envelope {
    std::string ordering;
    std::vector<Step> steps;
};

/// In the order of the orderings' first appearance. Rows without a budget or net traffic are left out. Rows
/// must outlive the envelopes.
std::vector<Envelope> envelopes(std::span<const results::Row> rows);

/// The reign of one ordering, until the next one's begins.
struct Reign {
    std::uint64_t from_bytes = 0;
    std::size_t winner = 0;  ///< Index into the envelopes.
    friend bool operator==(const Reign&, const Reign&) = default;
};

/// Who has the least net traffic at each budget; of equals, the first envelope.
std::vector<Reign> reigns(std::span<const Envelope> envelopes);

}  // namespace regather::charts
