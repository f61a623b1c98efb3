// A kd-tree node, as it is stored, mapped, uploaded and traversed: 8 bytes.
//
//   inner  word: the split plane's lattice coordinate, as a float32 (an integer, so exact)
//          link: index of the first child << 2 | axis (0, 1, 2); the second child (the far side of the plane, higher
//          coordinates) follows it, and the pair starts at an even index: one 16-byte line
//   leaf   word: index of the leaf's first triangle reference
//          link: number of references << 2 | 3
//
// Node 0 is the root; node 1 is an empty leaf that only keeps the pairs even. A child's index is greater than its
// parent's.
#pragma once

#include <bit>
#include <cstdint>

#include "core/platform.h"

namespace kd {

struct alignas(8) Node {
  uint32_t word = 0;
  uint32_t link = 3;

  friend bool operator==(const Node&, const Node&) = default;
};

constexpr uint32_t kMaxLink = (1u << 30) - 1;  // of a child's index and of a leaf's reference count
/// Longest path from the root to a leaf, in inner nodes: the size of the traversal's stack.
constexpr int kMaxDepth = 64;

KD_HD KD_INLINE float float_from_bits(uint32_t bits) { return std::bit_cast<float>(bits); }

KD_HD KD_INLINE bool is_leaf(Node n) { return (n.link & 3) == 3; }
KD_HD KD_INLINE int split_axis(Node n) { return static_cast<int>(n.link & 3); }
KD_HD KD_INLINE float split_plane(Node n) { return float_from_bits(n.word); }
KD_HD KD_INLINE uint32_t first_child(Node n) { return n.link >> 2; }
KD_HD KD_INLINE uint32_t first_reference(Node n) { return n.word; }
KD_HD KD_INLINE uint32_t reference_count(Node n) { return n.link >> 2; }

inline Node make_inner(int axis, uint32_t plane, uint32_t first_child_index) {
  return {std::bit_cast<uint32_t>(static_cast<float>(plane)), first_child_index << 2 | static_cast<uint32_t>(axis)};
}
inline Node make_leaf(uint32_t first, uint32_t count) { return {first, count << 2 | 3u}; }

}  // namespace kd
