// Scenes written and read back; cameras that frame a box.
#include "scene/write_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "scene/framing.h"
#include "scene/parse_scene.h"
#include "support/temp_folder.h"

using namespace kd;
using namespace kd::scene;

namespace {

/// A scene with everything that a scene may have, and numbers that are hard to write.
Scene full_scene(const test::TempFolder& folder) {
  Scene s;
  s.film = {1, 65536};
  s.camera = {{0.1, 1.0 / 3, -1e-300}, {1e20, 5e-324, 1.7976931348623157e308}, {0, 1, 0}, 179.99999999999997};
  s.background = {0.1f, 7.038531e-26f, 3.4028235e38f};
  s.ambient = {1.17549435e-38f, 1e-45f, 16777216};
  s.lights.push_back({LightKind::point, {1, 2, 0.1}, {0, -1, 0}, {1, 0.3f, 0}});
  s.lights.push_back({LightKind::directional, {0, 0, 0}, {0, 0, -1}, {0, 0, 0}});
  s.lights.push_back({LightKind::spot, {1, 2, 3}, {0, 1, 0}, {3, 0, 0}, 0.1, 179.9, Falloff::inverse_square, 0.3});
  s.objects = {{"cube", folder.file("compiled/cube.nkd")},
               {"unused \"one\" \\ of 東", folder.file("u \"q\" \\ 東.nkd")}};
  Part box, frame, moved, turned, plain;
  box.placement = BoxPlacement{{{1, 2, 3}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3}}};
  frame.placement = FramePlacement{{{-0.0, 2e-10, 3}, {1, 0.5, 0}, {0, 1e10, 0}, {0, 0, -1}}};
  moved.placement = TransformPlacement{{1, 0, 0}, {0, 0, 1}, 0, {1, 1, -2}};
  turned.placement = TransformPlacement{{0, 0, 0}, {1, 2, 3}, 33.3, {1, 1, 1}};
  turned.material = Material{{0.1f, 0.2f, 0.3f}, {1, 1, 1}, {0, 0.5f, 0}, 12.5f, {0, 3, 0.25f}};
  plain.name = "tab\tand \"quotes\"";
  plain.object = 1;
  s.characters = {{"first", {box, frame, moved}}, {"", {turned, plain}}};
  // Characters within others, one of the same name as another and one without.
  Part first, second;
  first.character = 3;
  first.material = Material{};
  first.sides = Sides::front;
  turned.sides = Sides::both;
  second.character = 4;
  second.placement = TransformPlacement{{1, 2, 3}};
  s.characters.push_back({"outer", {first, second, box}, FramePlacement{{{1, 2, 3}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}}}});
  s.characters.push_back({"first", {plain}, TransformPlacement{{0, 1, 0}, {0, 1, 0}, 45, {2, 2, 2}}, false});
  TransformPlacement moving;
  moving.scale = {1, 2, 3};
  moving.interpolation = Interpolation::smooth;
  moving.keys = {
      {-0.5, Vec3d{0.1, 0, 0}, Rotation{{0, 1, 0}, 400}, {}}, {1, {}, {}, Vec3d{1, 1, -1}}, {2.25, {}, {}, {}}};
  s.characters.push_back({"", {plain}, moving, false});
  s.camera.interpolation = Interpolation::smooth;
  s.camera.keys = {{1, Vec3d{0, 0, 0.1}, Vec3d{9, 8, 7}, Vec3d{0, 1, 0.1}, 33.3}, {2, Vec3d{0, 0, 1}, {}, {}, {}}};
  s.lights[0].keys = {{1, Vec3d{0, 0, 0.1}, {}, Vec3f{0.1f, 0, 0}}, {7, {}, {}, Vec3f{0.2f, 0, 0}}};
  s.lights[1].interpolation = Interpolation::smooth;
  s.lights[1].keys = {{3, {}, Vec3d{0, -1, 0}, {}}};
  return s;
}

bool same(const Rotation& a, const Rotation& b) { return a.axis == b.axis && a.degrees == b.degrees; }

