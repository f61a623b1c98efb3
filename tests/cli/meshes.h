// Meshes that the command-line tests make themselves.
#pragma once

#include <string>

namespace kd::test {

inline const std::string kTetrahedronObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A displaced grid of 2 side^2 triangles, binary PLY.
std::string grid_ply(int side);

}  // namespace kd::test
