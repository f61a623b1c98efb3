// The rays that every tracer in a comparison gets: one primary ray a pixel, and for each primary hit one shadow ray to
// a point light and one cosine-distributed bounce. All arithmetic in double, rounded to float32 at the end, so that
// programs which agree on the hits agree on the rays to the bit; a hash says whether they did.
//
// Pixels come in Z-order, x lowest: 32 consecutive rays are a tile of 8 x 4 pixels.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "corners.h"
#include "nkd/object_file.h"
#include "render/trace.h"
#include "sys/result.h"

namespace kd::bench {

/// As a camera file has it: thirteen numbers; # starts a comment.
struct SharedCamera {
  Vec3d position, target, up;
  double vertical_fov_degrees = 60;
  Vec3d light;
};

/// A ray from t = 0, rounded to float32.
render::RayRecord record(Vec3d origin, Vec3d direction, float t_max);

/// ErrorClass::missing or usage.
Result<SharedCamera> read_camera(const std::string& path);

struct PrimaryRays {
  std::vector<uint32_t> pixels;  // y * width + x of each ray
  std::vector<render::RayRecord> rays;
};

PrimaryRays primary_rays(const SharedCamera& camera, uint32_t width, uint32_t height);

struct SecondaryRays {
  std::vector<render::RayRecord> shadow;   // any hit; t_max just before the light
  std::vector<render::RayRecord> diffuse;  // closest hit
  uint64_t facing = 0;                     // shadow rays whose surface faces the light
};

/// The corners of a source primitive that a ray hit, as the surface has them.
using CornersOf = std::function<Corners(int64_t primitive)>;

/// Where a ray that hit a triangle goes on: the hit point recomputed on the triangle's plane and moved 2e-5 of the
/// box's diagonal along the normal that faces the ray.
struct SurfacePoint {
  Vec3d lifted;
  Vec3d normal;  // length 1
};
SurfacePoint surface_point(const render::RayRecord& ray, float t_hit, const Corners& corners, double diagonal);

/// From primary hits (primitives are source triangles), at their surface points. `diagonal`: of the box.
SecondaryRays secondary_rays(const CornersOf& corners, double diagonal, const SharedCamera& camera,
                             const PrimaryRays& primary, std::span<const render::HitRecord> hits);
/// The same of an object: with its own vertices, that is, quantised ones.
SecondaryRays secondary_rays(const nkd::ObjectFile& object, const SharedCamera& camera, const PrimaryRays& primary,
                             std::span<const render::HitRecord> hits);

/// FNV-1a over the rays' 32-bit words.
uint64_t ray_hash(std::span<const render::RayRecord> rays);

}  // namespace kd::bench
