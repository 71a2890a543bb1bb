#include "spatial/listed.h"

#include "spatial/list_walk.h"

namespace regather::spatial {

std::vector<std::uint32_t> levels_below(std::span<const std::uint32_t> parent) {
    constexpr std::uint32_t unknown = no_level - 1, on_path = no_level - 2;
    std::vector<std::uint32_t> level(parent.size(), unknown), path;
    for (std::uint32_t e = 0; e < parent.size(); ++e) {
        std::uint32_t at = e;
        for (path.clear(); level[at] == unknown; at = parent[at]) {
            level[at] = on_path;
            path.push_back(at);
        }
        // `at` is a root that was just met, part of a circle, or known from before.
        const bool is_root = level[at] == on_path && parent[at] == at && path.back() == at;
        if (is_root) {
            level[at] = 0;
            path.pop_back();
        }
        std::uint32_t above = level[at] == on_path ? no_level : level[at];
        for (; !path.empty(); path.pop_back())
            level[path.back()] = above = above == no_level ? no_level : above + 1;
    }
    return level;
}

Listed::Listed(std::string name, Elements elements)
    : Structure(elements.ranges),
      name_(std::move(name)),
      elements_(std::move(elements)),
      photons_(range_of(trace::Region::photons)) {
    const std::span<const std::uint32_t> parent = elements_.parent;
    level_ = elements_.level.empty() ? levels_below(parent) : elements_.level;
    if (parent.empty()) return;
    child_begin_.resize(parent.size() + 1);
    for (std::uint32_t e = 0; e < parent.size(); ++e)
        if (parent[e] != e) ++child_begin_[parent[e] + 1];
    for (std::size_t e = 0; e < parent.size(); ++e) child_begin_[e + 1] += child_begin_[e];
    child_.resize(child_begin_.back());
    std::vector<std::uint32_t> next(child_begin_.begin(), child_begin_.end() - 1);
    for (std::uint32_t e = 0; e < parent.size(); ++e)
        if (parent[e] != e) child_[next[parent[e]]++] = e;
}

std::unique_ptr<WalkDecoder> Listed::decoder() const {
    return std::make_unique<ListWalkDecoder>(end());
}

bool Listed::same_as(const Structure& other) const {
    const auto* const listed = dynamic_cast<const Listed*>(&other);
    return listed && Structure::same_as(other) && elements_ == listed->elements_;
}

void Listed::append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const {
    if (child_begin_.empty()) return;
    to.insert(to.end(), child_.begin() + child_begin_[element], child_.begin() + child_begin_[element + 1]);
}

std::vector<std::uint32_t> Listed::roots() const {
    std::vector<std::uint32_t> roots;
    for (std::uint32_t e = 0; e < end(); ++e)
        if (elements_.parent.empty() || elements_.parent[e] == e) roots.push_back(e);
    return roots;
}

std::uint32_t Listed::records(std::uint32_t element) const {
    const std::uint32_t photon = element - photons_.first;
    if (photon >= photons_.count || elements_.record_begin.empty()) return 1;
    return elements_.record_begin[photon + 1] - elements_.record_begin[photon];
}

std::uint32_t Listed::first_record(std::uint32_t element) const {
    const std::uint32_t photon = element - photons_.first;
    return elements_.record_begin.empty() ? photon : elements_.record_begin[photon];
}

}  // namespace regather::spatial
