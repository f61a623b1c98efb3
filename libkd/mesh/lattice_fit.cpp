#include "mesh/lattice_fit.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mesh/weld.h"
#include "sys/parallel.h"

namespace kd::mesh {

namespace {

using Quadric = LatticeFit::Quadric;
using Plane = LatticeFit::Plane;

/// What moving along faces costs, of what moving out of them does: enough to keep a vertex where faces gain nothing.
constexpr double kAlongFaces = 0x1p-7;

/// For the search of a lattice: planes that count, those of them that are put onto a lattice plane in turn, and by
/// which share of a step the box grows from one attempt to the next.
constexpr size_t kMostPlanes = 64, kMostAnchors = 4;
/// Shares of the box: what lies across an axis, but for the rounding of its source, and what is one plane.
constexpr double kFlat = 0x1p-21, kOnePlane = 0x1p-23;
constexpr int kAttemptsPerStep = 16;
/// What another box than the tight one has to gain, in squared distance.
constexpr double kWorthGrowing = 0.5;

constexpr size_t kVertexGrain = 4096;

double longest_edge(const Box3d& box) {
  const Vec3d e = box.extent();
  const double longest = std::max({e.x, e.y, e.z});
  return longest > 0 ? longest : 1;
}

/// Twice a triangle's area along its normal, lengths in units of `longest`.
Vec3d area_vector(const Mesh& mesh, const std::array<uint32_t, 3>& t, double longest) {
  const Vec3d a = mesh.positions[t[0]];
  const auto edge = [&](uint32_t v) {
    const Vec3d e = mesh.positions[v] - a;
    return Vec3d{e.x / longest, e.y / longest, e.z / longest};
  };
  return cross(edge(t[1]), edge(t[2]));
}

void add_plane(Quadric& q, Vec3d n, double weight) {
  q.xx += weight * n.x * n.x;
  q.yy += weight * n.y * n.y;
  q.zz += weight * n.z * n.z;
  q.xy += weight * n.x * n.y;
  q.yz += weight * n.y * n.z;
  q.zx += weight * n.z * n.x;
}

/// As bits, the axes that an edge lies across: those along which it is no longer than `flat`.
uint8_t axes_across(Vec3d edge, Vec3d flat) {
  const auto bit = [](double e, double most, int axis) { return (std::fabs(e) <= most ? 1 : 0) << axis; };
  return static_cast<uint8_t>(bit(edge.x, flat.x, 0) | bit(edge.y, flat.y, 1) | bit(edge.z, flat.z, 2));
}

/// Of moving a vertex by d, in any unit of length.
double cost(const Quadric& q, Vec3d d) {
  const double out_of_faces = q.xx * d.x * d.x + q.yy * d.y * d.y + q.zz * d.z * d.z +
                              2 * (q.xy * d.x * d.y + q.yz * d.y * d.z + q.zx * d.z * d.x);
  return out_of_faces + kAlongFaces * (q.xx + q.yy + q.zz) * dot(d, d);
}

/// One axis of a box, model space.
struct Range {
  double origin, extent;
};

/// `tight`, or a little more of which lattice planes 0 to `top` lie nearer to the planes.
Range fitted(Range tight, std::span<const Plane> planes, double top) {
  const auto squared_distances = [&](double steps, double shift) {
    double sum = 0;
    for (const Plane& plane : planes) {
      const double at = plane.position * steps + shift, off = at - std::nearbyint(at);
      sum += plane.area * off * off;
    }
    return sum;
  };
  Range best = tight;
  double least = kWorthGrowing * squared_distances(top, 0);
  for (int attempt = 1; attempt <= kMostGrowth * kAttemptsPerStep; ++attempt) {
    const double growth = static_cast<double>(attempt) / kAttemptsPerStep, steps = top - growth;
    for (const Plane& anchor : planes.first(std::min(planes.size(), kMostAnchors))) {
      const double at = anchor.position * steps, shift = std::ceil(at) - at;
      if (shift > growth) continue;
      const double sum = squared_distances(steps, shift), step = tight.extent / steps;
      if (!(sum < least)) continue;
      least = sum;
      best = {tight.origin - shift * step, step * top};
    }
  }
  return best;
}

/// Places vertices on one lattice.
class Placer {
 public:
  Placer(const Lattice& lattice, double reach)
      : lattice_(lattice),
        reach_(reach),
        proportions_(lattice.proportions()),
        top_(vec_cast<double>(lattice.cube().hi)) {}

  /// `held`: axes, as bits, along which it goes to the nearest plane.
  Vec3u place(const Quadric& q, unsigned held, Vec3d p_model) const {
    if (!is_finite(p_model)) return {0, 0, 0};
    const Vec3d p = lattice_.to_lattice_space(p_model);
    Vec3d best{std::nearbyint(p.x), std::nearbyint(p.y), std::nearbyint(p.z)};
    const Vec3d low{held & 1 ? best.x : std::floor(p.x), held & 2 ? best.y : std::floor(p.y),
                    held & 4 ? best.z : std::floor(p.z)};
    double least = cost(q, (best - p) * proportions_);
    for (unsigned corner = 0; corner < 8; ++corner) {
      if (corner & held) continue;
      const Vec3d c = low + Vec3d{corner & 1 ? 1.0 : 0.0, corner & 2 ? 1.0 : 0.0, corner & 4 ? 1.0 : 0.0};
      if (c.x > top_.x || c.y > top_.y || c.z > top_.z) continue;
      const double here = cost(q, (c - p) * proportions_);
      if (!(here < least) || !reaches(c, p_model)) continue;
      least = here;
      best = c;
    }
    return vec_cast<uint32_t>(best);
  }

