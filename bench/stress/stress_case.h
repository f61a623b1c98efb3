// The cases of a stress run: meshes made here or read from files, on the lattice, under the tree that the real builder
// makes.
#pragma once

#include <string>
#include <vector>

#include "build/build.h"
#include "stress/case_view.h"
#include "stress/shapes.h"
#include "sys/result.h"

namespace kd::stress {

struct StressCase {
  std::string mesh;  // the shape's name or the file's path
  Lattice lattice;
  CaseTraits traits;
  double weight = 1;
  std::vector<Vec3u> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  build::Tree tree;
  std::vector<TriangleVertices> expanded;  // what traversal reads
  std::vector<OracleTriangle> oracle_triangles;
  std::vector<uint32_t> places;
  std::vector<OracleBox> boxes;
  OracleView oracle;  // but for the pointers, which are null
  std::vector<render::InstanceView> placements;

  /// All but `placements` and `shaded`, which a view on the host adds.
  CaseView host_view() const;
};

/// A case and what its view points to, on the host.
class HostCase {
 public:
  explicit HostCase(const StressCase& stress_case);
  HostCase(const HostCase&) = delete;
  HostCase& operator=(const HostCase&) = delete;
  const CaseView& view() const { return view_; }

 private:
  render::ShadedObjectView shaded_;
  CaseView view_;
};

/// Errors as those of build_tree.
Result<StressCase> make_case(const ShapeRow& row, int bits);
/// Errors as those of reading, cleaning and building.
Result<StressCase> make_case(const std::string& mesh_path, int bits);
Result<StressCase> make_offset_ball(int bits);

}  // namespace kd::stress
