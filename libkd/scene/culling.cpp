#include "scene/culling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "scene/camera_axes.h"
#include "sys/parallel.h"

namespace kd::scene {

namespace {

constexpr size_t kGrain = 4096;  // instances
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Box3d kEverywhere{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};

/// Of coordinates: far more than the rounding of all that is computed from them, here and along a ray.
constexpr double kSlack = 1e-11;

/// So much beyond a part's edges, in pixels, do samples of its pixels not reach: at most half of it.
constexpr double kPixelMargin = 1;

/// Degrees beyond a cone in which rounding might still find light.
constexpr double kConeMargin = 1e-3;

Vec3d magnitude(Vec3d v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }

/// Of the coordinates of a box, by axis.
Vec3d largest_coordinates(const Box3d& box) {
  const Vec3d a = magnitude(box.lo), b = magnitude(box.hi);
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

Box3d grown(const Box3d& box, Vec3d by) { return {box.lo - by, box.hi + by}; }
Box3d slackened(const Box3d& box) { return grown(box, largest_coordinates(box) * kSlack); }

Box3d intersection(const Box3d& a, const Box3d& b) {
  return {{std::max(a.lo.x, b.lo.x), std::max(a.lo.y, b.lo.y), std::max(a.lo.z, b.lo.z)},
          {std::min(a.hi.x, b.hi.x), std::min(a.hi.y, b.hi.y), std::min(a.hi.z, b.hi.z)}};
}

/// How far a box reaches along a direction, from a point. Not a number where coordinates overflow: then a comparison
/// with it must leave nothing out.
double reach_along(const Box3d& box, Vec3d direction, Vec3d from) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    sum += direction[axis] * ((direction[axis] > 0 ? box.hi[axis] : box.lo[axis]) - from[axis]);
  }
  return sum;
}

/// All rays of the camera through a part of the film.
class Pyramid {
 public:
  explicit Pyramid(const View& view) : apex_(view.camera.position) {
    const CameraAxes axes = camera_axes(view.camera);
    const double pixel = 2 * axes.half_height / view.film.height;
    const auto at = [&](double position, uint32_t size) { return pixel * (position - 0.5 * size); };
    const FilmPart& p = view.part;
    const double left = at(p.column - kPixelMargin, view.film.width), top = at(p.row - kPixelMargin, view.film.height);
    const double right = at(static_cast<double>(p.column) + p.width + kPixelMargin, view.film.width);
    const double bottom = at(static_cast<double>(p.row) + p.height + kPixelMargin, view.film.height);
    const Vec3d down = -axes.up;
    forward_ = axes.forward;
    inward_ = {forward_, axes.right - forward_ * left, forward_ * right - axes.right, down - forward_ * top,
               forward_ * bottom - down};
    corners_ = {forward_ + axes.right * left + down * top, forward_ + axes.right * right + down * top,
                forward_ + axes.right * left + down * bottom, forward_ + axes.right * right + down * bottom};
  }

  bool may_meet(const Box3d& box) const {
    const Vec3d size = largest_coordinates(box) + magnitude(apex_);
    return std::none_of(inward_.begin(), inward_.end(), [&](Vec3d inward) {
      return reach_along(box, inward, apex_) < -kSlack * dot(magnitude(inward), size);
    });
  }
  double depth_of(const Box3d& box) const {
    const double depth = reach_along(box, forward_, apex_);
    return std::isfinite(depth) ? depth : kInfinity;
  }
  /// Of the pyramid down to a depth.
  Box3d bounds(double depth) const {
    if (!std::isfinite(depth)) return kEverywhere;
    Box3d box{apex_, apex_};
    for (const Vec3d corner : corners_) box.extend(apex_ + corner * depth);
    return slackened(box);
  }

 private:
  Vec3d apex_;
  Vec3d forward_;
  std::array<Vec3d, 5> inward_;   // normals of its sides, and of the plane behind which nothing is seen
  std::array<Vec3d, 4> corners_;  // directions of its edges
};

/// What the camera may see.
struct Seen {
  Box3d box;
  Vec3d margin{0, 0, 0};  // how far off an instance's surface its shadow rays may start
  double depth = 0;       // of the farthest, before the camera