 private:
  bool reaches(Vec3d p_lattice, Vec3d p_model) const {
    return reach_ == std::numeric_limits<double>::infinity() ||
           length(lattice_.to_model_space(p_lattice) - p_model) <= reach_;
  }

  Lattice lattice_;
  double reach_;
  Vec3d proportions_, top_;
};

}  // namespace

Box3d bounds(const Mesh& mesh) {
  Box3d box_model;
  for (const auto& triangle : mesh.triangles) {
    for (uint32_t v : triangle) box_model.extend(mesh.positions[v]);
  }
  return box_model;
}

double rounding_displacement(const Mesh& mesh, const Lattice& lattice, double enough) {
  double largest = 0;
  for (const auto& triangle : mesh.triangles) {
    for (uint32_t v : triangle) {
      const Vec3d p_model = mesh.positions[v];
      largest = std::fmax(largest, length(lattice.to_model(lattice.to_lattice(p_model)) - p_model));
    }
    if (largest > enough) break;
  }
  return largest;
}

LatticeFit::LatticeFit(std::span<const Mesh* const> meshes) : meshes_(meshes.begin(), meshes.end()) {
  std::vector<Vec3d> positions;
  for (const Mesh* mesh : meshes_) {
    box_.extend(bounds(*mesh));
    first_vertex_.push_back(positions.size());
    positions.insert(positions.end(), mesh->positions.begin(), mesh->positions.end());
  }
  first_equal_ = weld(positions);
  quadrics_.resize(positions.size());
  held_.resize(positions.size());
  for (size_t m = 0; m < meshes_.size(); ++m) {
    for (const auto& triangle : meshes_[m]->triangles) add_triangle(*meshes_[m], first_vertex_[m], triangle);
  }
  for (int axis = 0; axis < 3; ++axis) planes_[static_cast<size_t>(axis)] = largest_planes(axis);
}

void LatticeFit::add_triangle(const Mesh& mesh, size_t first_vertex, const std::array<uint32_t, 3>& t) {
  const Vec3d n = area_vector(mesh, t, longest_edge(box_)), flat = box_.extent() * kOnePlane;
  const double area = length(n);
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t v = t[k], w = t[k < 2 ? k + 1 : 0];
    const size_t first = first_equal_[first_vertex + v];
    if (area > 1e-150) add_plane(quadrics_[first], n, 1 / area);  // the square of less would vanish
    const uint8_t across = axes_across(mesh.positions[v] - mesh.positions[w], flat);
    held_[first] |= across;
    held_[first_equal_[first_vertex + w]] |= across;
  }
}

std::vector<Plane> LatticeFit::largest_planes(int axis) const {
  const double longest = longest_edge(box_), lo = box_.lo[axis], extent = box_.extent()[axis];
  std::unordered_map<int64_t, Plane> by_place;
  for (const Mesh* mesh : meshes_) {
    for (const auto& t : mesh->triangles) {
      const double a = mesh->positions[t[0]][axis], b = mesh->positions[t[1]][axis], c = mesh->positions[t[2]][axis];
      if (!(std::max({a, b, c}) - std::min({a, b, c}) <= kFlat * extent)) continue;
      const double area = length(area_vector(*mesh, t, longest)), at = ((a - lo) + (b - lo) + (c - lo)) / (3 * extent);
      if (!(area > 0) || !std::isfinite(at)) continue;
      Plane& plane = by_place[std::llround(at / kOnePlane)];
      plane.area += area;
      plane.position += (at - plane.position) * (area / plane.area);
    }
  }
  std::vector<Plane> planes;
  for (const auto& [place, plane] : by_place) planes.push_back(plane);
  std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) {
    return a.area != b.area ? a.area > b.area : a.position < b.position;
  });
  planes.resize(std::min(planes.size(), kMostPlanes));
  return planes;
}

Lattice LatticeFit::lattice(int bits) const {
  const Vec3d lo = box_.lo, extent = box_.extent();
  if (bits < kFewestUsefulBits) return {lo, extent, bits};
  const auto one = [&](size_t axis) {
    const int a = static_cast<int>(axis);
    return fitted({lo[a], extent[a]}, planes_[axis], lattice_max(bits));
  };
  const Range x = one(0), y = one(1), z = one(2);
  return {{x.origin, y.origin, z.origin}, {x.extent, y.extent, z.extent}, bits};
}

std::vector<Vec3u> LatticeFit::place(size_t mesh, const Lattice& lattice, double reach) const {
  const std::vector<Vec3d>& positions = meshes_[mesh]->positions;
  const size_t first = first_vertex_[mesh];
  const Placer placer(lattice, reach);
  std::vector<Vec3u> points(positions.size());
  parallel_ranges(points.size(), kVertexGrain, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const size_t equal = first_equal_[first + v];
      points[v] = placer.place(quadrics_[equal], held_[equal], positions[v]);
    }
  });
  return points;
}

std::optional<int> LatticeFit::fewest_bits(double allowed) const {
  for (int bits = kFewestUsefulBits; bits <= kMaxLatticeBits; ++bits) {
    const Lattice on = lattice(bits);
    const auto keeps = [&](const Mesh* mesh) { return rounding_displacement(*mesh, on, allowed) <= allowed; };
    if (std::all_of(meshes_.begin(), meshes_.end(), keeps)) return bits;
  }
  return std::nullopt;
}

}  // namespace kd::mesh
