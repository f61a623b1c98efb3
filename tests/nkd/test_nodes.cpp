// check_nodes against a plain walk of the tree: the check that runs on every open takes nodes in blocks and infers more
// than it follows, so it must agree on trees with every kind of damage.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "nkd/structure.h"

using namespace kd;

namespace {

constexpr uint32_t kReferences = 1000;

/// A random tree in the order of a file: children behind their parents, node 1 the empty leaf.
std::vector<Node> random_tree(std::mt19937& random, uint32_t inner_nodes, int bits) {
  std::vector<Node> nodes{make_leaf(0, 0), make_leaf(0, 0)};
  std::vector<uint32_t> leaves{0};
  const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
  for (uint32_t k = 0; k < inner_nodes; ++k) {
    // The youngest leaf half of the time: deep trees and broad ones.
    const size_t at = random() % 2 ? leaves.size() - 1 : below(static_cast<uint32_t>(leaves.size()));
    const uint32_t parent = leaves[at];
    leaves.erase(leaves.begin() + static_cast<std::ptrdiff_t>(at));
    const auto next = static_cast<uint32_t>(nodes.size());
    const uint32_t empty = below(3) * kLowerEmpty;  // none, lower, upper
    nodes[parent] = make_inner(static_cast<int>(below(3)), below(lattice_max(bits) + 1),
                               next - (empty == kLowerEmpty ? 1 : 0), empty);
    for (uint32_t child = 0; child < (empty ? 1u : 2u); ++child) {
      leaves.push_back(static_cast<uint32_t>(nodes.size()));
      const uint32_t first = below(kReferences);
      nodes.push_back(make_leaf(first, below(kReferences - first + 1)));
    }
  }
  return nodes;
}

bool sound_below(const std::vector<Node>& nodes, int bits, uint32_t index, int inner_above, std::vector<int>& visits) {
  if (++visits[index] > 1) return false;
  const Node node = nodes[index];
  const uint32_t kind = node.link & 7;
  if (kind == 3 || kind > 4) return false;
  if (is_leaf(node)) return uint64_t{first_reference(node)} + reference_count(node) <= kReferences;
  const double plane = split_plane(node);
  if (!(plane >= 0 && plane <= lattice_max(bits)) || plane != std::floor(plane)) return false;
  if (inner_above >= kMaxDepth) return false;
  int stored = 0;
  for (uint32_t side = 0; side < 2; ++side) {
    if ((node.link >> (3 + side) & 1) != 0) continue;
    ++stored;
    const uint64_t child = uint64_t{node.link >> 5} + side;
    if (child >= nodes.size() || child <= index) return false;
    if (!sound_below(nodes, bits, static_cast<uint32_t>(child), inner_above + 1, visits)) return false;
  }
  return stored > 0;
}

bool sound_by_walking(const std::vector<Node>& nodes, int bits) {
  if (!is_leaf(nodes[kEmptyLeaf]) || reference_count(nodes[kEmptyLeaf]) != 0) return false;
  if (first_reference(nodes[kEmptyLeaf]) > kReferences || (nodes[kEmptyLeaf].link & 7) != 4) return false;
  std::vector<int> visits(nodes.size(), 0);
  if (!sound_below(nodes, bits, 0, 0, visits) || visits[kEmptyLeaf] != 0) return false;
  visits[kEmptyLeaf] = 1;
  return std::find(visits.begin(), visits.end(), 0) == visits.end();
}

void damage(std::vector<Node>& nodes, std::mt19937& random) {
  Node& node = nodes[random() % nodes.size()];
  const Node other = nodes[random() % nodes.size()];
  constexpr float kFloats[] = {
      -1.0f, -0.0f, 0.5f, 3e9f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
  switch (random() % 8) {
    case 0:
      node.link ^= 1u << random() % 32;
      break;
    case 1:
      node.word ^= 1u << random() % 32;
      break;
    case 2:
      node.link = other.link;
      break;
    case 3:
      node.word = other.word;
      break;
    case 4:
      node.link += 1u << 5;
      break;
    case 5:
      node.link -= 1u << 5;
      break;
    case 6:
      node.word = std::bit_cast<uint32_t>(kFloats[random() % std::size(kFloats)]);
      break;
    default:
      nodes.push_back(other);
      break;
  }
}

}  // namespace

TEST_CASE("nodes are found sound exactly when a walk of the tree finds them sound") {
  std::mt19937 random(3);
  int sound = 0, unsound = 0;
  for (int round = 0; round < 20000; ++round) {
    const int bits = 1 + static_cast<int>(random() % kMaxLatticeBits);
    // Some trees are longer than a block of the check, some deeper than what is allowed.
    std::vector<Node> nodes = random_tree(random, round % 50 == 0 ? 800u : static_cast<uint32_t>(random() % 90), bits);
    for (auto n = random() % 3; n > 0; --n) damage(nodes, random);
    nkd::Geometry geometry;
    const std::vector<uint32_t> references(kReferences, 0);
    geometry.nodes = nodes;
    geometry.references = references;
    geometry.bits = bits;
    const bool expected = sound_by_walking(nodes, bits);
    ++(expected ? sound : unsound);
    const nkd::Check check = nkd::check_nodes(geometry);
    CAPTURE(round);
    CAPTURE(check ? check->line() : "sound");
    REQUIRE(check.has_value() == !expected);
  }
  CHECK(sound > 5000);
  CHECK(unsound > 5000);
}
