// One mesh in all its forms on one device: speed, memory and error of each.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "measure_rays.h"
#include "pareto/fans.h"
#include "pareto/hausdorff.h"
#include "pareto/hit_errors.h"
#include "pareto/model_space.h"
#include "sys/progress.h"

namespace kd::bench {

/// How an object's vertices are stored, and by which test rays meet its triangles.
struct Form {
  VertexForm vertices = VertexForm::lattice;
  int bits = kDefaultLatticeBits;  // float32 vertices: of the lattice that the tree is on
  render::TriangleTest test = render::TriangleTest::exact;

  std::string name() const;
};

/// float32 with Moller-Trumbore, float32 with Woop, each of `bits` with the exact test, and, if they are among them,
/// the default bits with Moller-Trumbore too: what exactness costs, all else the same.
std::vector<Form> forms_of(const std::vector<int>& bits);

struct ParetoEffort {
  int warm_ups = 1;  // before each timed run, as the forms take turns
  int rounds = 5;    // of turns; >= 1
  uint64_t surface_parts = 200000;
};

constexpr std::array<const char*, 3> kRayClasses{"primary", "shadow", "diffuse"};

struct FormResult {
  Form form;
  uint64_t triangles = 0;
  uint64_t file_bytes = 0;
  uint64_t vertex_bytes = 0;  // of them, its vertices
  uint64_t device_bytes = 0;
  double max_displacement = 0;                 // model units
  std::array<std::vector<double>, 3> seconds;  // by ray class and round
  std::array<double, 3> mrays_per_second{};    // of the medians
  HitErrors hits;
  double rmse = 0;  // linear RGB
  double flip = 0;
  Hausdorff surface;
  FanCounts fans;
  uint64_t leaks = 0;  // rays at the fans that the tracer let through
};

struct MeshResult {
  std::string mesh, camera;        // files
  uint64_t triangles = 0;          // after cleaning
  double diagonal = 0;             // of the box, model units
  double longest = 0;              // edge of the box: what a step is a share of
  std::array<uint64_t, 3> rays{};  // the same for all forms, secondary ones from the reference's hits
  ModelSpaceDepth model_space;
  std::vector<FormResult> forms;

  /// A lattice step along the box's longest edge, model units.
  double step(int bits) const { return longest / lattice_max(bits); }
};

struct ParetoSubject {
  std::string mesh, camera;
  ImageSize size;
};

/// Objects are written to the folder `scratch`. Errors as those of reading, compiling and tracing;
/// ErrorClass::interrupted if `progress` says so.
Result<MeshResult> measure_mesh(const ParetoSubject& subject, const std::vector<Form>& forms,
                                const ParetoEffort& effort, const render::Device& device, const std::string& scratch,
                                const Progress& progress);

}  // namespace kd::bench
