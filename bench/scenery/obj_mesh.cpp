#include "scenery/obj_mesh.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace kd::bench::scenery {

namespace {

struct StuffRow {
  std::string_view name;
  Vec3f colour;
  float specular = 0;
  float shininess = 1;
};

/// In the order of Stuff.
constexpr StuffRow kStuffRows[] = {
    {"bark", {0.17f, 0.13f, 0.10f}},
    {"pale_bark", {0.62f, 0.60f, 0.55f}},
    {"red_bark", {0.33f, 0.18f, 0.10f}},
    {"beech_dark", {0.09f, 0.21f, 0.035f}},
    {"beech_middle", {0.14f, 0.29f, 0.05f}},
    {"beech_light", {0.21f, 0.36f, 0.07f}},
    {"birch_dark", {0.19f, 0.30f, 0.06f}},
    {"birch_middle", {0.27f, 0.39f, 0.08f}},
    {"birch_light", {0.37f, 0.46f, 0.11f}},
    {"autumn_dark", {0.42f, 0.17f, 0.03f}},
    {"autumn_middle", {0.56f, 0.28f, 0.04f}},
    {"autumn_light", {0.64f, 0.40f, 0.06f}},
    {"spruce_dark", {0.04f, 0.11f, 0.06f}},
    {"spruce_middle", {0.06f, 0.155f, 0.08f}},
    {"spruce_light", {0.10f, 0.22f, 0.10f}},
    {"pine_dark", {0.08f, 0.17f, 0.09f}},
    {"pine_middle", {0.12f, 0.23f, 0.12f}},
    {"pine_light", {0.17f, 0.29f, 0.14f}},
    {"shrub_dark", {0.10f, 0.20f, 0.05f}},
    {"shrub_middle", {0.15f, 0.26f, 0.06f}},
    {"shrub_light", {0.22f, 0.32f, 0.08f}},
    {"grass_dark", {0.16f, 0.30f, 0.05f}},
    {"grass_middle", {0.24f, 0.40f, 0.08f}},
    {"grass_light", {0.38f, 0.46f, 0.15f}},
    {"petals", {0.85f, 0.80f, 0.75f}},
    {"stone", {0.38f, 0.37f, 0.35f}, 0.08f, 20},
    {"soil", {0.20f, 0.15f, 0.09f}},
    {"moss", {0.14f, 0.19f, 0.06f}},
    {"meadow", {0.19f, 0.31f, 0.07f}},
    {"path", {0.52f, 0.43f, 0.30f}},
    {"plaster", {0.66f, 0.56f, 0.40f}},
    {"brick", {0.42f, 0.17f, 0.11f}},
    {"limestone", {0.62f, 0.58f, 0.50f}},
    {"concrete", {0.46f, 0.46f, 0.45f}},
    {"tiles", {0.38f, 0.14f, 0.08f}},
    {"gravel", {0.30f, 0.29f, 0.28f}},
    {"steel", {0.45f, 0.47f, 0.50f}, 0.3f, 40},
    {"iron", {0.06f, 0.06f, 0.07f}, 0.15f, 30},
    {"blind", {0.75f, 0.72f, 0.64f}},
    {"awning", {0.50f, 0.08f, 0.07f}},
    {"asphalt", {0.11f, 0.11f, 0.12f}},
    {"paving", {0.40f, 0.39f, 0.37f}},
    {"paint", {0.80f, 0.80f, 0.78f}},
    {"rubber", {0.03f, 0.03f, 0.03f}},
    {"glass_dark", {0.03f, 0.045f, 0.06f}, 0.9f, 400},
    {"glass_middle", {0.05f, 0.075f, 0.10f}, 0.9f, 400},
    {"glass_light", {0.09f, 0.12f, 0.15f}, 0.9f, 400},
};
static_assert(std::size(kStuffRows) == kStuffs);

}  // namespace

uint32_t ObjMesh::vertex(Vec3d p) {
  vertices_.push_back(p);
  return static_cast<uint32_t>(vertices_.size());
}

uint32_t ObjMesh::normal(Vec3d n) {
  normals_.push_back(normalised(n));
  return static_cast<uint32_t>(normals_.size());
}

void ObjMesh::triangle(Stuff stuff, Corner a, Corner b, Corner c) {
  triangles_[static_cast<size_t>(stuff)].push_back({a, b, c});
}

void ObjMesh::quad(Stuff stuff, Corner a, Corner b, Corner c, Corner d) {
  triangle(stuff, a, b, c);
  triangle(stuff, a, c, d);
}

void ObjMesh::leaf(Stuff stuff, Vec3d base, Vec3d along, Vec3d across, Vec3d n) {
  const uint32_t shared = normal(n);
  const Vec3d widest = base + along * 0.4;
  const Corner foot{vertex(base), shared}, right{vertex(widest + across), shared};
  const Corner tip{vertex(base + along), shared}, left{vertex(widest - across), shared};
  quad(stuff, foot, right, tip, left);
}

uint64_t ObjMesh::triangle_count() const {
  uint64_t count = 0;
  for (const auto& triangles : triangles_) count += triangles.size();
  return count;
}

std::string ObjMesh::text(std::string_view name, std::string_view library) const {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "# written by kdbench\nmtllib {}\no {}\n", library, name);
  for (Vec3d p : vertices_) fmt::format_to(out, "v {:.4f} {:.4f} {:.4f}\n", p.x, p.y, p.z);
  for (Vec3d n : normals_) fmt::format_to(out, "vn {:.3f} {:.3f} {:.3f}\n", n.x, n.y, n.z);
  for (size_t stuff = 0; stuff < kStuffs; ++stuff) {
    if (triangles_[stuff].empty()) continue;
    fmt::format_to(out, "usemtl {}\n", kStuffRows[stuff].name);
    for (const auto& [a, b, c] : triangles_[stuff]) {
      if (a.normal == 0) {
        fmt::format_to(out, "f {} {} {}\n", a.vertex, b.vertex, c.vertex);
      } else {
        fmt::format_to(out, "f {}//{} {}//{} {}//{}\n", a.vertex, a.normal, b.vertex, b.normal, c.vertex, c.normal);
      }
    }
  }
  return fmt::to_string(text);
}

std::string library_text(std::span<const NamedMesh> meshes) {
  std::string text = "# written by kdbench\n";
  for (size_t stuff = 0; stuff < kStuffs; ++stuff) {
    const auto uses = [&](const NamedMesh& m) { return m.mesh.has(static_cast<Stuff>(stuff)); };
    if (std::none_of(meshes.begin(), meshes.end(), uses)) continue;
    const StuffRow& row = kStuffRows[stuff];
    const auto [r, g, b] = row.colour;
    text += fmt::format("\nnewmtl {0}\nKa {1} {2} {3}\nKd {1} {2} {3}\nKs {4} {4} {4}\nNs {5}\n", row.name, r, g, b,
                        row.specular, row.shininess);
  }
  return text;
}

}  // namespace kd::bench::scenery
