// A mesh in the making, in metres with y up, and the OBJ file that it becomes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"

namespace kd::bench::scenery {

/// What things are made of. Leaves and glass come in three shades, side by side.
enum class Stuff : uint8_t {
  bark,
  pale_bark,
  red_bark,
  beech,
  birch = beech + 3,
  autumn = birch + 3,
  spruce = autumn + 3,
  pine = spruce + 3,
  shrub = pine + 3,
  grass = shrub + 3,
  petals = grass + 3,
  stone,
  soil,
  moss,
  meadow,
  path,
  plaster,
  brick,
  limestone,
  concrete,
  tiles,
  gravel,
  steel,
  iron,
  blind,
  awning,
  asphalt,
  paving,
  paint,
  rubber,
  glass,
};
constexpr int kShades = 3;
constexpr size_t kStuffs = static_cast<size_t>(Stuff::glass) + kShades;

struct Corner {
  uint32_t vertex = 0;  // both from 1, as in the file
  uint32_t normal = 0;  // 0: none
};

class ObjMesh {
 public:
  uint32_t vertex(Vec3d p);
  /// `n` of any length but zero.
  uint32_t normal(Vec3d n);
  void triangle(Stuff stuff, Corner a, Corner b, Corner c);
  /// Two triangles; corners in turn.
  void quad(Stuff stuff, Corner a, Corner b, Corner c, Corner d);
  /// A flat leaf of four corners, its widest at two fifths of its length; `across` has half its width.
  void leaf(Stuff stuff, Vec3d base, Vec3d along, Vec3d across, Vec3d n);

  uint64_t triangle_count() const;
  bool has(Stuff stuff) const { return !triangles_[static_cast<size_t>(stuff)].empty(); }
  /// Coordinates have four decimals. `library`: the name of the file of its materials.
  std::string text(std::string_view name, std::string_view library) const;

 private:
  std::vector<Vec3d> vertices_;
  std::vector<Vec3d> normals_;
  std::array<std::vector<std::array<Corner, 3>>, kStuffs> triangles_;
};

struct NamedMesh {
  std::string name;
  ObjMesh mesh;
};

/// The material library of what meshes are made of.
std::string library_text(std::span<const NamedMesh> meshes);

}  // namespace kd::bench::scenery
