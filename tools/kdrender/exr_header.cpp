#include "kdrender/exr_header.h"

#include <vector>

#include "scene/camera_axes.h"
#include "sys/hash.h"

namespace kd::tools {

namespace {

/// The matrix that takes p to (dot(columns[i], p - origin))_i, and to a fourth coordinate of the same kind.
image::Matrix4 matrix_of(const Vec3d (&columns)[4], const double (&offsets)[4], Vec3d origin) {
  image::Matrix4 m{};
  for (size_t column = 0; column < 4; ++column) {
    for (size_t row = 0; row < 3; ++row) {
      m[4 * row + column] = static_cast<float>(columns[column][static_cast<int>(row)]);
    }
    m[12 + column] = static_cast<float>(offsets[column] - dot(columns[column], origin));
  }
  return m;
}

}  // namespace

image::Matrix4 world_to_camera(const scene::Camera& camera) {
  const scene::CameraAxes axes = scene::camera_axes(camera);
  return matrix_of({axes.right, axes.up, -axes.forward, {0, 0, 0}}, {0, 0, 0, 1}, camera.position);
}

image::Matrix4 world_to_ndc(const scene::Camera& camera, const scene::FilmSize& film) {
  const scene::CameraAxes axes = scene::camera_axes(camera);
  const double half_width = axes.half_height * film.width / film.height;
  const Vec3d depth = axes.forward;  // what a point is divided by
  const Vec3d none{0, 0, 0};         // z is 1 before the division, so that the matrix has an inverse
  return matrix_of(
      {axes.right * (0.5 / half_width) + depth * 0.5, axes.up * (-0.5 / axes.half_height) + depth * 0.5, none, depth},
      {0, 0, 1, 0}, camera.position);
}

std::string objects_hash(const render::LoadedScene& scene) {
  std::vector<uint64_t> marks;
  for (const std::optional<nkd::Summary>& summary : scene.summaries) {
    if (!summary) continue;
    const std::string& settings = summary->provenance.settings;
    marks.insert(marks.end(), {summary->provenance.source_hash, hash_bytes(settings.data(), settings.size())});
  }
  return hash_text(hash_bytes(marks.data(), marks.size() * sizeof(uint64_t)));
}

}  // namespace kd::tools
