// Primary hits against Embree 3 (robust), on the same primary rays: the same primitive, at the same depth to 1e-5 of
// the scene's diagonal, for at least 99.99 % of the pixels; and for each pixel that disagrees a computation, in double
// and on the mesh as the file has it, that shows why it may: the ray passes an edge within what quantising may move it,
// or the two surfaces lie on each other.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <doctest/doctest.h>
#include <embree3/rtcore.h>

#include "mesh/read_mesh.h"
#include "nkd/object_file.h"
#include "support/workshop.h"

namespace {

using namespace kd;
using namespace kd::test;

struct Hit {
  int64_t primitive = -1;
  double t = 0;
};

class EmbreeScene {
 public:
  explicit EmbreeScene(const mesh::Mesh& mesh) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.positions.size()));
    for (Vec3d p : mesh.positions) {
      for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(p[axis]);
    }
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) indices = std::copy(triangle.begin(), triangle.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  Hit closest(Vec3d origin, Vec3d direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    const Vec3f o = vec_cast<float>(origin), d = vec_cast<float>(direction);
    query.ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, std::numeric_limits<float>::infinity(), 0xffffffffu, 0, 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.hit.primID, query.ray.tfar};
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

using Corners = std::array<Vec3d, 3>;

double distance_line_segment(Vec3d o, Vec3d d, Vec3d a, Vec3d b) {
  const Vec3d e = b - a, r = a - o;
  const double de = dot(d, e), ee = dot(e, e), denominator = ee - de * de;  // d has length 1
  double s = denominator > 0 ? (dot(r, d) * de - dot(r, e)) / denominator : 0;
  s = std::clamp(s, 0.0, 1.0);
  const Vec3d p = a + e * s;
  return length((p - o) - d * dot(p - o, d));
}

double distance_to_edges(Vec3d o, Vec3d d, const Corners& c) {
  return std::min({distance_line_segment(o, d, c[0], c[1]), distance_line_segment(o, d, c[1], c[2]),
                   distance_line_segment(o, d, c[2], c[0])});
}

class Source {
 public:
  Source(const mesh::Mesh& mesh, Vec3d origin, double tolerance) : mesh_(mesh), o_(origin), tolerance_(tolerance) {}

  /// Whether the ray meets both triangles, inside or within the tolerance of an edge, in one place: at distances that
  /// differ by no more than float32's rounding of the coordinates involved.
  bool coincident(Vec3d d, const Hit& a, const Hit& b) const {
    if (a.primitive < 0 || b.primitive < 0 || !meets(d, a) || !meets(d, b)) return false;
    const double ta = plane_distance(d, a), tb = plane_distance(d, b);
    return std::fabs(ta - tb) <= 0x1p-22 * (std::fabs(ta) + length(o_));
  }
  /// Whether a tracer that is exact to the tolerance may have missed the nearer of the two hits: the ray passes its
  /// border.
  bool at_edge(Vec3d d, const Hit& a, const Hit& b) const {
    const Hit& nearer = b.primitive < 0 || (a.primitive >= 0 && a.t <= b.t) ? a : b;
    return distance_to_edges(o_, d, corners(nearer)) <= tolerance_;
  }
  /// Whether both hits are on one triangle, each as near to its plane as the tolerance.
  bool grazing(Vec3d d, const Hit& a, const Hit& b) const {
    if (a.primitive != b.primitive || a.primitive < 0) return false;
    return std::max(off_plane(d, a), off_plane(d, b)) <= tolerance_;
  }

 private:
  double off_plane(Vec3d d, const Hit& h) const {
    const Corners c = corners(h);
    return std::fabs(dot(o_ + d * h.t - c[0], normalised(cross(c[1] - c[0], c[2] - c[0]))));
  }
  Corners corners(const Hit& h) const {
    const auto& t = mesh_.triangles[static_cast<size_t>(h.primitive)];
    return {mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]};
  }
  double plane_distance(Vec3d d, const Hit& h) const {
    const Corners c = corners(h);
    const Vec3d n = cross(c[1] - c[0], c[2] - c[0]);
    return dot(c[0] - o_, n) / dot(d, n);
  }
  bool meets(Vec3d d, const Hit& h) const {
    const Corners c = corners(h);
    const auto side = [&](Vec3d p, Vec3d q) { return dot(d, cross(p - o_, q - o_)); };
    const double u = side(c[1], c[2]), v = side(c[2], c[0]), w = side(c[0], c[1]);
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0) || distance_to_edges(o_, d, c) <= tolerance_;
  }

  const mesh::Mesh& mesh_;
  Vec3d o_;
  double tolerance_;
};

