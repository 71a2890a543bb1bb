#include <algorithm>

#include "replay/layouts/placement.h"

namespace regather::replay {
namespace {

class Scheme {
public:
    explicit Scheme(const spatial::Structure& structure) : structure_(structure) {}

    Placement run() {
        for (const std::uint32_t root : structure_.roots()) {
            std::uint32_t levels = 1;
            for (std::vector<std::uint32_t> level = below({root}); !level.empty(); level = below(level))
                ++levels;
            place(root, levels);
        }
        return std::move(placement_);
    }

private:
    std::vector<std::uint32_t> below(const std::vector<std::uint32_t>& level) const {
        std::vector<std::uint32_t> next;
        for (const std::uint32_t element : level) structure_.append_children(element, next);
        return next;
    }
    /// The first `levels` levels from `root` down.
    void place(std::uint32_t root, std::uint32_t levels) {
        if (levels == 1) {
            placement_.elements.push_back(root);
            return;
        }
        const std::uint32_t upper = levels / 2;
        place(root, upper);
        std::vector<std::uint32_t> lower{root};
        for (std::uint32_t l = 0; l < upper; ++l) lower = below(lower);
        for (const std::uint32_t element : lower) place(element, levels - upper);
    }

    const spatial::Structure& structure_;
    Placement placement_;
};

}  // namespace

Placement van_emde_boas_order(const spatial::Structure& structure) {
    return Scheme(structure).run();
}

}  // namespace regather::replay
