// What a frame leaves on disk.
#pragma once

#include "kdrender/options.h"
#include "render/device_group.h"

namespace kd::tools {

/// What the options say, for one film. ErrorClass::usage.
Result<render::RenderSettings> settings_of(const RenderOptions& o, const scene::FilmSize& film);

/// Everything that the colour of a frame depends on, as text: scene, objects, settings.
std::string fingerprint(const RenderOptions& o, const std::string& scene_hash, const std::string& objects_hash,
                        int frame);

/// Whether the frame's EXR is there, whole, and has this fingerprint, and all else that `o` names is there too.
bool is_done(const RenderOptions& o, const std::string& fingerprint);

/// What a header says beside the film.
struct FrameNotes {
  scene::Camera camera;
  scene::FilmSize film;
  std::string scene_hash, objects_hash, fingerprint, device;
  int frame = 0;
  double render_seconds = 0;
};

/// Writes the EXR, the preview and the heatmap that `o` names; takes the visits out of the film if they are only the
/// heatmap's. Returns the largest number of visits of a ray, 0 without a heatmap.
Result<uint32_t> write_images(const RenderOptions& o, render::Frame& frame, const FrameNotes& notes);

/// ErrorClass::differs if the film is not what --compare and --threshold ask for; else what the difference is.
Result<std::string> compare(const RenderOptions& o, const image::Film& film);

}  // namespace kd::tools
