#include "spatial/photons/left_balanced.h"

#include <algorithm>
#include <bit>

#include "spatial/heap_walk.h"

namespace regather::spatial {
namespace {

std::vector<ElementRange> photons_from_one(std::uint32_t photons) {
    if (photons == 0) return {};
    return {{trace::Region::photons, 1, photons}};
}

/// Adds the way back to the visits of a search with a stack.
class StackFreeDecoder final : public WalkDecoder {
public:
    explicit StackFreeDecoder(std::unique_ptr<WalkDecoder> with_stack) : with_stack_(std::move(with_stack)) {}

    Visits decode(std::span<const std::uint8_t> walk) override {
        const auto [fault, nodes] = with_stack_->decode(walk);
        walk_bytes_ = with_stack_->walk_bytes();
        visited_.clear();
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            visited_.push_back(nodes[i]);
            // Up to the parent of the next node; at the end, to the root.
            const std::uint32_t until = i + 1 < nodes.size() ? nodes[i + 1] / 2 : 1;
            for (std::uint32_t at = nodes[i]; at != until;) visited_.push_back(at /= 2);
        }
        return {fault, visited_};
    }

private:
    std::unique_ptr<WalkDecoder> with_stack_;
    std::vector<std::uint32_t> visited_;
};

}  // namespace

LeftBalanced::LeftBalanced(std::uint32_t photons) : Structure(photons_from_one(photons)) {}

std::uint32_t LeftBalanced::level(std::uint32_t element) const {
    return static_cast<std::uint32_t>(std::bit_width(element)) - 1;
}

std::unique_ptr<WalkDecoder> LeftBalanced::decoder() const {
    return std::make_unique<HeapWalkDecoder>(end() == 0 ? 0 : end() - 1);
}

std::unique_ptr<WalkDecoder> StackFree::decoder() const {
    return std::make_unique<StackFreeDecoder>(LeftBalanced::decoder());
}

void LeftBalanced::append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const {
    for (std::uint64_t child = std::uint64_t{element} * 2;
         child < std::min<std::uint64_t>(end(), std::uint64_t{element} * 2 + 2); ++child)
        to.push_back(static_cast<std::uint32_t>(child));
}

std::vector<std::uint32_t> LeftBalanced::roots() const {
    if (end() == 0) return {};
    return {1};
}

}  // namespace regather::spatial
