// Shapes that are no solid: needles, sheets, walls, duplicates, and boxes that coincide.
#include "stress/random.h"
#include "stress/shape_parts.h"

namespace kd::stress {

namespace {

enum class Soup { needles, slivers, mixed };

Shape soup(int bits, Soup kind, uint32_t count) {
  Random random(static_cast<uint64_t>(kind) + 1, static_cast<uint64_t>(bits));
  const uint32_t top = lattice_max(bits);
  const auto point = [&] { return Vec3u{random.below(top + 1), random.below(top + 1), random.below(top + 1)}; };
  const auto near = [&](Vec3d p, double size) {
    const Vec3d q = p + random.vector(size);
    return Vec3u{rounded(q.x, top), rounded(q.y, top), rounded(q.z, top)};
  };
  Shape shape;
  while (shape.triangles.size() < count) {
    const Vec3u a = point(), b = point();
    const Vec3d ad = vec_cast<double>(a), bd = vec_cast<double>(b);
    const uint32_t which = kind == Soup::needles ? 0 : kind == Soup::slivers ? 1 : random.below(4);
    const Vec3u c = which == 0   ? near(ad, 2)                                 // two corners next to each other
                    : which == 1 ? near(ad + (bd - ad) * random.unit(), 0.75)  // nearly on a line
                                 : point();
    if (which == 3) {
      const Vec3u d = near(ad, 0.02 * top + 2);
      add_triangle(shape, a, d, near(ad, 0.02 * top + 2));
    } else {
      add_triangle(shape, a, b, c);
    }
  }
  return shape;
}
}  // namespace

Shape needles(int bits) { return soup(bits, Soup::needles, 120); }
Shape slivers(int bits) { return soup(bits, Soup::slivers, 120); }
Shape mixed(int bits) { return soup(bits, Soup::mixed, 160); }

namespace {

/// The rectangle between opposite corners of a flat box, as two triangles.
void add_wall(Shape& shape, Vec3u lo, Vec3u hi) {
  const int flat = lo.x == hi.x ? 0 : lo.y == hi.y ? 1 : 2, along = (flat + 1) % 3;
  Vec3u p = lo, q = hi;
  p.set(along, hi[along]);
  q.set(along, lo[along]);
  add_triangle(shape, lo, p, hi);
  add_triangle(shape, lo, hi, q);
}

void add_box(Shape& shape, Vec3u lo, Vec3u hi) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const Vec3u& end : {lo, hi}) {
      Vec3u a = lo, b = hi;
      a.set(axis, end[axis]);
      b.set(axis, end[axis]);
      add_wall(shape, a, b);
    }
  }
}

}  // namespace

/// The same wall many times over, turned this way and that, and walls that overlap it in its plane; one plane on an
/// axis, one slanted.
Shape duplicates(int bits) {
  Random random(77, static_cast<uint64_t>(bits));
  const uint32_t top = lattice_max(bits), half = top / 2;
  Shape shape;
  for (int copy = 0; copy < 24; ++copy) {
    const uint32_t a = random.below(half), b = random.below(half);
    const bool same = copy % 2 == 0;
    add_wall(shape, {half, same ? 0 : a, same ? 0 : b}, {half, same ? top : a + half, same ? top : b + half});
    const Vec3u p{same ? 0 : a, same ? 0 : a, 0}, q{same ? top : a + half, same ? top : a + half, 0};
    const Vec3u r{p.x, p.y, top}, s{q.x, q.y, top};
    add_triangle(shape, p, copy % 3 == 0 ? r : q, copy % 3 == 0 ? q : r);
    add_triangle(shape, q, copy % 3 == 1 ? r : s, copy % 3 == 1 ? s : r);
  }
  return shape;
}

/// Rooms between walls in lattice planes, some left out, some as thin as a lattice step: cells without thickness.
Shape flat_cells(int bits) {
  constexpr uint32_t kRooms = 4;
  Random random(78, static_cast<uint64_t>(bits));
  const uint32_t top = lattice_max(bits);
  const std::array<uint32_t, kRooms + 1> at{0, top / 3, top / 3 + 1, top / 3 + 2, top};
  Shape shape;
  for (int axis = 0; axis < 3; ++axis) {
    for (uint32_t i = 0; i <= kRooms; ++i) {
      for (uint32_t cell = 0; cell < kRooms * kRooms; ++cell) {
        if (random.chance(0.3)) continue;
        const uint32_t j = cell % kRooms, k = cell / kRooms;
        Vec3u lo, hi;
        lo.set(axis, at[i]);
        hi.set(axis, at[i]);
        lo.set((axis + 1) % 3, at[j]);
        hi.set((axis + 1) % 3, at[j + 1]);
        lo.set((axis + 2) % 3, at[k]);
        hi.set((axis + 2) % 3, at[k + 1]);
        add_wall(shape, lo, hi);
      }
    }
  }
  return shape;
}

/// A mesh without extent along z.
Shape flat_mesh(int bits) {
  const uint32_t top = lattice_max(bits);
  Shape shape;
  for (uint32_t i = 0; i < 12; ++i) {
    for (uint32_t j = 0; j < 12; ++j) {
      const auto at = [&](uint32_t n) { return static_cast<uint32_t>(uint64_t{top} * n / 12); };
      add_wall(shape, {at(i), at(j), 0}, {at(i + 1), at(j + 1), 0});
    }
  }
  shape.flat = true;
  return shape;
}

/// Steps of solid boxes side by side, whose faces coincide where they touch.
Shape stairs(int bits) {
  constexpr uint32_t kSteps = 24;
  const uint32_t top = lattice_max(bits);
  Shape shape;
  const auto at = [&](uint32_t n) { return static_cast<uint32_t>(uint64_t{top} * n / kSteps); };
  for (uint32_t i = 0; i < kSteps; ++i) add_box(shape, {at(i), 0, 0}, {at(i + 1), top / 3, at(i + 1)});
  shape.traits.even = true;
  return shape;
}

/// Pairs of tessellated sheets across z, one lattice step apart.
Shape sheets(int bits) {
  constexpr uint32_t kCells = 6;
  const uint32_t top = lattice_max(bits), middle = top / 2 / 2 * 2;
  Shape shape;
  for (const uint32_t z : {middle, middle + 1}) {
    for (uint32_t i = 0; i < kCells * kCells; ++i) {
      const auto at = [&](uint32_t n) { return static_cast<uint32_t>(uint64_t{top} * n / kCells); };
      const uint32_t x = i % kCells, y = i / kCells;
      add_wall(shape, {at(x), at(y), z}, {at(x + 1), at(y + 1), z});
    }
  }
  add_wall(shape, {0, 0, 0}, {top, top, 0});
  add_wall(shape, {0, 0, top}, {top, top, top});
  shape.traits.sheets = true;
  shape.traits.inside_point = {0.5 * top, 0.5 * top, middle + 0.5};
  return shape;
}

}  // namespace kd::stress
