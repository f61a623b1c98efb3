#include "kdbuild/asset_scene.h"

#include "scene/framing.h"

namespace kd::tools {

namespace {

scene::Light stored(const mesh::AssetLight& light) {
  return {light.point ? scene::LightKind::point : scene::LightKind::directional, light.position, light.direction,
          light.colour};
}

/// From over the viewer's left shoulder: what is seen is lit, and not flatly.
scene::Light key_light(const scene::Camera& camera) {
  const Vec3d ahead = normalised(camera.target - camera.position);
  const Vec3d right = normalised(cross(ahead, camera.up));
  const Vec3d direction = normalised(ahead + right * 0.5 - normalised(camera.up) * 0.5);
  return {scene::LightKind::directional, {0, 0, 0}, direction, {0.9f, 0.9f, 0.9f}};
}

void extend(Box3d& box_scene, const Box3d& box_model, const Frame& frame) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p{corner & 1 ? box_model.hi.x : box_model.lo.x, corner & 2 ? box_model.hi.y : box_model.lo.y,
                  corner & 4 ? box_model.hi.z : box_model.lo.z};
    box_scene.extend(frame.apply_point(p));
  }
}

}  // namespace

scene::Scene asset_scene(const mesh::Asset& asset, const std::string& name, const std::vector<SceneMember>& members) {
  scene::Scene out;
  scene::Character character{name, {}};
  Box3d box_scene;
  std::vector<std::vector<uint32_t>> members_of(asset.meshes.size());
  for (const SceneMember& member : members) {
    members_of[member.mesh].push_back(static_cast<uint32_t>(out.objects.size()));
    out.objects.push_back({member.name, member.file});
  }
  for (const mesh::MeshInstance& instance : asset.instances) {
    for (const uint32_t i : members_of[instance.mesh]) {
      scene::Part part;
      part.name = instance.name;
      part.object = i;
      part.placement = scene::FramePlacement{instance.frame};
      character.parts.push_back(part);
      extend(box_scene, members[i].box, instance.frame);
    }
  }
  out.characters.push_back(std::move(character));
  if (asset.camera) {
    out.camera = {asset.camera->position, asset.camera->target, asset.camera->up, asset.camera->vertical_fov_degrees};
  } else {
    out.camera = scene::framing_camera(box_scene, out.film);
  }
  out.ambient = {0.2f, 0.2f, 0.2f};  // no mesh format speaks of it, and shadows would be black
  for (const mesh::AssetLight& light : asset.lights) out.lights.push_back(stored(light));
  if (out.lights.empty()) out.lights.push_back(key_light(out.camera));
  return out;
}

}  // namespace kd::tools
