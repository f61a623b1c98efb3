#include "stress/stress_case.h"

#include <algorithm>
#include <numeric>

#include "mesh/clean.h"
#include "mesh/normalise.h"
#include "mesh/read_mesh.h"
#include "mesh/topology.h"
#include "stress/rays.h"

namespace kd::stress {

namespace {

/// Bits of a coordinate's upper 10, two places apart: for a Morton code.
uint32_t spread(uint32_t coordinate, int bits) {
  uint32_t v = bits > 10 ? coordinate >> (bits - 10) : coordinate, out = 0;
  for (int i = 0; i < 10; ++i) out |= (v >> i & 1) << (3 * i);
  return out;
}

uint32_t morton(const std::array<Vec3u, 3>& t, int bits) {
  const auto middle = [&](int axis) { return (t[0][axis] + t[1][axis] + t[2][axis]) / 3; };
  return spread(middle(0), bits) | spread(middle(1), bits) << 1 | spread(middle(2), bits) << 2;
}

OracleBox around(const OracleBox& a, const OracleBox& b) {
  const auto lo = [&](int axis) { return std::min(a.lo[axis], b.lo[axis]); };
  const auto hi = [&](int axis) { return std::max(a.hi[axis], b.hi[axis]); };
  return {{lo(0), lo(1), lo(2)}, {hi(0), hi(1), hi(2)}};
}

/// A level of boxes, and above it levels of boxes around every kOracleFan, until few are left.
void append_levels(OracleView& oracle, std::vector<OracleBox>& boxes, std::vector<OracleBox> level) {
  while (true) {
    oracle.first[oracle.levels] = static_cast<uint32_t>(boxes.size());
    oracle.count[oracle.levels] = static_cast<uint32_t>(level.size());
    ++oracle.levels;
    boxes.insert(boxes.end(), level.begin(), level.end());
    if (level.size() <= kOracleFan) return;
    std::vector<OracleBox> above;
    for (size_t i = 0; i < level.size(); ++i) {
      if (i % kOracleFan == 0) {
        above.push_back(level[i]);
      } else {
        above.back() = around(above.back(), level[i]);
      }
    }
    level = std::move(above);
  }
}

/// The triangles in integers, neighbours together, under their boxes.
void build_oracle(StressCase& c) {
  const auto count = static_cast<uint32_t>(c.triangles.size());
  const auto corners = [&](uint32_t i) {
    const auto& t = c.triangles[i];
    return std::array{c.vertices[t[0]], c.vertices[t[1]], c.vertices[t[2]]};
  };
  std::vector<uint32_t> codes(count), order(count);
  for (uint32_t i = 0; i < count; ++i) codes[i] = morton(corners(i), c.lattice.bits);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return codes[a] < codes[b]; });

  std::vector<OracleBox> parts;
  c.places.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    const auto [p, q, r] = corners(order[i]);
    c.places[order[i]] = i;
    c.oracle_triangles.push_back({p, q, r, order[i]});
    parts.push_back(around(around({p, p}, {q, q}), {r, r}));
  }
  c.oracle.triangle_count = count;
  append_levels(c.oracle, c.boxes, std::move(parts));
}

