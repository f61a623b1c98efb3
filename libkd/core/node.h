// A kd-tree node, as it is stored, mapped, uploaded and traversed: 8 bytes.
//
//   inner  word: the split plane's lattice coordinate, as a float32 (an integer, so exact)
//          link: first << 5 | empty << 3 | axis (0, 1, 2)
//   leaf   word: index of the leaf's first triangle reference
//          link: number of references << 3 | 4
//
// An inner node's lower child stands at index `first`, its upper one (the far side of the plane, higher coordinates) at
// `first` + 1. Of `empty`, bit 0 says that the lower child is an empty leaf, bit 1 that the upper one is: then nothing
// is stored for it, and the index belongs to some other node. A quarter of all cells are empty.
//
// Node 0 is the root; node 1 is the empty leaf that stands for all empty children. A child's index is greater than its
// parent's.
#pragma once

#include <bit>
#include <cstdint>

#include "core/platform.h"

namespace kd {

struct alignas(8) Node {
  uint32_t word = 0;
  uint32_t link = 4;

  friend bool operator==(const Node&, const Node&) = default;
};

constexpr uint32_t kEmptyLeaf = 1;              // index of the node that stands for all empty children
constexpr uint32_t kMaxChild = (1u << 27) - 1;  // of a child's index
constexpr uint32_t kMaxLeafReferences = (1u << 29) - 1;
/// Longest path from the root to a leaf, in inner nodes: the size of the traversal's stack.
constexpr int kMaxDepth = 64;

/// Which children of an inner node are empty leaves, as bits of a link.
enum EmptyChildren : uint32_t { kNoneEmpty = 0, kLowerEmpty = 8, kUpperEmpty = 16 };

KD_HD KD_INLINE float float_from_bits(uint32_t bits) { return std::bit_cast<float>(bits); }

KD_HD KD_INLINE bool is_leaf(Node n) { return (n.link & 4) != 0; }
KD_HD KD_INLINE int split_axis(Node n) { return static_cast<int>(n.link & 3); }
KD_HD KD_INLINE float split_plane(Node n) { return float_from_bits(n.word); }
KD_HD KD_INLINE uint32_t empty_children(Node n) { return n.link & (kLowerEmpty | kUpperEmpty); }
/// The index at which the lower child stands, or would; the upper one's is one more.
KD_HD KD_INLINE uint32_t first_child(Node n) { return n.link >> 5; }
/// The child on side 0 (lower) or 1 (upper): its index, kEmptyLeaf if it is empty.
KD_HD KD_INLINE uint32_t child_of(Node n, uint32_t side) {
  return (n.link & kLowerEmpty << side) != 0 ? kEmptyLeaf : first_child(n) + side;
}
/// The same inner node with its children `by` places further on.
inline Node moved_children(Node n, uint32_t by) { return {n.word, n.link + (by << 5)}; }
KD_HD KD_INLINE uint32_t first_reference(Node n) { return n.word; }
KD_HD KD_INLINE uint32_t reference_count(Node n) { return n.link >> 3; }

KD_HD KD_INLINE Node make_inner(int axis, uint32_t plane, uint32_t first, uint32_t empty = kNoneEmpty) {
  return {std::bit_cast<uint32_t>(static_cast<float>(plane)), first << 5 | empty | static_cast<uint32_t>(axis)};
}
KD_HD KD_INLINE Node make_leaf(uint32_t first, uint32_t count) { return {first, count << 3 | 4u}; }

}  // namespace kd
