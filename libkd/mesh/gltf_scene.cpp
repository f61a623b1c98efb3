#include "mesh/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "core/box.h"
#include "mesh/lattice_fit.h"

namespace kd::mesh {
namespace {

/// A matrix's last row may be off (0, 0, 0, 1) by this much.
constexpr double kAffineTolerance = 1e-6;
/// The least distance of a point light to the centre, in diagonals.
constexpr double kLeastLightDistance = 0.1;

Vec3d vector_of(const std::vector<double>& v, Vec3d otherwise) {
  return v.empty() ? otherwise : Vec3d{v[0], v[1], v[2]};
}

/// A node's own frame, in its parent's; or what is wrong.
std::string read_frame(const tinygltf::Node& node, Frame& frame) {
  if (!node.matrix.empty()) {
    const auto column = [&](size_t i) { return Vec3d{node.matrix[i], node.matrix[i + 1], node.matrix[i + 2]}; };
    const double last_row[] = {node.matrix[3], node.matrix[7], node.matrix[11], node.matrix[15] - 1};
    for (const double v : last_row) {
      if (!(std::fabs(v) <= kAffineTolerance)) return "the last row of 'matrix' must be 0, 0, 0, 1";
    }
    frame = {column(12), column(0), column(4), column(8)};
    return "";
  }
  const Vec3d scale = vector_of(node.scale, {1, 1, 1});
  Vec3d axis{0, 0, 0};  // of the quaternion
  double w = 1;
  if (!node.rotation.empty()) {
    const auto& q = node.rotation;
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(length > 0) || std::isinf(length)) return "'rotation' must be a quaternion of length 1";
    axis = {q[0] / length, q[1] / length, q[2] / length};
    w = q[3] / length;
  }
  const auto turned = [&](Vec3d v) {
    const Vec3d t = cross(axis, v) * 2.0;
    return v + t * w + cross(axis, t);
  };
  frame = {vector_of(node.translation, {0, 0, 0}), turned({1, 0, 0}) * scale.x, turned({0, 1, 0}) * scale.y,
           turned({0, 0, 1}) * scale.z};
  return "";
}

bool is_index(int number, size_t count) { return number >= 0 && static_cast<size_t>(number) < count; }

/// Walks the nodes and collects what they hold.
class Placer {
 public:
  Placer(const GltfFile& file, const std::string& path, const std::vector<uint32_t>& mesh_of, Asset& asset)
      : model_(file.model), path_(path), mesh_of_(mesh_of), asset_(asset) {}

  Result<void> run();

 private:
  struct Light {
    const tinygltf::Light* source;
    Frame frame;
  };

  Error failed(const std::string& what) const { return {ErrorClass::mesh, path_, what + "; export the mesh again"}; }
  /// Per node: its parent, or -1.
  Result<std::vector<int>> find_parents() const;
  Result<std::vector<int>> find_roots(const std::vector<int>& parents) const;
  Result<void> visit(int number, const Frame& frame);
  void place_camera(const tinygltf::Camera& source, const Frame& frame);
  void place_lights(const Box3d& box_scene);
  Box3d placed_box() const;
  void warn(uint64_t count, const char* what) {
    if (count > 0) asset_.warnings.push_back(fmt::format("{} {}", count, what));
  }

  const tinygltf::Model& model_;
  const std::string& path_;
  const std::vector<uint32_t>& mesh_of_;
  Asset& asset_;
  std::vector<Light> lights_;
  std::optional<Frame> camera_frame_;
  uint64_t singular_ = 0, left_out_cameras_ = 0;
};

Result<std::vector<int>> Placer::find_parents() const {
  const auto& nodes = model_.nodes;
  std::vector<int> parents(nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      if (!is_index(child, nodes.size())) {
        return failed(fmt::format("node {} has the child {}, but there are {} nodes", i, child, nodes.size()));
      }
      int& parent = parents[static_cast<size_t>(child)];
      if (parent >= 0) return failed(fmt::format("node {} has two parents, {} and {}", child, parent, i));
      parent = static_cast<int>(i);
    }
  }
  // With one parent each, nodes that no root leads to are in a cycle or below one.
  std::vector<int> open;
  size_t reached = 0;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (parents[i] < 0) open.push_back(static_cast<int>(i));
  }
  for (; !open.empty(); ++reached) {
    const auto& children = nodes[static_cast<size_t>(open.back())].children;
    open.pop_back();
    open.insert(open.end(), children.begin(), children.end());
  }
  if (reached < nodes.size()) return failed("the nodes form a cycle");
  return parents;
}

