#include "scene/framing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kd::scene {

namespace {

constexpr Vec3d kTowardsCamera{0.55, 0.4, 0.75};
constexpr double kFovDegrees = 40;
constexpr double kUsed = 0.9;  // of the film, between margins

}  // namespace

Camera framing_camera(const Box3d& box_scene, const FilmSize& film) {
  const Vec3d centre = box_scene.lo + box_scene.extent() * 0.5;
  const Vec3d back = normalised(kTowardsCamera), right = normalised(cross({0, 1, 0}, back)), up = cross(back, right);
  const double slope_y = kUsed * std::tan(kFovDegrees / 2 * std::numbers::pi / 180);
  const double slope_x = slope_y * film.width / film.height;
  // A corner is seen from so far that its offsets from the axis fit the film at its depth.
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p = Vec3d{corner & 1 ? box_scene.hi.x : box_scene.lo.x, corner & 2 ? box_scene.hi.y : box_scene.lo.y,
                          corner & 4 ? box_scene.hi.z : box_scene.lo.z} -
                    centre;
    const double across = std::max(std::fabs(dot(p, right)) / slope_x, std::fabs(dot(p, up)) / slope_y);
    distance = std::max(distance, dot(p, back) + across);
  }
  // A point is looked at from where the coordinates still tell the camera from it.
  if (!(distance > 0)) distance = std::max(1.0, 1e-6 * length(centre));
  Camera camera;
  camera.position = centre + back * distance;
  camera.target = centre;
  camera.up = {0, 1, 0};
  camera.vertical_fov_degrees = kFovDegrees;
  return camera;
}

}  // namespace kd::scene
