// spatial/heap_walk.h -- walks (spatial/walk.h) over a tree whose nodes are numbered as in a heap: the
// children of i are 2i and 2i + 1, and every node up to the greatest is there.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spatial/structure.h"

namespace regather::spatial {

/// Decodes walks over a left-balanced tree. One thread at a time.
///
/// The tree is cut at the third level from below. Above it every node has two children, so a descent is a run
/// of near bits whose length is known: it is read at once, and the nodes are prefixes of one number; the far
/// children that are not yet decided are a set of levels, and a run of zero far bits drops as many of them.
/// Below it are subtrees of seven nodes, or three where the deepest level has ended: the next six, or two,
/// bits look their visits up in a table. So a step takes about six nodes, and no branch of it depends on the
/// bits.
class HeapWalkDecoder final : public WalkDecoder {
public:
    /// For walks over the nodes 1 .. `nodes` of a heap.
    explicit HeapWalkDecoder(std::uint32_t nodes);

    /// Elements are nodes, counted from 1.
    Visits decode(std::span<const std::uint8_t> walk) override;

private:
    struct Cursor;
    void subtree(Cursor& cursor, std::uint64_t slot);

    std::uint32_t nodes_;
    int cut_;  // level of the subtrees' roots; below 0 in a tree of fewer than four nodes
    std::vector<std::uint8_t> padded_;  // the walk, and zeros
    std::vector<std::uint32_t> visited_;
};

}  // namespace regather::spatial