bool same(const TransformKey& a, const TransformKey& b) {
  return a.frame == b.frame && a.translate == b.translate && a.rotate.has_value() == b.rotate.has_value() &&
         (!a.rotate || same(*a.rotate, *b.rotate)) && a.scale == b.scale;
}
bool same(const CameraKey& a, const CameraKey& b) {
  return a.frame == b.frame && a.position == b.position && a.target == b.target && a.up == b.up &&
         a.vertical_fov_degrees == b.vertical_fov_degrees;
}
bool same(const LightKey& a, const LightKey& b) {
  return a.frame == b.frame && a.position == b.position && a.direction == b.direction && a.colour == b.colour;
}

template <class Moving>
bool same_motion(const Moving& a, const Moving& b) {
  return a.interpolation == b.interpolation && std::equal(a.keys.begin(), a.keys.end(), b.keys.begin(), b.keys.end(),
                                                          [](const auto& x, const auto& y) { return same(x, y); });
}

bool same(const Frame& a, const Frame& b) {
  return a.point == b.point && a.x_axis == b.x_axis && a.y_axis == b.y_axis && a.z_axis == b.z_axis;
}

bool same(const BoxPlacement& a, const BoxPlacement& b) { return same(a.box, b.box); }
bool same(const FramePlacement& a, const FramePlacement& b) { return same(a.frame, b.frame); }
bool same(const TransformPlacement& t, const TransformPlacement& u) {
  return t.translate == u.translate && t.rotate_axis == u.rotate_axis && t.rotate_degrees == u.rotate_degrees &&
         t.scale == u.scale && same_motion(t, u);
}

template <class... Kinds>
bool same(const std::variant<Kinds...>& a, const std::variant<Kinds...>& b) {
  if (a.index() != b.index()) return false;
  return std::visit([&](const auto& x) { return same(x, std::get<std::decay_t<decltype(x)>>(b)); }, a);
}