void compare(const std::string& name, const std::filesystem::path& file, const CameraFile& camera) {
  auto mesh = mesh::read_mesh(file.string(), {});
  REQUIRE(mesh);
  const EmbreeScene embree(*mesh);
  Workshop workshop;
  const std::string object = workshop.compile(file);
  const auto opened = nkd::ObjectFile::open(object);
  REQUIRE(opened);
  const auto cpu = render::choose_device("cpu");
  REQUIRE(cpu);
  const scene::Scene scene = object_scene(object, camera);
  const render::Frame frame = render_all(scene, *cpu);
  const auto words = [&](image::Aov aov) { return frame.film.aovs[static_cast<size_t>(aov)].words; };
  const auto primitives = words(image::Aov::primitive), depths = words(image::Aov::depth);

  auto loaded = render::load_scene(scene, {});
  REQUIRE(loaded);
  const double diagonal = length(opened->summary().lattice.extent);
  // Quantising moves a vertex, snapping the ray (2^-24 of the cube), and Embree rounds to float32.
  const double tolerance =
      opened->summary().max_displacement + diagonal * 0x1p-23 + length(camera.camera.position) * 0x1p-22;
  const Source source(*mesh, camera.camera.position, tolerance);
  size_t twice = 0, disagree = 0, unexplained = 0;
  for (uint32_t pixel = 0; pixel < primitives.size(); ++pixel) {
    const render::CameraView& view = loaded->camera;
    const Vec3d d = normalised(view.corner + view.right * double(pixel % frame.film.width) +
                               view.down * double(pixel / frame.film.width));
    const Hit theirs = embree.closest(view.position, d);
    Hit ours;
    if (primitives[pixel] != 0xffffffffu) ours = {primitives[pixel], std::bit_cast<float>(depths[pixel])};
    const bool same_depth = std::fabs(ours.t - theirs.t) <= 1e-5 * diagonal;
    if (ours.primitive == theirs.primitive && same_depth) continue;
    if (same_depth && source.coincident(d, ours, theirs)) {
      ++twice;
      continue;
    }
    ++disagree;
    if (source.at_edge(d, ours, theirs) || source.grazing(d, ours, theirs)) continue;
    ++unexplained;
    MESSAGE(name << " pixel " << pixel << ": ours " << ours.primitive << " at " << ours.t << ", Embree's "
                 << theirs.primitive << " at " << theirs.t);
  }
  MESSAGE(name << ": of " << primitives.size() << " pixels " << twice << " see two triangles in one place, " << disagree
               << " disagree, " << unexplained << " of those unexplained");
  CHECK(static_cast<double>(disagree) <= 1e-4 * static_cast<double>(primitives.size()));
  CHECK(unexplained == 0);
}

}  // namespace

TEST_CASE("primary hits are Embree's") {
  for (const char* name : {"sibenik", "bunny", "sponza", "dragon_res2"}) {
    const auto mesh = shared_mesh(std::string(name) + ".ply");
    if (!mesh) {
      MESSAGE("skipped: no " << name << " in " << shared_data().string());
      continue;
    }
    compare(name, *mesh, read_camera_file(shared_data() / "cameras" / (std::string(name) + ".txt")));
  }
}

TEST_CASE("primary hits are Embree's on a mesh of our own") {
  CameraFile camera;
  camera.camera = {{1.5, 1.2, 2.6}, {0, 0.1, 0}, {0, 1, 0}, 50};
  camera.light = {3, 4, 5};
  compare("icosphere", source_root() / "data" / "icosphere.ply", camera);
}
