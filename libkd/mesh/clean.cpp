#include "mesh/clean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "mesh/weld.h"

namespace kd::mesh {
namespace {

double largest_component(Vec3d v) { return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z))); }

/// A vector times the power of two that brings its largest component into [1, 2): the sign and the zeros of a cross
/// product of such vectors are those of the unscaled one, without its overflow and underflow.
Vec3d scaled(Vec3d v) {
  const int exponent = std::ilogb(largest_component(v));
  return {std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent), std::ldexp(v.z, -exponent)};
}

bool is_degenerate(Vec3d a, Vec3d b, Vec3d c) {
  // The common case: far from what overflow or underflow could make or unmake.
  const Vec3d normal = cross(b - a, c - a);
  if (is_finite(normal) && largest_component(normal) > 1e-200) return false;
  if (a == b || b == c || c == a) return true;
  // A difference of two coordinates overflows only where one is beyond half the range; halving those is exact.
  if (std::fmax(largest_component(a), std::fmax(largest_component(b), largest_component(c))) > 0x1p1022) {
    a = a * 0.5;
    b = b * 0.5;
    c = c * 0.5;
    if (a == b || b == c || c == a) return true;
  }
  return cross(scaled(b - a), scaled(c - a)) == Vec3d{0, 0, 0};
}

void count(FaceFault& fault, uint32_t source_primitive) {
  if (fault.count++ == 0) fault.first = source_primitive;
}

/// A triangle's three places in a form that its rotations share: the smallest first. Triangles the other way round
/// share it too and differ in `flipped`.
struct Surface {
  uint32_t a, b, c;
  uint32_t triangle;
  bool flipped;

  auto places() const { return std::tie(a, b, c); }
};

Surface surface_of(uint32_t a, uint32_t b, uint32_t c, uint32_t triangle) {
  while (a > b || a > c) a = std::exchange(b, std::exchange(c, a));
  return {a, std::min(b, c), std::max(b, c), triangle, b > c};
}

/// Marks in `keep` the triangles that repeat an earlier one, and reports them and the opposite ones.
void find_repeated(const Mesh& mesh, std::vector<char>& keep, CleanReport& report) {
  const std::vector<uint32_t> place = weld(mesh.positions);
  std::vector<Surface> surfaces;
  surfaces.reserve(mesh.triangles.size());
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (keep[i]) surfaces.push_back(surface_of(place[t[0]], place[t[1]], place[t[2]], i));
  }
  std::sort(surfaces.begin(), surfaces.end(), [](const Surface& l, const Surface& r) {
    return std::tie(l.a, l.b, l.c, l.triangle) < std::tie(r.a, r.b, r.c, r.triangle);
  });
  std::vector<uint32_t> opposite;
  std::array<bool, 2> seen{};  // of the current places: either way round
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const Surface& s = surfaces[i];
    if (i == 0 || s.places() != surfaces[i - 1].places()) seen = {};
    if (seen[s.flipped]) {
      keep[s.triangle] = 0;
    } else if (seen[!s.flipped]) {
      opposite.push_back(s.triangle);
    }
    seen[s.flipped] = true;
  }
  std::sort(opposite.begin(), opposite.end());
  for (const uint32_t i : opposite) count(report.opposite, mesh.source_primitives[i]);
}

template <class T>
void keep_marked(std::vector<T>& values, const std::vector<char>& keep) {
  if (values.empty()) return;
  size_t kept = 0;
  for (size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) values[kept++] = values[i];
  }
  values.resize(kept);
}

}  // namespace

CleanReport clean(Mesh& mesh) {
  CleanReport report;
  std::vector<char> keep(mesh.triangles.size(), 1);
  for (size_t i = 0; i < keep.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Vec3d a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    const bool finite = is_finite(a) && is_finite(b) && is_finite(c);
    if (finite && !is_degenerate(a, b, c)) continue;
    keep[i] = 0;
    count(finite ? report.degenerate : report.non_finite, mesh.source_primitives[i]);
  }
  const std::vector<char> sound = keep;
  find_repeated(mesh, keep, report);
  for (size_t i = 0; i < keep.size(); ++i) {
    if (sound[i] && !keep[i]) count(report.duplicate, mesh.source_primitives[i]);
  }
  keep_marked(mesh.triangles, keep);
  keep_marked(mesh.source_primitives, keep);
  keep_marked(mesh.normal_indices, keep);
  keep_marked(mesh.material_ids, keep);
  keep_marked(mesh.group_ids, keep);
  return report;
}

}  // namespace kd::mesh
