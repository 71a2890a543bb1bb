#include "cachesim/machines/line_store.h"

namespace regather::cachesim {

LineStore::LineStore(const PolicyConfig& config)
    : cache_(config), states_(config.geometry.size_bytes / config.geometry.line_bytes) {}

LineState* LineStore::find(Line line) {
    const std::size_t slot = cache_.slot(line);
    return slot == PolicyCache::nowhere ? nullptr : &states_[slot];
}

const LineState* LineStore::find(Line line) const {
    const std::size_t slot = cache_.slot(line);
    return slot == PolicyCache::nowhere ? nullptr : &states_[slot];
}

LineStore::Inserted LineStore::insert(Line line, const LineState& state) {
    const auto [slot, evicted] = cache_.place(line, false, trace::Region::other);
    LineState& here = states_[slot];
    Inserted inserted{&here, {}};
    if (evicted) inserted.gone = HeldLine{evicted->line, here};  // it leaves its way to the one that comes
    here = state;
    return inserted;
}

std::optional<LineState> LineStore::remove(Line line) {
    const LineState* const here = find(line);
    if (!here) return std::nullopt;
    cache_.remove_at(slot_of(here));
    return *here;
}

std::vector<HeldLine> LineStore::drain() {
    std::vector<HeldLine> lines;
    for (std::size_t slot = 0; slot < states_.size(); ++slot)
        if (const std::optional<Resident> held = cache_.at(slot))
            lines.push_back({held->line, states_[slot]});
    cache_.clear();
    return lines;
}

}  // namespace regather::cachesim
