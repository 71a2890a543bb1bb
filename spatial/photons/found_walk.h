// spatial/photons/found_walk.h -- walks that also tell which photons a search found, so that a replay can
// read what a search does not look at (power, direction) for those alone. Behind the bits of the walk
// (spatial/walk.h), from the next byte on: a bit for each photon that the search looked at, in that order, 1
// = found; padded with zeros to a byte.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "spatial/photons/nearest.h"
#include "spatial/structure.h"
#include "spatial/walk.h"

namespace regather::spatial {

/// Listens to nearest() as Walk does: WalkRecorder or ListWalkRecorder (spatial/list_walk.h).
template <class Walk>
class BasicFoundRecorder {
public:
    /// Photons have numbers below `photons`.
    explicit BasicFoundRecorder(std::uint32_t photons) : is_found_(photons) {}

    void visit(std::uint32_t element) { walk_.visit(element); }
    void near(bool upper) { walk_.near(upper); }
    void far(bool entered) { walk_.far(entered); }
    void look(std::uint32_t photon, bool) { looked_.push_back(photon); }

    /// Ends a walk that found `found`; returns its bytes.
    std::uint32_t finish(const NearestSet& found) {
        std::uint32_t walk_bytes = walk_.finish();
        for (std::size_t i = 0; i < found.size(); ++i) is_found_[found[i].node] = true;
        for (const std::uint32_t photon : looked_) walk_.push(is_found_[photon]);
        for (std::size_t i = 0; i < found.size(); ++i) is_found_[found[i].node] = false;
        walk_bytes += walk_.finish();
        looked_.clear();
        return walk_bytes;
    }
    std::span<const std::uint8_t> bytes() const { return walk_.bytes(); }
    std::uint64_t visited_nodes() const { return walk_.visited_nodes(); }

private:
    Walk walk_;
    std::vector<std::uint32_t> looked_;
    std::vector<bool> is_found_;
};
using FoundRecorder = BasicFoundRecorder<WalkRecorder>;

/// A structure whose walks tell it: an element of Region::photon_power for each photon, behind the others.
/// The visits of a walk end with those of the photons that were found, in the order in which they were looked
/// at.
class WithFound final : public Structure {
public:
    /// The search of `searched` looks at each photon once at most. Throws trace::DataError for 2^30 photons
    /// or more.
    WithFound(std::shared_ptr<const Structure> searched, std::string name);

    std::string_view name() const override { return name_; }
    /// Of an element of Region::photon_power: that of its photon.
    std::uint32_t level(std::uint32_t element) const override;
    std::unique_ptr<WalkDecoder> decoder() const override;
    bool same_as(const Structure& other) const override;
    void append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const override {
        searched_->append_children(element, to);
    }
    std::vector<std::uint32_t> roots() const override { return searched_->roots(); }
    bool tells_children() const override { return searched_->tells_children(); }
    std::uint32_t node_bytes() const override { return searched_->node_bytes(); }
    std::uint32_t records(std::uint32_t element) const override {
        return element < searched_->end() ? searched_->records(element) : 1;
    }
    std::uint32_t first_record(std::uint32_t element) const override {
        return searched_->first_record(element);
    }

private:
    std::shared_ptr<const Structure> searched_;
    std::string name_;
    std::vector<std::uint32_t> record_begin_;  // by element of Region::photons, and one more
};

}  // namespace regather::spatial
