// What the stages see of a scene and of the frame they work on: plain pointers, on the host or on a device.
#pragma once

#include <cstdint>

#include "core/frame.h"
#include "core/hierarchy.h"
#include "core/material.h"
#include "core/object_view.h"

namespace kd::render {

constexpr uint32_t kNone = 0xffffffffu;

/// An object and what shading reads of it. A null section is one that the object lacks or no stage asked for.
struct ShadedObjectView {
  ObjectView tree;
  Vec3d step;                                   // the lattice's, model units
  const uint32_t* source_primitives = nullptr;  // null: triangle i is primitive i of the source
  const Vec3f* normals = nullptr;
  const uint32_t* normal_indices = nullptr;
  const Material* materials = nullptr;
  const uint16_t* material_ids = nullptr;
};

struct InstanceView {
  InverseFrame to_lattice;
  Frame to_scene;
  uint32_t object = 0;
  uint32_t material = kNone;  // index into SceneView::overrides: instead of the object's own materials
};

struct LightView {
  Vec3d vector;                  // scene space: where a point or spot light is; the way to a directional one, length 1
  Vec3d axis{0, 0, 0};           // the way a spot light shines, length 1; zero of others
  double cos_outer = -1;         // of a spot light: nothing arrives where the cosine to the axis is less
  double inverse_width = 1e300;  // 1 / (cos inner - cos outer)
  double inverse_reach = 0;      // 0: no end
  Vec3f colour;
  bool is_point = true;  // or spot
  bool inverse_square = false;
  bool is_even = true;  // all of it arrives everywhere
};

struct SceneView {
  const HierarchyNode* hierarchy = nullptr;
  const InstanceView* instances = nullptr;
  const ShadedObjectView* objects = nullptr;
  const Material* overrides = nullptr;
  const LightView* lights = nullptr;
  const uint8_t* front_only = nullptr;         // 1 for instances whose backs no camera ray meets; null: for none
  const uint32_t* instance_numbers = nullptr;  // in the scene; null: the same as here
  const uint32_t* object_numbers = nullptr;    // in the scene
  uint32_t instance_count = 0;
  TriangleLayout layout = TriangleLayout::expanded;  // of all objects
  Vec3f ambient;
  Vec3f background;
};

/// The direction through the centre of pixel (x, y), not normalised: corner + x * right + y * down.
struct CameraView {
  Vec3d position;
  Vec3d corner;
  Vec3d right;
  Vec3d down;
};

/// The nearest hit of a pixel's ray.
struct SurfaceHit {
  double t = 0;  // along the ray; its direction has length 1
  double u = 0;  // weights of the triangle's second and third vertex
  double v = 0;
  uint32_t instance = kNone;  // kNone: the ray met nothing
  uint32_t triangle = kNone;  // in the object
};

/// A pixel of the film: red, green, blue and coverage.
struct alignas(16) Pixel {
  Vec3f colour;
  float alpha;
};

/// The buffers of a strip of a frame, one element a pixel in row order. Those that no stage uses are null.
struct FrameView {
  SceneView scene;
  CameraView camera;
  uint32_t width = 0;  // of the strip, and so is the height
  uint32_t height = 0;
  uint32_t first_column = 0;  // where in the film the strip's first pixel lies
  uint32_t first_row = 0;
  uint32_t samples = 1;  // a pixel; one lies at its centre
  uint32_t sample = 0;   // the one that the stages are at
  SurfaceHit* hits = nullptr;
  Pixel* colour = nullptr;
  uint8_t* preview = nullptr;  // RGB
  double inverse_gamma = 1;
};

}  // namespace kd::render
