// How a camera looks, as directions.
#pragma once

#include <cmath>
#include <numbers>

#include "scene/scene.h"

namespace kd::scene {

/// Of length 1, at right angles; `right` and `up` as the picture has them.
struct CameraAxes {
  Vec3d forward;
  Vec3d right;
  Vec3d up;
  double half_height = 1;  // of the picture at distance 1 before the camera
};

/// Of a camera without keys, at which nothing is wrong.
inline CameraAxes camera_axes(const Camera& camera) {
  CameraAxes axes;
  axes.forward = normalised(camera.target - camera.position);
  axes.right = normalised(cross(axes.forward, normalised(camera.up)));
  axes.up = cross(axes.right, axes.forward);
  axes.half_height = std::tan(camera.vertical_fov_degrees * std::numbers::pi / 360);
  return axes;
}

}  // namespace kd::scene
