// The checks of the sections that traversal reads.
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "nkd/first_beyond.h"
#include "nkd/structure.h"

namespace kd::nkd {

namespace {

/// The children of an inner node that are stored, one or two, which stand side by side: first > last if there is none.
struct Children {
  uint32_t first, last;
};

Children stored_children(Node inner) {
  static_assert(kUpperEmpty == 2 * kLowerEmpty);
  const uint32_t lower = first_child(inner), empty = empty_children(inner) / kLowerEmpty;
  return {lower + (empty & 1), lower + 1 - (empty >> 1)};
}

/// Whether the lowest bits are an axis, or a leaf's.
bool is_node(Node node) { return is_leaf(node) ? (node.link & 3) == 0 : (node.link & 3) != 3; }

bool is_lattice_plane(float plane, int bits) {
  return plane >= 0 && plane <= static_cast<float>(lattice_max(bits)) && plane == std::floor(plane);
}

/// Whether the nodes are sound, without saying what is not: the answer of find_unsound_node in a third of the time,
/// because no step of it waits for a branch that no processor could foresee (leaf or not?).
///
/// Children come behind their parents, so one pass from the front knows each node's depth when it comes to it. The
/// nodes are one tree if each has a parent and there are as many children as nodes: then none has two.
class FastNodeCheck {
 public:
  FastNodeCheck(std::span<const Node> nodes, size_t reference_count, int bits)
      : nodes_(nodes),
        count_(static_cast<uint32_t>(nodes.size())),
        references_(static_cast<uint32_t>(reference_count)),
        top_(static_cast<float>(lattice_max(bits))),
        depth_of_(nodes.size() + 1, 0) {}

  bool sound() {
    depth_of_[0] = depth_of_[kEmptyLeaf] = 1;
    for (uint32_t begin = 0; begin < count_; begin += kBlock) {
      const uint32_t size = std::min(kBlock, count_ - begin);
      if (!block_in_range(begin, size)) return false;
      // The depth of what is no inner node's child goes to the place behind the last.
      uint8_t* const depth_of = depth_of_.data();
      for (uint32_t j = 0; j < size; ++j) {
        const auto depth = static_cast<uint8_t>(depth_of[begin + j] + 1);  // what wraps to 0 counts as unreached
        depth_of[first_[j]] = depth;
        depth_of[last_[j]] = depth;
      }
    }
    bool deep_or_unreached = false;
    for (uint32_t i = 0; i < count_; ++i) {
      deep_or_unreached |=
          static_cast<uint8_t>(depth_of_[i] - 1) > kMaxDepth;  // a leaf's may be one more than a node's
    }
    return !deep_or_unreached && children_ == count_ - 2;
  }

 private:
  static constexpr uint32_t kBlock = 512;

  /// Whether this block's planes, leaves and children are in range; puts the children into first_ and last_.
  bool block_in_range(uint32_t begin, uint32_t size) {
    const Node* block = nodes_.data() + begin;
    uint32_t unsound = 0, children = 0;
    for (uint32_t j = 0; j < size; ++j) {
      const Node node = block[j];
      const uint32_t leaf = is_leaf(node) ? ~0u : 0u;
      const uint32_t outside = (node.word > references_) | (reference_count(node) > references_ - node.word);
      const auto [first, last] = stored_children(node);
      const uint32_t astray = (first > last) | (first <= begin + j) | (last >= count_);
      const float plane = split_plane(node);
      const float above = plane > 0 ? plane : 0;  // 0 for what is no number
      const float clamped = above < top_ ? above : top_;
      const uint32_t off = static_cast<float>(static_cast<int32_t>(clamped)) != plane;
      const uint32_t bits = node.link & 7;
      unsound |= (leaf & outside) | (~leaf & (astray | off)) | (bits == 3) | (bits > 4);
      children += ~leaf & (last - first + 1);
      first_[j] = (leaf & count_) | (~leaf & first);
      last_[j] = (leaf & count_) | (~leaf & last);
    }
    children_ += children;
    return unsound == 0;
  }

