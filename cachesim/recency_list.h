// cachesim/recency_list.h -- entries of an array in the order of their use: a list whose links are in the
// entries.
#pragma once
#include <cstdint>
#include <vector>

namespace regather::cachesim {

inline constexpr std::uint32_t no_entry = ~std::uint32_t{0};

/// What an entry must have, or be.
struct Links {
    std::uint32_t newer = no_entry, older = no_entry;
};

struct RecencyList {
    std::uint32_t newest = no_entry, oldest = no_entry;

    /// Entry `at` of the array, which is in the list, leaves it.
    template <class Entry>
    void leave(std::vector<Entry>& entries, std::uint32_t at) {
        const auto [newer, older] = static_cast<const Links&>(entries[at]);
        (newer == no_entry ? newest : entries[newer].older) = older;
        (older == no_entry ? oldest : entries[older].newer) = newer;
    }
    /// Entry `at`, which is in no list, becomes the newest.
    template <class Entry>
    void enter(std::vector<Entry>& entries, std::uint32_t at) {
        entries[at].newer = no_entry;
        entries[at].older = newest;
        (newest == no_entry ? oldest : entries[newest].newer) = at;
        newest = at;
    }
    /// Entry `at` of the list becomes the newest.
    template <class Entry>
    void renew(std::vector<Entry>& entries, std::uint32_t at) {
        if (at == newest) return;
        leave(entries, at);
        enter(entries, at);
    }
};

}  // namespace regather::cachesim
