// Motion: what a scene with keys is at a frame. Frames are real numbers; everything here is a pure function of one.
//
// Linear: straight from key to key. Smooth: cubic Hermite curves with the tangents of Catmull and Rom ("A class of
// local interpolating splines", 1974), differences over the neighbouring keys by the frames between them; at its first
// and last key a field is at rest, so that holding it before and after is smooth too. Rotations: rotation.h.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.h"
#include "sys/result.h"

namespace kd::scene {

/// Of a still picture.
constexpr double kDefaultFrame = 1;

/// The camera at a frame, without keys. ErrorClass::scene if between its keys it comes to look nowhere.
Result<Camera> camera_at(const Scene& scene, double frame);

/// The lights at a frame, without keys, one a light of the scene. Colours that overshoot below zero are cut off there.
/// ErrorClass::scene if between its keys a light comes to shine nowhere.
Result<std::vector<Light>> lights_at(const Scene& scene, double frame);

struct FrameRange {
  double first = 0;
  double last = 0;
};

/// From the first to the last key of all; nothing if nothing has keys.
std::optional<FrameRange> key_range(const Scene& scene);

/// Fields at a frame, unchecked; without keys.
Camera interpolated(const Camera& camera, double frame);
Light interpolated(const Light& light, double frame);
TransformPlacement interpolated(const TransformPlacement& placement, double frame);

struct CameraFault {
  const char* field;  // as the scene file calls it
  const char* what;
};

/// What keeps a camera without keys from seeing.
std::optional<CameraFault> find_fault(const Camera& camera);

}  // namespace kd::scene
