#include "cli/meshes.h"

#include <cmath>

namespace kd::test {

std::string grid_ply(int side) {
  const int vertices = (side + 1) * (side + 1);
  std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
                    "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                    std::to_string(2 * side * side) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < vertices; ++i) {
    const auto x = static_cast<float>(i % (side + 1)), y = static_cast<float>(i / (side + 1));
    append(ply, x);
    append(ply, y);
    append(ply, 9 * std::sin(0.1f * x) * std::cos(0.07f * y));
  }
  for (int q = 0; q < side * side; ++q) {
    const int a = q / side * (side + 1) + q % side, b = a + 1, c = a + side + 1, d = c + 1;
    for (const int corner : {-1, a, b, d, -1, a, d, c}) {
      if (corner < 0) {
        append(ply, static_cast<unsigned char>(3));
      } else {
        append(ply, corner);
      }
    }
  }
  return ply;
}

}  // namespace kd::test
