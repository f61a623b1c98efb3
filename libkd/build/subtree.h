// Part of a tree in a frame of its own: its root at node 0, the filler at 1, pairs from 2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/node.h"

namespace kd::build {

struct Subtree {
  std::vector<Node> nodes{Node{}, Node{}};
  std::vector<uint32_t> references;

  /// Makes the node at `slot` an inner one and returns the index of its first child; the second follows.
  uint32_t open_inner(uint32_t slot, int axis, uint32_t plane) {
    const auto pair = static_cast<uint32_t>(nodes.size());
    nodes.resize(nodes.size() + 2);
    nodes[slot] = make_inner(axis, plane, pair);
    return pair;
  }
  /// Puts `part`'s root into `slot` and its rest behind what is here already.
  void append(const Subtree& part, uint32_t slot) {
    const auto node_shift = static_cast<uint32_t>(nodes.size()) - 2;
    const auto reference_shift = static_cast<uint32_t>(references.size());
    const auto moved = [&](Node n) {
      return is_leaf(n) ? Node{n.word + reference_shift, n.link} : Node{n.word, n.link + (node_shift << 2)};
    };
    nodes[slot] = moved(part.nodes[0]);
    for (size_t i = 2; i < part.nodes.size(); ++i) nodes.push_back(moved(part.nodes[i]));
    references.insert(references.end(), part.references.begin(), part.references.end());
  }
};

}  // namespace kd::build
