// Part of a tree in a frame of its own: its root at node 0, the empty leaf at 1. Parts that were built at the same time
// hang in one another until the whole is flattened, once.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "build/split.h"
#include "core/node.h"

namespace kd::build {

struct Subtree {
  struct Graft {
    Graft(uint32_t s, std::unique_ptr<Subtree> p) : slot(s), part(std::move(p)) {}
    uint32_t slot;  // the node of this part that the other's root replaces
    std::unique_ptr<Subtree> part;
  };

  std::vector<Node> nodes{Node{}, Node{}};
  std::vector<uint32_t> references;
  std::vector<Graft> grafts;

  /// Makes the node at `slot` an inner one, with room for the children that are not empty, and returns where they are:
  /// the lower one at this index, the upper one behind it.
  uint32_t open_inner(uint32_t slot, const Split& split) {
    const EmptyChildren empty = split.empty();
    const auto next = static_cast<uint32_t>(nodes.size());
    const uint32_t first = empty == kLowerEmpty ? next - 1 : next;
    nodes.resize(nodes.size() + (empty == kNoneEmpty ? 2 : 1));
    nodes[slot] = make_inner(split.axis, split.plane, first, empty);
    return first;
  }

  uint64_t total_nodes() const {
    uint64_t total = nodes.size();
    for (const Graft& g : grafts) total += g.part->total_nodes() - 2;
    return total;
  }
  uint64_t total_references() const {
    uint64_t total = references.size();
    for (const Graft& g : grafts) total += g.part->total_references();
    return total;
  }

  /// Copies this part behind what `out` has, its root to `slot`, then what hangs in it; frees as it goes.
  void flatten_into(Subtree& out, uint32_t slot) {
    const auto node_shift = static_cast<uint32_t>(out.nodes.size()) - 2;
    const auto reference_shift = static_cast<uint32_t>(out.references.size());
    const auto moved = [&](Node n) {
      return is_leaf(n) ? Node{n.word + reference_shift, n.link} : moved_children(n, node_shift);
    };
    out.nodes[slot] = moved(nodes[0]);
    for (size_t i = 2; i < nodes.size(); ++i) out.nodes.push_back(moved(nodes[i]));
    out.references.insert(out.references.end(), references.begin(), references.end());
    nodes = {};
    references = {};
    for (Graft& g : grafts) {
      g.part->flatten_into(out, g.slot + node_shift);
      g.part.reset();
    }
  }
};

}  // namespace kd::build
