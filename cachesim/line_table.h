// cachesim/line_table.h -- what is known of every line that ever came, by its number: a hash table with open
// addresses, 16 bytes a slot with a value of 8, at most 5/8 full.
#pragma once
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace regather::cachesim {

/// `Value::free()` says that a slot is empty, and is true of Value{}.
template <class Value>
class LineTable {
public:
    std::size_t size() const { return size_; }

    /// The line's value; a free one, to be set at once, if it had none. Valid until the
    /// next call.
    Value& enter(std::uint64_t line) {
        std::size_t at = place_of(line);
        if (!slots_[at].value.free()) return slots_[at].value;
        if (8 * (size_ + 1) > 5 * slots_.size()) {
            grow();
            at = place_of(line);
        }
        ++size_;
        slots_[at].line = line;
        return slots_[at].value;
    }
    /// Calls each(Value&) for every value, in no order; it stays one that is not free.
    template <class Each>
    void for_each(Each&& each) {
        for (Slot& slot : slots_)
            if (!slot.value.free()) each(slot.value);
    }

private:
    struct Slot {
        std::uint64_t line = 0;
        Value value;
    };
    std::size_t first_of(std::uint64_t line) const { return line * 0x9e3779b97f4a7c15 >> shift_; }
    /// Of the line, or the empty slot where it belongs.
    std::size_t place_of(std::uint64_t line) const {
        std::size_t at = first_of(line);
        while (!slots_[at].value.free() && slots_[at].line != line) at = (at + 1) & (slots_.size() - 1);
        return at;
    }
    void grow() {
        std::vector<Slot> former = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
        --shift_;
        for (const Slot& slot : former)
            if (!slot.value.free()) slots_[place_of(slot.line)] = slot;
    }

    static constexpr std::size_t least_slots = 64;
    std::vector<Slot> slots_ = std::vector<Slot>(least_slots);
    int shift_ = 64 - std::countr_zero(least_slots);
    std::size_t size_ = 0;
};

}  // namespace regather::cachesim
