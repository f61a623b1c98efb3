// Pictures of a mesh for comparing: the same simple shading for whatever form the mesh is in. Ambient light, and
// diffuse light from the camera's point light where no shadow falls; geometric normals, one albedo. Nothing is smoothed
// or sampled, so that pictures differ only where hits do.
#pragma once

#include <functional>
#include <span>

#include "pareto/picture.h"
#include "pareto/reference_tracer.h"
#include "shared_rays.h"

namespace kd::bench {

/// What the camera sees, one ray a pixel.
struct View {
  SharedCamera camera;
  uint32_t width = 0;
  uint32_t height = 0;
  double diagonal = 0;  // of the mesh's box, model units
  PrimaryRays primary;
};

/// `lit`: for each hit, in their order, whether its shadow ray met nothing.
Picture shade(const View& view, std::span<const render::HitRecord> hits, const CornersOf& corners,
              std::span<const uint8_t> lit);

/// The mesh as the source file has it, seen in double precision.
struct ReferenceRender {
  std::vector<double> t;                // of each primary ray's hit
  std::vector<render::HitRecord> hits;  // the same, primitives as the source numbers them
  SecondaryRays secondary;
  Picture picture;
};

/// `sources`: of each triangle of the tracer its number in the source.
ReferenceRender render_reference(const View& view, const ReferenceTracer& tracer, std::span<const uint32_t> sources);

/// As t is the ray's own.
inline Ray to_ray(const render::RayRecord& r) { return {{r.ox, r.oy, r.oz}, {r.dx, r.dy, r.dz}, r.t_min, r.t_max}; }

}  // namespace kd::bench
