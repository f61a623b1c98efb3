// A renderer: a scene on one device, from which frames are taken strip by strip.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/film.h"
#include "render/load.h"
#include "sys/progress.h"
#include "sys/result.h"

namespace kd::render {

struct StageTime {
  std::string stage;
  double seconds = 0;
  uint32_t launches = 0;
};

/// What strips cost; of several, added up.
struct RenderStats {
  double render_seconds = 0;    // stages, first launch to last
  double download_seconds = 0;  // the film's way back
  std::vector<StageTime> stages;
  uint64_t primary_rays = 0;
  uint64_t primary_hits = 0;
  uint64_t shadow_rays = 0;

  void add_stage(std::string_view stage, double seconds, uint32_t launches = 1);
  RenderStats& operator+=(const RenderStats& other);
};

/// What opening took, and what is held.
struct Holding {
  double upload_seconds = 0;  // objects to the device, in their layout
  TriangleLayout layout = TriangleLayout::expanded;
  uint64_t object_bytes = 0;  // nodes, references, triangles, attributes
  uint64_t scene_bytes = 0;   // instances, their hierarchy, lights
  uint64_t strip_bytes = 0;   // hits, film, preview, AOVs
  uint64_t device_bytes = 0;  // that the device has; 0: not known
};

struct Frame {
  image::Film film;
  std::vector<uint8_t> preview;  // RGB, 8 bits; empty unless asked for
  RenderStats stats;
};

/// Rows of a frame, counted from its window's first, that are rendered together.
struct Strip {
  uint32_t first_row = 0;
  uint32_t rows = 0;
};

class Renderer {
 public:
  virtual ~Renderer() = default;
  /// The most rows a strip may have, at least 1.
  virtual uint32_t max_rows() const = 0;
  virtual const Holding& holding() const = 0;
  /// Takes over what `move_to` has moved in the scene.
  virtual Result<void> follow(const Moved& moved) = 0;
  /// Renders a strip into its rows of `frame`, whose buffers have the window's size. Several renderers may do so at
  /// once, each its own strip: nothing else of `frame` is touched, its stats included. `progress` hears the strip's
  /// share.
  virtual Result<RenderStats> render(Strip strip, Frame& frame, const Progress& progress) = 0;
};

}  // namespace kd::render