Scene written_and_read(const Scene& scene, const std::string& path) {
  const auto written = write_scene(scene, path);
  REQUIRE_MESSAGE(written, (written ? "" : written.error().line()));
  const auto read = read_scene(path);
  REQUIRE_MESSAGE(read, (read ? "" : read.error().line()));
  return *read;
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("write_scene: everything is read back as it was") {
  const test::TempFolder folder;
  const Scene s = full_scene(folder);
  const std::string path = folder.file("scene.json");
  const Scene r = written_and_read(s, path);
  CHECK(r.film.width == s.film.width);
  CHECK(r.film.height == s.film.height);
  CHECK(r.camera.position == s.camera.position);
  CHECK(r.camera.target == s.camera.target);
  CHECK(r.camera.up == s.camera.up);
  CHECK(r.camera.vertical_fov_degrees == s.camera.vertical_fov_degrees);
  CHECK(same_motion(r.camera, s.camera));
  CHECK(r.background == s.background);
  CHECK(r.ambient == s.ambient);
  REQUIRE(r.lights.size() == s.lights.size());
  for (size_t i = 0; i < s.lights.size(); ++i) {
    CHECK(r.lights[i].kind == s.lights[i].kind);
    CHECK(r.lights[i].colour == s.lights[i].colour);
    CHECK(same_motion(r.lights[i], s.lights[i]));
    CHECK(r.lights[i].falloff == s.lights[i].falloff);
    CHECK(r.lights[i].reach == s.lights[i].reach);
  }
  CHECK(r.lights[0].position == s.lights[0].position);
  CHECK(r.lights[1].direction == s.lights[1].direction);
  CHECK(r.lights[2].position == s.lights[2].position);
  CHECK(r.lights[2].direction == s.lights[2].direction);
  CHECK(r.lights[2].inner_degrees == s.lights[2].inner_degrees);
  CHECK(r.lights[2].outer_degrees == s.lights[2].outer_degrees);
  REQUIRE(r.objects.size() == s.objects.size());
  for (size_t i = 0; i < s.objects.size(); ++i) {
    CHECK(r.objects[i].name == s.objects[i].name);
    CHECK(r.objects[i].file == s.objects[i].file);
  }
  REQUIRE(r.characters.size() == s.characters.size());
  for (size_t i = 0; i < s.characters.size(); ++i) {
    CHECK(r.characters[i].name == (i == 3 ? "first 4" : i == 4 ? "character" : s.characters[i].name));
    CHECK(r.characters[i].shown == s.characters[i].shown);
    CHECK(same(r.characters[i].placement, s.characters[i].placement));
    REQUIRE(r.characters[i].parts.size() == s.characters[i].parts.size());
    for (size_t k = 0; k < s.characters[i].parts.size(); ++k) {
      const Part &a = s.characters[i].parts[k], &b = r.characters[i].parts[k];
      CHECK(a.object == b.object);
      CHECK(a.character == b.character);
      CHECK(same(a.placement, b.placement));
      CHECK(a.material == b.material);
    }
  }
  CHECK(r.characters[1].parts[1].name ==
        "tab\xEF\xBF\xBD"
        "and \"quotes\"");
  // One part a line, and the same text for the same scene.
  CHECK(r.characters[0].parts[1].line == r.characters[0].parts[0].line + 1);
  const std::string text = text_of(path);
  CHECK(text.find("\"file\": \"compiled/cube.nkd\"") != std::string::npos);
  CHECK(text.find("0.30000") == std::string::npos);
  written_and_read(r, path);
  CHECK(text_of(path) == text);
}

TEST_CASE("write_scene: floats come back whatever their bits") {
  const test::TempFolder folder;
  Scene s = full_scene(folder);
  uint32_t bits = 12345;
  s.lights.clear();
  while (s.lights.size() < 20000) {
    bits = bits * 1664525u + 1013904223u;
    const float value = std::bit_cast<float>(bits & 0x7fffffffu);
    if (std::isfinite(value)) s.lights.push_back({LightKind::point, {value, -value, 1.0 / bits}, {}, {value, 0, 1}});
  }
  const Scene r = written_and_read(s, folder.file("scene.json"));
  size_t same_lights = 0;
  for (size_t i = 0; i < s.lights.size(); ++i) {
    same_lights += r.lights[i].colour == s.lights[i].colour && r.lights[i].position == s.lights[i].position;
  }
  CHECK(same_lights == s.lights.size());
}

TEST_CASE("write_scene: objects in other folders, and links to folders") {
  namespace fs = std::filesystem;
  const test::TempFolder folder;
  fs::create_directories(folder.file("real/scenes"));
  fs::create_directories(folder.file("objects"));
  folder.write("objects/a.nkd", "a");
  fs::create_directory_symlink(folder.file("real/scenes"), folder.file("link"));
  for (const std::string place : {"scene.json", "objects/scene.json", "real/scenes/scene.json", "link/scene.json"}) {
    CAPTURE(place);
    Scene s = full_scene(folder);
    s.objects = {{"a", folder.file("objects/a.nkd")}};
    s.characters = {{"", {Part{}}}};
    const Scene r = written_and_read(s, folder.file(place));
    CHECK(fs::equivalent(r.objects[0].file, s.objects[0].file));
    CHECK(text_of(folder.file(place)).find(folder.path()) == std::string::npos);
  }
}

TEST_CASE("write_scene: a library stays one, and what it holds is not listed") {
  const test::TempFolder folder;
  std::filesystem::create_directories(folder.file("scenes"));
  Scene s = full_scene(folder);
  s.library = folder.file("stones");
  s.objects = {{"oak", folder.file("stones/oak.nkd")}, {"cube", folder.file("cube.nkd")}};
  Part oak, cube;
  cube.object = 1;
  s.characters = {{"", {oak, cube}}};
  const Scene r = written_and_read(s, folder.file("scenes/a.json"));
  const std::string text = text_of(folder.file("scenes/a.json"));
  CHECK(text.find("\"library\": \"../stones\"") != std::string::npos);
  CHECK(text.find("oak.nkd") == std::string::npos);
  REQUIRE(r.objects.size() == 2);
  for (size_t i : {0, 1}) {
    const SceneObject& object = r.objects[r.characters[0].parts[i].object];
    CHECK(object.name == s.objects[i].name);
    CHECK(std::filesystem::path(object.file).lexically_normal() == s.objects[i].file);
  }
  // Nothing but the library.
  s.objects.pop_back();
  s.characters[0].parts.pop_back();
  const Scene alone = written_and_read(s, folder.file("scenes/a.json"));
  CHECK(text_of(folder.file("scenes/a.json")).find("\"objects\"") == std::string::npos);
  CHECK(alone.objects.size() == 1);
}

TEST_CASE("write_scene: names that no scene can hold are replaced, and stay apart") {
  const test::TempFolder folder;
  Scene s = full_scene(folder);
  const std::string file = folder.file("a.nkd");
  s.objects = {{"a\n", file}, {"a\x01", file},  {"a\xff", file},
               {"", file},    {"object", file}, {"\xC0\x80\xED\xA0\x80", file}};
  s.characters = {{"bad \xE2\x82 end", {}}};
  for (uint32_t i = 0; i < s.objects.size(); ++i) {
    Part part;
    part.object = i;
    s.characters[0].parts.push_back(part);
  }
  const Scene r = written_and_read(s, folder.file("scene.json"));
  CHECK(r.objects[0].name == "a\xEF\xBF\xBD");
  CHECK(r.objects[1].name == "a\xEF\xBF\xBD 2");
  CHECK(r.objects[3].name == "object");
  CHECK(r.objects[4].name == "object 5");
  for (uint32_t i = 0; i < s.objects.size(); ++i) CHECK(r.characters[0].parts[i].object == i);
  CHECK(r.characters[0].name == "bad \xEF\xBF\xBD\xEF\xBF\xBD end");
}

TEST_CASE("write_scene: what cannot be written leaves what was there") {
  const test::TempFolder folder;
  const std::string path = folder.write("scene.json", "before");
  Scene s = full_scene(folder);
  s.camera.position.x = std::numeric_limits<double>::infinity();
  CHECK(write_scene(s, path).error().error_class == ErrorClass::scene);
  s = full_scene(folder);
  s.objects[0].file = folder.file("a\nb.nkd");
  CHECK(write_scene(s, path).error().error_class == ErrorClass::scene);
  CHECK(write_scene(full_scene(folder), folder.file("none/scene.json")).error().error_class == ErrorClass::output);
  CHECK(text_of(path) == "before");
}

TEST_CASE("a written scene is known as such until a byte of it changes") {
  const test::TempFolder folder;
  const std::string path = folder.file("scene.json");
  CHECK_FALSE(is_as_written(path));
  REQUIRE(write_scene(full_scene(folder), path));
  CHECK(is_as_written(path));
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  for (size_t i = 0; i < text.size(); ++i) {
    std::string changed = text;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    if (is_as_written(folder.write("changed.json", changed))) FAIL("byte " << i);
    if (is_as_written(folder.write("changed.json", text.substr(0, i)))) FAIL("length " << i);
  }
  CHECK_FALSE(is_as_written(folder.write("changed.json", text + "\n")));
  CHECK(parse_scene(text, path));
}

TEST_CASE("framing: every corner is on the film, and one nearly at its edge") {
  for (const Box3d& box : {Box3d{{0, 0, 0}, {1, 1, 1}}, Box3d{{-100, 0, 5}, {100, 1, 6}}, Box3d{{0, 0, 0}, {1, 50, 1}},
                           Box3d{{-3, 2, -3}, {3, 2, 3}}, Box3d{{1e6, 1e6, 1e6}, {1e6 + 1, 1e6 + 1, 1e6 + 1}},
                           Box3d{{-1e-12, 0, 0}, {1e-12, 1e-12, 1e-12}}, Box3d{{-1e12, 0, 0}, {1e12, 1e12, 1e12}}}) {
    for (const FilmSize film : {FilmSize{512, 512}, FilmSize{1920, 300}, FilmSize{100, 4000}}) {
      const Camera c = framing_camera(box, film);
      const Vec3d forward = normalised(c.target - c.position), right = normalised(cross(forward, c.up)),
                  up = cross(right, forward);
      const double slope = std::tan(c.vertical_fov_degrees / 2 * std::numbers::pi / 180);
      double widest = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p = Vec3d{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                              corner & 4 ? box.hi.z : box.lo.z} -
                        c.position;
        const double depth = dot(p, forward);
        REQUIRE(depth > 0);
        widest = std::max({widest, std::fabs(dot(p, up)) / (depth * slope),
                           std::fabs(dot(p, right)) / (depth * slope * film.width / film.height)});
      }
      CHECK(widest == doctest::Approx(0.9).epsilon(1e-6));
      CHECK(c.position.y > box.hi.y);
    }
  }
  for (const double far : {0.0, 1e9}) {
    const Camera c = framing_camera({{far, far, far}, {far, far, far}}, {});
    CHECK(length(c.target - c.position) > 0.999);
  }
}