Result<std::vector<int>> Placer::find_roots(const std::vector<int>& parents) const {
  std::vector<int> roots;
  if (model_.scenes.empty()) {
    for (size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] < 0) roots.push_back(static_cast<int>(i));
    }
    return roots;
  }
  const int scene = std::max(model_.defaultScene, 0);
  if (!is_index(scene, model_.scenes.size())) {
    return failed(fmt::format("the default scene is {}, but there are {}", scene, model_.scenes.size()));
  }
  roots = model_.scenes[static_cast<size_t>(scene)].nodes;
  std::vector<bool> seen(parents.size(), false);
  for (const int root : roots) {
    if (!is_index(root, parents.size())) {
      return failed(fmt::format("scene {} has node {}, but there are {}", scene, root, parents.size()));
    }
    const auto i = static_cast<size_t>(root);
    if (seen[i] || parents[i] >= 0) {
      return failed(fmt::format("scene {} has node {} twice, or below another node too", scene, root));
    }
    seen[i] = true;
  }
  return roots;
}

Result<void> Placer::visit(int number, const Frame& frame) {
  const tinygltf::Node& node = model_.nodes[static_cast<size_t>(number)];
  if (node.mesh >= 0) {
    if (!is_index(node.mesh, mesh_of_.size())) {
      return failed(fmt::format("node {} has mesh {}, but there are {}", number, node.mesh, mesh_of_.size()));
    }
    const uint32_t mesh = mesh_of_[static_cast<size_t>(node.mesh)];
    if (mesh != kNoIndex && is_singular(frame)) ++singular_;
    if (mesh != kNoIndex && !is_singular(frame)) asset_.instances.push_back({node.name, mesh, frame});
  }
  if (node.camera >= 0) {
    if (!is_index(node.camera, model_.cameras.size())) {
      return failed(fmt::format("node {} has camera {}, but there are {}", number, node.camera, model_.cameras.size()));
    }
    place_camera(model_.cameras[static_cast<size_t>(node.camera)], frame);
  }
  const auto extension = node.extensions.find("KHR_lights_punctual");
  if (extension != node.extensions.end() && extension->second.Has("light")) {
    const int light = extension->second.Get("light").GetNumberAsInt();
    if (!is_index(light, model_.lights.size())) {
      return failed(fmt::format("node {} has light {}, but there are {}", number, light, model_.lights.size()));
    }
    lights_.push_back({&model_.lights[static_cast<size_t>(light)], frame});
  }
  return {};
}

void Placer::place_camera(const tinygltf::Camera& source, const Frame& frame) {
  const double degrees = source.perspective.yfov * 180 / std::numbers::pi;
  if (asset_.camera || source.type != "perspective" || !(degrees > 0 && degrees < 180) || is_singular(frame)) {
    ++left_out_cameras_;
    return;
  }
  asset_.camera.emplace();
  asset_.camera->vertical_fov_degrees = degrees;
  camera_frame_ = frame;
}

/// Around the boxes of the meshes as placed.
Box3d Placer::placed_box() const {
  std::vector<Box3d> boxes;
  for (const NamedMesh& mesh : asset_.meshes) boxes.push_back(bounds(mesh.mesh));
  Box3d box;
  for (const MeshInstance& instance : asset_.instances) {
    const Box3d& b = boxes[instance.mesh];
    if (b.empty() || !is_finite(b.extent())) continue;
    for (int corner = 0; corner < 8; ++corner) {
      box.extend(instance.frame.apply_point(
          {corner & 1 ? b.hi.x : b.lo.x, corner & 2 ? b.hi.y : b.lo.y, corner & 4 ? b.hi.z : b.lo.z}));
    }
  }
  return box;
}

