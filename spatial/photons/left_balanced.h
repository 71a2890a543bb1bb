// spatial/photons/left_balanced.h -- the left-balanced kd-tree (spatial/photons/photon_kd.h) as a structure
// that is walked: an element is a photon, its number the photon's place in the heap counted from 1, so that
// the children of i are 2i and 2i + 1.
#pragma once
#include "spatial/structure.h"

namespace regather::spatial {

class LeftBalanced : public Structure {
public:
    static constexpr std::string_view structure_name = "left-balanced-kd";
    /// Fewer than 2^31 photons.
    explicit LeftBalanced(std::uint32_t photons);

    std::string_view name() const override { return structure_name; }
    std::uint32_t level(std::uint32_t element) const override;
    std::unique_ptr<WalkDecoder> decoder() const override;
    void append_children(std::uint32_t element, std::vector<std::uint32_t>& to) const override;
    std::vector<std::uint32_t> roots() const override;
};

/// The same tree searched without a stack (Wald, "A Stack-Free Traversal Algorithm for Left-Balanced k-d
/// Trees", 2022): whoever comes back from a child reads the parent again, to know which child it was and
/// whether the other one is to be entered. The walks are the same; their visits are more. A child that does
/// not exist is known by its number and costs no visit.
class StackFree final : public LeftBalanced {
public:
    static constexpr std::string_view structure_name = "left-balanced-stack-free";
    using LeftBalanced::LeftBalanced;
    std::string_view name() const override { return structure_name; }
    std::unique_ptr<WalkDecoder> decoder() const override;
    bool comes_back() const override { return true; }
};

}  // namespace regather::spatial
