#include "reorder/random.h"

#include <Random123/philox.h>
#include <tbb/parallel_for.h>

namespace regather::reorder {

Cost Random::assign_keys(const Workload&, std::uint64_t, std::span<std::uint64_t> keys) const {
    using Philox = r123::Philox4x32;
    const Philox::key_type key{{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)}};
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
        const auto drawn = Philox()(Philox::ctr_type{{static_cast<std::uint32_t>(i), 0, 0, 0}}, key);
        keys[i] = std::uint64_t{drawn[0]} << 32 | drawn[1];
    });
    return {};
}

}  // namespace regather::reorder