void Placer::place_lights(const Box3d& box_scene) {
  const Vec3d centre = (box_scene.lo + box_scene.hi) * 0.5;
  const double least = kLeastLightDistance * length(box_scene.extent());
  std::vector<Vec3d> colours;
  double brightest = 0;
  uint64_t spots = 0, left_out = 0;
  for (const Light& light : lights_) {
    AssetLight placed;
    placed.point = light.source->type != "directional";
    placed.position = light.frame.point;
    placed.direction = normalised(-light.frame.z_axis);
    const double distance = std::max(length(light.frame.point - centre), least);
    const double strength = placed.point ? light.source->intensity / (distance * distance) : light.source->intensity;
    const Vec3d colour = vector_of(light.source->color, {1, 1, 1}) * strength;
    const bool is_sound = colour.x >= 0 && colour.y >= 0 && colour.z >= 0 && is_finite(colour) &&
                          is_finite(light.frame.point) && std::fabs(length(placed.direction) - 1) < 0.5;
    if (!is_sound) {
      ++left_out;
      continue;
    }
    spots += light.source->type == "spot";
    brightest = std::max({brightest, colour.x, colour.y, colour.z});
    colours.push_back(colour);
    asset_.lights.push_back(placed);
  }
  for (size_t i = 0; i < colours.size() && brightest > 0; ++i) {
    const Vec3d c = colours[i];
    asset_.lights[i].colour = vec_cast<float>(Vec3d{c.x / brightest, c.y / brightest, c.z / brightest});
  }
  if (brightest == 0) asset_.lights.clear();
  warn(spots, "spot light(s) shine all round, like point lights");
  warn(left_out, "light(s) left out: negative, not finite or without a direction");
}

Result<void> Placer::run() {
  const Result<std::vector<int>> parents = find_parents();
  if (!parents) return parents.error();
  const Result<std::vector<int>> roots = find_roots(*parents);
  if (!roots) return roots.error();

  // A stack of our own: the nodes of a file may form a chain of any length.
  struct Open {
    int node;
    Frame parent;
  };
  std::vector<Open> open;
  for (auto root = roots->rbegin(); root != roots->rend(); ++root) open.push_back({*root, {}});
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const tinygltf::Node& node = model_.nodes[static_cast<size_t>(next.node)];
    Frame own;
    if (const std::string fault = read_frame(node, own); !fault.empty()) {
      return failed(fmt::format("node {}: {}", next.node, fault));
    }
    const Frame frame = compose(next.parent, own);
    if (auto visited = visit(next.node, frame); !visited) return visited;
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) open.push_back({*child, frame});
  }
  warn(singular_, "placement(s) left out: their axes lie in a plane or are not finite");
  warn(left_out_cameras_, "camera(s) left out: one is used, the first with perspective");
  if (asset_.instances.empty()) {
    for (uint32_t i = 0; i < asset_.meshes.size(); ++i) asset_.instances.push_back({asset_.meshes[i].name, i, {}});
    asset_.warnings.emplace_back("no node places a mesh: each stands once, as it was modelled");
  }

  Box3d box_scene = placed_box();
  if (box_scene.empty()) box_scene = {{0, 0, 0}, {0, 0, 0}};
  if (camera_frame_) {
    const Frame& frame = *camera_frame_;
    // The target is about as far as the scene, and the two differ at any scale.
    const double away = std::max(length((box_scene.lo + box_scene.hi) * 0.5 - frame.point), 1e-6 * length(frame.point));
    asset_.camera->position = frame.point;
    asset_.camera->target = frame.point - normalised(frame.z_axis) * (away > 0 && std::isfinite(away) ? away : 1.0);
    asset_.camera->up = normalised(frame.y_axis);
  }
  place_lights(box_scene);
  return {};
}

}  // namespace

Result<void> place_nodes(const GltfFile& file, const std::string& path, const std::vector<uint32_t>& mesh_of,
                         Asset& asset) {
  return Placer(file, path, mesh_of, asset).run();
}

}  // namespace kd::mesh
