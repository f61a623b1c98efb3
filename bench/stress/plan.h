// Which rays a stress run traces: so many in all, shared out to every class of every mesh at every number of bits.
#pragma once

#include <string>
#include <vector>

#include "stress/run.h"
#include "sys/progress.h"

namespace kd::stress {

struct ClassRow {
  RayClass ray_class;
  std::string_view name;
  std::string_view what;
};
/// One a class, in their order.
std::span<const ClassRow> class_rows();

/// A mesh of ours that is not one of shape_rows().
constexpr std::string_view kOffsetBall = "offset-ball";

/// What there is, as lists to read.
std::string class_names();
std::string mesh_names();

struct StressSettings {
  uint64_t rays = 10'000'000;
  uint64_t first = 0;  // number of each job's first ray: to replay one
  uint64_t seed = 1;
  std::vector<std::string> classes;  // empty: all
  std::vector<std::string> meshes;   // of those made here; empty: all, "none": none
  std::vector<std::string> files;
  std::vector<int> bits{kStressBits.begin(), kStressBits.end()};  // kStressBits.front() to kMaxLatticeBits
  render::TriangleTest test = render::TriangleTest::exact;
};

/// What came of one class at one mesh at one number of bits.
struct StressRow {
  std::string mesh;
  int bits = 0;
  RayClass ray_class = RayClass::vertices;
  uint64_t triangles = 0;  // of the mesh
  double seconds = 0;
  Tally tally;
  std::vector<Failure> failures;
};

/// With how many rays from inside the ball and the box other tracers were compared; a run of 10^7 or more has as many
/// at 21 bits, from as many points.
constexpr uint64_t kBallRays = 2'293'776;
constexpr uint64_t kBoxRays = 774'192;
constexpr uint64_t kRaysForAll = 10'000'000;

/// ErrorClass::usage for a name that there is not or a selection without rays; otherwise errors as those of making
/// cases and of the device, and ErrorClass::interrupted. Embree is given the rays, too, where the device is the CPU.
Result<std::vector<StressRow>> run_stress(const StressSettings& settings, const render::Device& device,
                                          const Progress& progress);

}  // namespace kd::stress