/// What the rows of `placements` do to the mesh, in its own sizes.
Frame scene_frame(uint32_t row, Vec3d size) {
  const double s = std::max({size.x, size.y, size.z});
  const Frame turned{{0, 0, 0}, {0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
  const Frame even{{0, 0, 0}, {1 / s, 0, 0}, {0, 1 / s, 0}, {0, 0, 1 / s}};
  const auto scaled = [&](double x, double y, double z) {
    return compose(turned, compose({{0, 0, 0}, {x, 0, 0}, {0, y, 0}, {0, 0, z}}, even));
  };
  Frame f;
  switch (row) {
    case 0:  // a million sizes away
      f = scaled(1, 1, 1);
      f.point = {1e6, -0.7e6, 0.3e6};
      return f;
    case 1:
      return scaled(1e12, 1e12, 1e12);
    case 2:
      return scaled(1e-12, 1e-12, 1e-12);
    case 3:  // mirrored
      return scaled(-1, 1, 1);
    case 4:  // sheared
      return compose({{0.1, 0.2, 0.3}, {1, 0, 0}, {0.9, 0.4, 0}, {-0.7, 0.5, 0.2}}, scaled(1, 1, 1));
    case 5:  // axis ratios of a million
      return scaled(1, 1e3, 1e6);
    default:  // mirrored, tiny and away
      f = scaled(-1e-9, 1e-9, 3e-9);
      f.point = {1e-4, -2e-4, 3e-4};
      return f;
  }
}

void place(StressCase& c) {
  const Frame model = c.lattice.frame();
  const auto add = [&](const Frame& frame) { c.placements.push_back({invert(frame), frame, 0, render::kNone}); };
  add(model);
  for (uint32_t row = 0; row < kSceneFrames; ++row) {
    Frame centred = model;
    centred.point = c.lattice.extent * -0.5;
    add(compose(scene_frame(row, c.lattice.extent), centred));
  }
}

/// What makes the builder split as long as anything is won, whatever it costs in bytes.
build::BuildSettings deep_tree() {
  build::BuildSettings settings;
  settings.costs.traversal = 0.02;
  settings.costs.byte_price = 0;
  return settings;
}

Result<StressCase> finish(StressCase c, const build::BuildSettings& settings) {
  auto tree = build::build_tree(c.lattice, c.vertices, c.triangles, settings);
  if (!tree) return tree.error();
  c.tree = std::move(*tree);
  for (const auto& t : c.triangles) {
    c.expanded.push_back({vec_cast<float>(c.vertices[t[0]]), 0, vec_cast<float>(c.vertices[t[1]]), 0,
                          vec_cast<float>(c.vertices[t[2]]), 0});
  }
  build_oracle(c);
  place(c);
  return c;
}

/// Cleaned and normalised, as kdbuild does.
Result<StressCase> from_mesh(mesh::Mesh mesh, const std::string& name, int bits) {
  mesh::clean(mesh);
  const Error empty{ErrorClass::mesh, name, "no triangle with an area is left to aim rays at"};
  if (mesh.triangles.empty()) return empty;
  mesh::LatticeMesh m = mesh::normalise(mesh, bits);
  if (m.triangles.empty()) return empty;
  StressCase c;
  c.mesh = name;
  c.lattice = m.lattice;
  c.vertices = std::move(m.vertices);
  c.triangles = std::move(m.triangles);
  // What welding and collapsing do to a closed mesh leaves every line's crossings even.
  c.traits.even = mesh::topology(mesh).closed;
  return c;
}

}  // namespace

CaseView StressCase::host_view() const {
  CaseView view;
  view.object = {tree.nodes.data(), tree.references.data(), expanded.data(), lattice.bits};
  view.oracle = oracle;
  view.oracle.triangles = oracle_triangles.data();
  view.oracle.place = places.data();
  view.oracle.boxes = boxes.data();
  view.vertices = vertices.data();
  view.vertex_count = static_cast<uint32_t>(vertices.size());
  view.node_count = static_cast<uint32_t>(tree.nodes.size());
  view.traits = traits;
  view.placements = placements.data();
  return view;
}

HostCase::HostCase(const StressCase& stress_case) : view_(stress_case.host_view()) {
  shaded_.tree = view_.object;
  shaded_.step = stress_case.lattice.step();
  view_.shaded = &shaded_;
}

Result<StressCase> make_case(const ShapeRow& row, int bits) {
  Shape shape = row.make(bits);
  StressCase c;
  c.mesh = row.name;
  const double top = lattice_max(bits);
  c.lattice = {{0, 0, 0}, {top, top, shape.flat ? 0 : top}, bits};
  c.traits = shape.traits;
  c.weight = row.weight;
  c.vertices = std::move(shape.vertices);
  c.triangles = std::move(shape.triangles);
  return finish(std::move(c), row.deep ? deep_tree() : build::BuildSettings{});
}

Result<StressCase> make_case(const std::string& mesh_path, int bits) {
  auto mesh = mesh::read_mesh(mesh_path, {});
  if (!mesh) return mesh.error();
  auto c = from_mesh(std::move(*mesh), mesh_path, bits);
  if (!c) return c.error();
  return finish(std::move(*c), {});
}

Result<StressCase> make_offset_ball(int bits) {
  auto c = from_mesh(offset_ball(), "offset-ball", bits);
  if (!c) return c.error();
  const double middle = 0.5 * lattice_max(bits), size = 0.4 * middle;
  c->traits.inside = true;
  c->traits.inside_point = {middle, middle, middle};
  c->traits.inside_size = {size, size, size};
  return finish(std::move(*c), {});
}

}  // namespace kd::stress
