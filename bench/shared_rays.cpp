#include "shared_rays.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "object_triangles.h"

namespace kd::bench {

namespace {

/// The plain scaling: the comparison's definition, which the library's overflow-proof one would not match to the last
/// bit.
Vec3d unit(Vec3d a) {
  const double l = length(a);
  return l > 0 ? Vec3d{a.x / l, a.y / l, a.z / l} : a;
}

/// Calls visit(x, y) for the pixels of a film that lie in the square at (x, y), in Z-order, x lowest.
template <class Visit>
void for_each_in_z_order(uint32_t x, uint32_t y, uint64_t side, uint32_t width, uint32_t height, const Visit& visit) {
  if (x >= width || y >= height) return;
  if (side == 1) return visit(x, y);
  const auto half = static_cast<uint32_t>(side / 2);
  for_each_in_z_order(x, y, half, width, height, visit);
  for_each_in_z_order(x + half, y, half, width, height, visit);
  for_each_in_z_order(x, y + half, half, width, height, visit);
  for_each_in_z_order(x + half, y + half, half, width, height, visit);
}

/// A permutation of 32-bit words that scatters them (PCG's output function; Jarzynski and Olano, JCGT 2020).
uint32_t scatter(uint32_t v) {
  const uint32_t state = v * 747796405u + 2891336453u;
  const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

double unit_interval(uint32_t word) { return (word >> 8) * (1.0 / 16777216.0); }

/// Cosine-distributed about `n`; the frame's first axis is square to the axis on which n is least.
Vec3d bounce_direction(Vec3d n, uint32_t pixel) {
  const uint32_t first = scatter(pixel * 2654435761u + 12345u), second = scatter(first + 0x9e3779b9u);
  const double u1 = unit_interval(first), u2 = unit_interval(second);
  const double radius = std::sqrt(u1), angle = 6.283185307179586 * u2;
  const double x = radius * std::cos(angle), y = radius * std::sin(angle), z = std::sqrt(std::fmax(0.0, 1 - u1));
  const double ax = std::fabs(n.x), ay = std::fabs(n.y), az = std::fabs(n.z);
  const int least = ax < ay ? (ax < az ? 0 : 2) : (ay < az ? 1 : 2);
  Vec3d helper{0, 0, 0};
  helper.set(least, 1);
  const Vec3d tangent = unit(cross(helper, n)), bitangent = cross(n, tangent);
  return unit({x * tangent.x + y * bitangent.x + z * n.x, x * tangent.y + y * bitangent.y + z * n.y,
               x * tangent.z + y * bitangent.z + z * n.z});
}

}  // namespace

render::RayRecord record(Vec3d o, Vec3d d, float t_max) {
  const Vec3f of = vec_cast<float>(o), df = vec_cast<float>(d);
  return {of.x, of.y, of.z, 0, df.x, df.y, df.z, t_max};
}

Result<SharedCamera> read_camera(const std::string& path) {
  std::ifstream file(path);
  if (!file) return Error{ErrorClass::missing, path, "cannot open the camera file"};
  std::vector<double> numbers;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (end != word.c_str()) numbers.push_back(value);
    }
  }
  if (numbers.size() < 13) {
    return Error{ErrorClass::usage, path,
                 fmt::format("a camera is 13 numbers (position, target, up, vertical fov, light); this file has {}",
                             numbers.size())};
  }
  const auto vec = [&](size_t i) { return Vec3d{numbers[i], numbers[i + 1], numbers[i + 2]}; };
  const SharedCamera camera{vec(0), vec(3), vec(6), numbers[9], vec(10)};
  const Vec3d view = camera.target - camera.position;
  const bool sees = is_finite(view) && is_finite(camera.up) && is_finite(camera.light) && numbers[9] > 0 &&
                    numbers[9] < 180 && length(cross(unit(view), unit(camera.up))) > 1e-6;
  if (!sees) {
    return Error{ErrorClass::usage, path,
                 "the camera shows nothing: position and target differ, up is not along the view, 0 < fov < 180"};
  }
  return camera;
}

PrimaryRays primary_rays(const SharedCamera& camera, uint32_t width, uint32_t height) {
  PrimaryRays out;
  const Vec3d forward = unit(camera.target - camera.position);
  const Vec3d right = unit(cross(forward, camera.up)), up = cross(right, forward);
  const double half = std::tan(camera.vertical_fov_degrees * 3.14159265358979323846 / 360.0);
  const double aspect = static_cast<double>(width) / height;
  for_each_in_z_order(0, 0, std::bit_ceil(std::max(width, height)), width, height, [&](uint32_t x, uint32_t y) {
    const double sx = ((x + 0.5) / width * 2 - 1) * half * aspect, sy = (1 - (y + 0.5) / height * 2) * half;
    const Vec3d d{forward.x + sx * right.x + sy * up.x, forward.y + sx * right.y + sy * up.y,
                  forward.z + sx * right.z + sy * up.z};
    out.pixels.push_back(y * width + x);
    out.rays.push_back(record(camera.position, unit(d), 1e30f));
  });
  return out;
}

SurfacePoint surface_point(const render::RayRecord& r, float t_hit, const Corners& corners, double diagonal) {
  const double lift = 2e-5 * diagonal;
  const Vec3d o{r.ox, r.oy, r.oz}, d{r.dx, r.dy, r.dz};
  const auto& [a, b, c] = corners;
  Vec3d n = unit(cross(b - a, c - a));
  if (dot(d, n) > 0) n = -n;
  const double slope = dot(d, n);
  double t = slope != 0 ? dot(a - o, n) / slope : t_hit;
  if (!(std::fabs(t - t_hit) < 1e-2 * (1 + std::fabs(t_hit)))) t = t_hit;
  return {{o.x + t * d.x + lift * n.x, o.y + t * d.y + lift * n.y, o.z + t * d.z + lift * n.z}, n};
}

SecondaryRays secondary_rays(const CornersOf& corners, double diagonal, const SharedCamera& camera,
                             const PrimaryRays& primary, std::span<const render::HitRecord> hits) {
  SecondaryRays out;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].primitive < 0) continue;
    const SurfacePoint at = surface_point(primary.rays[i], hits[i].t, corners(hits[i].primitive), diagonal);
    const Vec3d way = camera.light - at.lifted;
    const Vec3d to_light = unit(way);
    out.facing += dot(to_light, at.normal) > 0;
    out.shadow.push_back(record(at.lifted, to_light, static_cast<float>(length(way) * (1 - 1e-5))));
    out.diffuse.push_back(record(at.lifted, bounce_direction(at.normal, primary.pixels[i]), 1e30f));
  }
  return out;
}

SecondaryRays secondary_rays(const nkd::ObjectFile& object, const SharedCamera& camera, const PrimaryRays& primary,
                             std::span<const render::HitRecord> hits) {
  const ObjectTriangles triangles(object);
  const auto corners = [&](int64_t primitive) { return triangles.corners(primitive); };
  return secondary_rays(corners, length(object.summary().lattice.extent), camera, primary, hits);
}

uint64_t ray_hash(std::span<const render::RayRecord> rays) {
  uint64_t hash = 1469598103934665603ull;
  for (const render::RayRecord& ray : rays) {
    for (uint32_t word : std::bit_cast<std::array<uint32_t, 8>>(ray)) hash = (hash ^ word) * 1099511628211ull;
  }
  return hash;
}

}  // namespace kd::bench