  std::span<const Node> nodes_;
  uint32_t count_, references_;
  float top_;
  std::vector<uint8_t> depth_of_;  // in nodes, of the path from the root; 0: no parent yet
  std::array<uint32_t, kBlock> first_, last_;
  uint32_t children_ = 0;
};

/// The bits of floats from 0 on are ordered as they are; those of infinities, NaNs and negative numbers come behind.
Check check_float_vertices(const Geometry& geometry) {
  constexpr auto kLargest = std::bit_cast<uint32_t>(static_cast<float>(lattice_max(kMaxLatticeBits)));
  const std::span words(reinterpret_cast<const uint32_t*>(geometry.vertices.data()), 3 * geometry.vertex_count());
  const size_t i = first_beyond(words, uint64_t{kLargest} + 1);
  if (i == words.size()) return std::nullopt;
  return found(Issue::vertex_value, fmt::format("vertex {}", i / 3));
}

/// The first unsound node, and what is wrong with it.
Check find_unsound_node(const Geometry& geometry) {
  const auto nodes = geometry.nodes;
  std::vector<uint8_t> depth_of(nodes.size(), 0);
  depth_of[0] = 1;
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    const Node node = nodes[i];
    const auto wrong = [&](Issue issue) { return found(issue, fmt::format("node {}", i)); };
    if (depth_of[i] == 0 && i != kEmptyLeaf) return wrong(Issue::unreached_node);
    if (!is_node(node)) return wrong(Issue::node_bits);
    if (is_leaf(node)) {
      const uint64_t end = uint64_t{first_reference(node)} + reference_count(node);
      if (end > geometry.references.size()) return wrong(Issue::leaf_range);
      continue;
    }
    if (depth_of[i] > kMaxDepth) return wrong(Issue::depth);
    if (!is_lattice_plane(split_plane(node), geometry.bits)) return wrong(Issue::plane);
    const auto [first, last] = stored_children(node);
    if (first > last || first <= i || last >= nodes.size()) return wrong(Issue::child_index);
    if ((depth_of[first] | depth_of[last]) != 0) return wrong(Issue::shared_child);
    depth_of[first] = depth_of[last] = static_cast<uint8_t>(depth_of[i] + 1);
  }
  return std::nullopt;
}

}  // namespace

Check check_nodes(const Geometry& geometry) {
  const auto nodes = geometry.nodes;
  if (nodes.size() < 2 || nodes.size() > kMaxChild) {
    return found(Issue::node_count, fmt::format("{} nodes", nodes.size()));
  }
  if (!is_leaf(nodes[kEmptyLeaf]) || reference_count(nodes[kEmptyLeaf]) != 0) return found(Issue::empty_leaf);
  if (FastNodeCheck(nodes, geometry.references.size(), geometry.bits).sound()) return std::nullopt;
  return find_unsound_node(geometry);
}

Check check_indices(const Geometry& geometry) {
  if (geometry.vertex_count() == 0 || !is_triples(geometry.vertices.size(), geometry.vertex_bits())) {
    return found(Issue::vertex_size);
  }
  if (geometry.triangle_count() == 0 || !is_triples(geometry.triangles.size(), geometry.corner_bits())) {
    return found(Issue::triangle_size);
  }
  if (const size_t i = first_beyond(geometry.references, geometry.triangle_count()); i < geometry.references.size()) {
    return found(Issue::reference, fmt::format("reference {}", i));
  }
  const size_t count = geometry.triangle_count();
  if (const size_t i = first_triple_beyond(geometry.packed().corners, count, geometry.vertex_count()); i < count) {
    return found(Issue::corner, fmt::format("triangle {}", i));
  }
  // Lattice points cannot be out of range: every number of `bits` bits is a coordinate.
  return geometry.form == VertexForm::float32 ? check_float_vertices(geometry) : std::nullopt;
}

}  // namespace kd::nkd
