// spatial/listed.h -- a structure of any form, whose walks are lists of elements (spatial/list_walk.h): what
// a replay knows of grids, trees of many children, and of whatever another program has walked.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "spatial/structure.h"

namespace regather::spatial {

/// Elements from 0 on.
class Listed final : public Structure {
public:
    struct Elements {
        std::vector<ElementRange> ranges{};    ///< From 0 on, without gaps.
        std::vector<std::uint32_t> parent{};   ///< What each hangs below; itself: nothing. Empty: not told.
        std::vector<std::uint32_t> level{};    ///< Empty: as the parents have it, or 0.
        std::vector<std::uint32_t> bytes{};    ///< Empty: a layout's record says it.
        std::vector<std::uint64_t> address{};  ///< Empty: not told.
        std::vector<std::uint32_t> record_begin{};  ///< Of each element of Region::photons, and of what would
                                                    ///< follow; empty: one record each.
        std::uint32_t node_bytes = 8;
        friend bool operator==(const Elements&, const Elements&) = default;
    };
    /// Columns that are not empty have a row for each element; parents lead to roots.
    Listed(std::string name, Elements elements);

    std::string_view name() const override { return name_; }
    const Elements& elements() const { return elements_; }
    std::uint32_t level(std::uint32_t element) const override { return level_.empty() ? 0 : level_[element]; }
    std::unique_ptr<WalkDecoder> decoder() const override;
    bool same_as(const Structure& other) const override;
    void append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const override;
    std::vector<std::uint32_t> roots() const override;
    std::uint32_t records(std::uint32_t element) const override;
    std::uint32_t first_record(std::uint32_t element) const override;
    bool tells_children() const override { return !elements_.parent.empty() || end() == 0; }
    std::uint32_t node_bytes() const override { return elements_.node_bytes; }
    std::span<const std::uint32_t> own_bytes() const override { return elements_.bytes; }
    std::span<const std::uint64_t> own_addresses() const override { return elements_.address; }

private:
    std::string name_;
    Elements elements_;
    std::vector<std::uint32_t> level_;
    ElementRange photons_;
    std::vector<std::uint32_t> child_begin_, child_;  // by element, and one more
};

inline constexpr std::uint32_t no_level = ~0u;
/// Steps from a root, by element; no_level where parents lead to none, but in a circle. Every parent is an
/// element.
std::vector<std::uint32_t> levels_below(std::span<const std::uint32_t> parent);

}  // namespace regather::spatial
