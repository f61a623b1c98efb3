// Scenes whose size is a parameter. A wall of stones fills the picture however many they are, so that what differs
// between scenes is how much they hold and not how much of the film is covered. The camera is far away: it sees the
// wall as if from infinity.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "sys/result.h"

namespace kd::bench::scale {

constexpr uint32_t kStones = 10;  // different ones

/// Compiles the stones, and gives them as many names as there are asked for.
class Quarry {
 public:
  /// Works in `folder`, which must exist. Errors as those of compiling.
  static Result<Quarry> open(const std::string& folder);
  /// The first so many of objects that are files of their own; every tenth is the same stone. ErrorClass::output.
  Result<std::vector<scene::SceneObject>> objects(uint32_t count) const;
  const std::string& folder() const { return folder_; }

 private:
  explicit Quarry(std::string folder) : folder_(std::move(folder)) {}
  std::string folder_;
};

/// A scene of `objects`, with one light and nothing in it.
scene::Scene empty_scene(std::vector<scene::SceneObject> objects, scene::FilmSize film);

/// Where a wall stands: in the picture, or behind the camera and out of the way of every shadow ray.
enum class Place { in_view, out_of_view };

/// Adds `count` instances, of the objects first, first + 1, ... up to `end`, and over again.
void add_wall(scene::Scene& scene, uint64_t count, Place place, uint32_t first, uint32_t end);

/// Adds `count` stones before the wall, each with keys of its own: from frame 1 on they drift by a tenth of their size
/// a frame.
void add_drifting(scene::Scene& scene, uint32_t count);

enum class Lighting { lit, black, behind };
/// In place of the scene's light: so many, all lighting the wall, or none of them for this reason.
void set_lights(scene::Scene& scene, uint32_t count, Lighting lighting);

}  // namespace kd::bench::scale
