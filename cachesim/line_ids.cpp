#include "cachesim/line_ids.h"

#include <fmt/format.h>

#include "trace/error.h"

namespace regather::cachesim {

std::uint32_t LineIds::operator()(Line line) {
    const auto number = static_cast<std::uint64_t>(line);
    const std::uint32_t next = size();
    Id& id = ids_.enter(number);
    if (!id.free()) return id.number;
    if (next == max_lines)
        throw trace::UsageError(
            fmt::format("lines: found more than {} different lines, expected fewer", max_lines));
    id.number = next;
    return next;
}

}  // namespace regather::cachesim