  void add(const Instance& instance, const Lattice& lattice, double its_depth) {
    const Frame& f = instance.lattice_to_scene;
    const double steps = std::ldexp(1.0, lattice.bits - 22);  // two of 2^-24 for the lift, two for snapping
    const Vec3d own = (magnitude(f.x_axis) + magnitude(f.y_axis) + magnitude(f.z_axis)) * steps;
    box.extend(grown(instance.box_scene, own));
    margin = {std::max(margin.x, own.x), std::max(margin.y, own.y), std::max(margin.z, own.z)};
    depth = std::max(depth, its_depth);
  }
  void add(const Seen& other) {
    box.extend(other.box);
    margin = {std::max(margin.x, other.margin.x), std::max(margin.y, other.margin.y),
              std::max(margin.z, other.margin.z)};
    depth = std::max(depth, other.depth);
  }
};

/// Marks what the camera's rays may meet.
Seen mark_seen(const Pyramid& pyramid, std::span<const Lattice> lattices, std::span<const Instance> instances,
               std::span<uint8_t> met) {
  PerThread<Seen> seen;
  parallel_ranges(instances.size(), kGrain, [&](size_t begin, size_t end) {
    Seen& own = seen.local();
    for (size_t i = begin; i < end; ++i) {
      const Instance& instance = instances[i];
      if (!pyramid.may_meet(instance.box_scene)) continue;
      met[i] = 1;
      own.add(instance, lattices[instance.object], pyramid.depth_of(instance.box_scene));
    }
  });
  Seen all;
  for (const Seen& one : seen) all.add(one);
  return all;
}

/// Where a spot light shines, as far as `box`; it is of less than 90 degrees to each side.
Box3d cone_bounds(const Light& light, double outer_degrees, const Box3d& box) {
  const double reach = reach_along(box, light.direction, light.position), height = reach < 0 ? 0 : reach;
  const double radius = height * std::tan(outer_degrees * std::numbers::pi / 180);
  if (!std::isfinite(radius)) return kEverywhere;
  const auto across = [&](double along) { return radius * std::sqrt(std::max(0.0, 1 - along * along)); };
  const Vec3d a = light.direction, end = light.position + a * height;
  Box3d bounds = grown({end, end}, {across(a.x), across(a.y), across(a.z)});
  bounds.extend(light.position);
  return slackened(bounds);
}

/// Of `seen`, what gets some of the light.
Box3d lit_part(const Light& light, Box3d seen) {
  if (light.kind == LightKind::directional) return seen;
  if (std::isfinite(light.reach)) {
    const Box3d around = grown({light.position, light.position}, {light.reach, light.reach, light.reach});
    seen = intersection(seen, slackened(around));
  }
  const double outer = light.outer_degrees + kConeMargin;
  if (light.kind == LightKind::spot && outer < 89) seen = intersection(seen, cone_bounds(light, outer, seen));
  return seen;
}

/// All rays from a box to a light: a box that shrinks to a point, or moves away for ever. At t from 0 to `end` its
/// bounds are lo + t lo_way and hi + t hi_way.
struct Sweep {
  Box3d start;
  Vec3d lo_way, hi_way;
  double end = 1;

  bool may_meet(const Box3d& box) const {
    double first = 0, last = end;
    // Keeps of [first, last] what has a + t b <= 0. What is not a number changes nothing.
    const auto keep = [&](double a, double b) {
      if (b > 0) {
        last = std::min(last, -a / b);
      } else if (b < 0) {
        first = std::max(first, -a / b);
      } else if (a > 0) {
        last = -1;
      }
    };
    for (int axis = 0; axis < 3; ++axis) {
      keep(start.lo[axis] - box.hi[axis], lo_way[axis]);
      keep(box.lo[axis] - start.hi[axis], -hi_way[axis]);
    }
    return !(first > last);
  }
};

std::optional<Sweep> shadow_rays(const Light& light, const Box3d& seen) {
  if (is_black(light.colour)) return std::nullopt;
  const Box3d lit = lit_part(light, seen);
  if (lit.empty()) return std::nullopt;
  if (light.kind == LightKind::directional) return Sweep{lit, -light.direction, -light.direction, kInfinity};
  return Sweep{lit, light.position - lit.lo, light.position - lit.hi, 1};
}

}  // namespace

void mark_met(const View& view, std::span<const Lattice> lattices, std::span<const Instance> instances,
              std::span<uint8_t> met) {
  const Pyramid pyramid(view);
  const Seen seen = mark_seen(pyramid, lattices, instances, met);
  if (seen.box.empty()) return;
  const Box3d box = slackened(intersection(seen.box, grown(pyramid.bounds(seen.depth), seen.margin)));
  std::vector<Sweep> sweeps;
  for (const Light& light : view.lights) {
    if (const auto rays = shadow_rays(light, box)) sweeps.push_back(*rays);
  }
  if (sweeps.empty()) return;
  parallel_ranges(instances.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (met[i]) continue;
      const Box3d own = slackened(instances[i].box_scene);
      met[i] = std::any_of(sweeps.begin(), sweeps.end(), [&](const Sweep& rays) { return rays.may_meet(own); });
    }
  });
}

}  // namespace kd::scene
