// Scene files: what is read from a good one, the defaults, and for each kind of bad one, where the error points.
#include "scene/parse_scene.h"

#include <limits>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace kd;
using namespace kd::scene;

namespace {

/// Every required field and nothing else.
const std::string kSmallest = R"({
  "camera": {"position": [0, 0, 5], "target": [0, 0, 0]},
  "objects": [{"name": "bay", "file": "compiled/bay.nkd"}],
  "characters": [{"parts": [{"object": "bay"}]}]
})";

/// Every field there is; the table below counts its lines and columns.
const std::string kFull = R"({
  "film": {"width": 960, "height": 540},
  "camera": {"position": [1, 2, 3], "target": [-1e3, 0.5, 0], "up": [0, 0, 1], "vertical_fov": 60},
  "background": [0.1, 0.2, 0.3], "ambient": [1, 1, 2.5],
  "lights": [
    {"kind": "point", "position": [4, 5, 6], "colour": [10, 10, 9]},
    {"kind": "directional", "direction": [0, -2, 0], "colour": [1, 1, 1]}
  ],
  "objects": [{"name": "bay", "file": "compiled/bay.nkd"}, {"name": "alt\u00e4r", "file": "/abs/altar.nkd"}],
  "characters": [
    {"name": "nave", "parts": [
      {"name": "bay 1 left", "object": "bay", "translate": [1, 0, 0], "rotate": {"axis": [0, 1, 0], "degrees": 90},
       "scale": [1, 1, -1]},
      {"object": "altär", "box": {"point": [1, 2, 3], "x_axis": [4, 0, 0], "y_axis": [0, 5, 0], "z_axis": [0, 0, 6]}}]},
    {"parts": [
      {"object": "bay", "material": {"diffuse": [1, 0, 0], "specular": [0.5, 0.5, 0.5], "shininess": 40, "emission": [0, 2, 0]}, "sides": "front"},
      {"object": "bay", "frame": {"point": [1, 2, 3], "x_axis": [0, 1, 0], "y_axis": [1, 1, 0], "z_axis": [0, 0, 2]}}]}
  ]
})";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, from);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("scene: the smallest scene has the documented defaults") {
  const auto scene = parse_scene(kSmallest, "shots/scene.json");
  REQUIRE_MESSAGE(scene, scene.error().line());
  CHECK(scene->path == "shots/scene.json");
  CHECK(scene->film.width == 512);
  CHECK(scene->film.height == 512);
  CHECK(scene->camera.up == Vec3d{0, 1, 0});
  CHECK(scene->camera.vertical_fov_degrees == 45);
  CHECK(scene->background == Vec3f{0, 0, 0});
  CHECK(scene->ambient == Vec3f{0, 0, 0});
  CHECK(scene->lights.empty());
  REQUIRE(scene->objects.size() == 1);
  CHECK(scene->objects[0].file == "shots/compiled/bay.nkd");
  const Part& part = scene->characters.at(0).parts.at(0);
  CHECK(part.name.empty());
  CHECK(part.object == 0);
  CHECK(part.line == 4);
  CHECK(!part.material);
  const auto& placement = std::get<TransformPlacement>(part.placement);
  CHECK(placement.translate == Vec3d{0, 0, 0});
  CHECK(placement.rotate_degrees == 0);
  CHECK(placement.scale == Vec3d{1, 1, 1});
}

TEST_CASE("scene: every field is read") {
  const auto scene = parse_scene(kFull, "scene.json");
  REQUIRE_MESSAGE(scene, scene.error().line());
  CHECK(scene->film.width == 960);
  CHECK(scene->film.height == 540);
  CHECK(scene->camera.position == Vec3d{1, 2, 3});
  CHECK(scene->camera.target == Vec3d{-1000, 0.5, 0});
  CHECK(scene->camera.up == Vec3d{0, 0, 1});
  CHECK(scene->camera.vertical_fov_degrees == 60);
  CHECK(scene->background == Vec3f{0.1f, 0.2f, 0.3f});
  CHECK(scene->ambient == Vec3f{1, 1, 2.5f});
  REQUIRE(scene->lights.size() == 2);
  CHECK(scene->lights[0].kind == LightKind::point);
  CHECK(scene->lights[0].position == Vec3d{4, 5, 6});
  CHECK(scene->lights[0].colour == Vec3f{10, 10, 9});
  CHECK(scene->lights[1].kind == LightKind::directional);
  CHECK(scene->lights[1].direction == Vec3d{0, -1, 0});
  REQUIRE(scene->objects.size() == 2);
  CHECK(scene->objects[0].file == "compiled/bay.nkd");
  CHECK(scene->objects[1].name == "altär");
  CHECK(scene->objects[1].file == "/abs/altar.nkd");

  REQUIRE(scene->characters.size() == 2);
  CHECK(scene->characters[0].name == "nave");
  REQUIRE(scene->characters[0].parts.size() == 2);
  const Part& left = scene->characters[0].parts[0];
  CHECK(left.name == "bay 1 left");
  CHECK(left.line == 12);
  const auto& transform = std::get<TransformPlacement>(left.placement);
  CHECK(transform.translate == Vec3d{1, 0, 0});
  CHECK(transform.rotate_axis == Vec3d{0, 1, 0});
  CHECK(transform.rotate_degrees == 90);
  CHECK(transform.scale == Vec3d{1, 1, -1});
  const Part& altar = scene->characters[0].parts[1];
  CHECK(altar.object == 1);
  CHECK(altar.line == 14);
  const Frame box = std::get<BoxPlacement>(altar.placement).box;
  CHECK(box.apply_point({1, 1, 1}) == Vec3d{5, 7, 9});
  const Part& painted = scene->characters[1].parts.at(0);
  CHECK(painted.line == 16);
  REQUIRE(painted.material);
  CHECK(*painted.material == Material{Material{}.ambient, {1, 0, 0}, {0.5f, 0.5f, 0.5f}, 40, {0, 2, 0}});
  CHECK(painted.sides == Sides::front);
  const Frame frame = std::get<FramePlacement>(scene->characters[1].parts.at(1).placement).frame;
  CHECK(frame.apply_point({1, 2, 3}) == Vec3d{3, 5, 9});
}

TEST_CASE("scene: a byte order mark and any white space are accepted") {
  const auto scene = parse_scene("\xEF\xBB\xBF\r\n\t" + kSmallest + "\r\n", "scene.json");
  REQUIRE_MESSAGE(scene, scene.error().line());
  CHECK(scene->characters[0].parts[0].line == 5);
}

namespace {

struct BadScene {
  const char* from;  // in kFull, replaced by `to`
  const char* to;
  const char* where;  // line:column
  const char* what;   // a part of the message
};

const BadScene kBadScenes[] = {
    // Not strict JSON.
    {"{\n  \"film\"", "[\n  \"film\"", "1:1", "the scene must be an object, {...}, not an array"},
    {"\"film\"", "film", "2:3", "expected a field's name in double quotes, not 'film'"},
    {"\"film\"", "'film'", "2:3", "single quote"},
    {"\"film\"", "// film\n\"film\"", "2:3", "comment"},
    {"540},", "540,},", "2:40", "expected a field's name"},
    {"540},", "540}", "3:3", "expected ',' or '}', not a string"},
    {"\"film\":", "\"film\"", "2:10", "expected ':' after 'film', not an object"},
    {"[1, 2, 3]", "[1, 2, 3,]", "3:35", "must be a number, not ']'"},
    {"[1, 2, 3]", "[1 2 3]", "3:29", "expected ',' or ']', not a number"},
    {"[1, 2, 3]", "[+1, 2, 3]", "3:27", "'position[0]' must be a number, not '+1'"},
    {"[1, 2, 3]", "[.5, 2, 3]", "3:27", "not '.5'"},
    {"[1, 2, 3]", "[5., 2, 3]", "3:27", "not '5'"},
    {"[1, 2, 3]", "[01, 2, 3]", "3:28", "expected ',' or ']', not a number"},
    {"[1, 2, 3]", "[0x10, 2, 3]", "3:28", "expected ',' or ']', not 'x10'"},
    {"[1, 2, 3]", "[nan, 2, 3]", "3:27", "not 'nan'"},
    {"[1, 2, 3]", "[-inf, 2, 3]", "3:27", "not '-inf'"},
    {"[1, 2, 3]", "[cos(0), 2, 3]", "3:27", "not 'cos'"},
    {"[1, 2, 3]", "[1e400, 2, 3]", "3:27", "must be a number that fits a double"},
    {"\"nave\"", "\"na\tve\"", "11:17", "control character"},
    {"\"nave\"", "\"na\\ve\"", "11:17", "unknown escape"},
    {"\"nave\"", "\"na\\ud800ve\"", "11:22", "surrogate"},
    {"\"nave\"", "\"na\xff\"", "11:18", "illegal UTF-8"},
    {"\"nave\"", "\"na\\u000ave\"", "11:14", "control characters"},
    // Of another shape than the schema's.
    {"\"width\": 960", "\"widht\": 960", "2:12", "unknown field 'widht': 'film' may have height, width"},
    {"\"film\"", "\"movie\"", "2:3", "unknown field 'movie': the scene may have"},
    {"\"height\"", "\"width\"", "2:26", "'width' is given twice"},
    {"{\"width\": 960, \"height\": 540}", "[960, 540]", "2:11", "'film' must be an object, {...}, not an array"},
    {"{\"width\": 960, \"height\": 540}", "null", "2:11", "not 'null'"},
    {"960", "\"960\"", "2:21", "'width' must be a whole number from 0 to 4294967295, not a string"},
    {"960", "960.5", "2:21", "not 960.5"},
    {"960", "-1", "2:21", "not -1"},
    {"960", "5000000000", "2:21", "not 5000000000"},
    {"960", "true", "2:21", "not 'true'"},
    {"\"vertical_fov\": 60", "\"vertical_fov\": \"60\"", "3:96", "'vertical_fov' must be a number, not a string"},
    {"\"vertical_fov\": 60", "\"vertical_fov\": null", "3:96", "not 'null'"},
    {"[1, 2, 3]", "[1, 2]", "3:26", "'position' must be an array of 3 numbers, not of 2"},
    {"[1, 2, 3]", "[1, 2, 3, 4]", "3:26", "not of 4"},
    {"[1, 2, 3]", "{\"x\": 1, \"y\": 2, \"z\": 3}", "3:26", "not an object"},
    {"[1, 2, 3]", "[\"1\", 2, 3]", "3:27", "'position[0]' must be a number, not a string"},
    {"\"position\": [1, 2, 3], ", "", "3:13", "'camera' lacks 'position'"},
    {", \"file\": \"compiled/bay.nkd\"", "", "9:15", "'objects[0]' lacks 'file'"},
    {"\"point\"", "\"area\"", "6:14", "'kind' must be \"point\" or \"directional\" or \"spot\", not \"area\""},
    {"\"point\"", "\"point directional\"", "6:14", "'kind' must be"},
    {"\"point\"", "1", "6:14", "not a number"},
    {"\"bay 1 left\"", "7", "12:16", "'name' must be a string, not a number"},
    // What the schema cannot say.
    {"960", "0", "2:21", "the film's width must be from 1 to 65536 pixels"},
    {"540", "65537", "2:36", "the film's height must be from 1 to 65536 pixels"},
    {"{\"width\": 960, \"height\": 540}", "{\"width\": 65536, \"height\": 4097}", "2:11", "more than 268435456 pixels"},
    {"[-1e3, 0.5, 0]", "[1, 2, 3]", "3:47", "target is its position"},
    {"[-1e3, 0.5, 0]", "[1, 2, 4]", "3:64", "parallel"},
    {"[0, 0, 1]", "[0, 0, 0]", "3:69", "'up' is zero or parallel"},
    {"\"vertical_fov\": 60", "\"vertical_fov\": 180", "3:96", "less than 180"},
    {"\"vertical_fov\": 60", "\"vertical_fov\": -0.0", "3:96", "more than 0"},
    {"[0.1, 0.2, 0.3]", "[0.1, -0.2, 0.3]", "4:17", "from 0 to 3.4e38"},
    {"[0.1, 0.2, 0.3]", "[0.1, 1e39, 0.3]", "4:17", "from 0 to 3.4e38"},
    {"\"kind\": \"point\", ", "", "6:5", "the light lacks 'kind'"},
    {"\"position\": [4, 5, 6], ", "", "6:5", "a point light needs a 'position'"},
    {"\"direction\"", "\"position\"", "7:41", "a directional light has no 'position'"},
    {"[0, -2, 0]", "[0, 0, 0]", "7:42", "must not be zero"},
    {"\"point\"", "\"spot\"", "6:5", "a spot light needs a 'direction'"},
    {"[10, 10, 9]", "[10, 10, 9], \"inner_angle\": 5", "6:84", "a point light has no 'inner_angle'"},
    {"[10, 10, 9]", "[10, 10, 9], \"reach\": 0", "6:78", "'reach' must be more than 0"},
    {"[10, 10, 9]", "[10, 10, 9], \"falloff\": \"linear\"", "6:80", "'falloff' must be \"none\" or \"inverse_square\""},
    {"[1, 1, 1]}", "[1, 1, 1], \"reach\": 5}", "7:84", "a directional light has no 'reach'"},
    {"[1, 1, 1]}", "[1, 1, 1], \"falloff\": \"inverse_square\"}", "7:86", "a directional light has no 'falloff'"},
    {"[10, 10, 9]", "[10, 10, -9]", "6:56", "from 0 to"},
    {"\"alt\\u00e4r\"", "\"bay\"", "9:69", "two objects 'bay'"},
    {"\"name\": \"bay\"", "\"name\": \"\"", "9:24", "'name' must not be empty"},
    {"\"object\": \"bay\"", "\"object\": \"bey\"", "12:40", "there is no object 'bey': the scene has bay, altär"},
    {"[1, 1, -1]", "[1, 0, -1]", "13:17", "'scale' may be zero"},
    {"[0, 1, 0], \"degrees\"", "[0, 0, 0], \"degrees\"", "12:90", "'axis' must not be zero"},
    {", \"degrees\": 90", "", "12:81", "lacks 'degrees'"},
    {"\"box\": {", "\"scale\": [1, 1, 1], \"box\": {", "14:37", "'scale' does not go with 'box'"},
    {"\"frame\": {", "\"translate\": [1, 1, 1], \"frame\": {", "17:38", "'translate' does not go with 'frame'"},
    {"\"box\": {",
     "\"frame\": {\"point\": [0, 0, 0], \"x_axis\": [1, 0, 0], \"y_axis\": [0, 1, 0], \"z_axis\": [0, 0, 1]}, \"box\": "
     "{",
     "14:37", "'frame' does not go with 'box'"},
    {", \"z_axis\": [0, 0, 2]", "", "17:34", "'frame' lacks 'z_axis'"},
    {"\"shininess\": 40", "\"shininess\": -1", "16:102", "'shininess' must be from 0"},
    {"\"sides\": \"front\"", "\"sides\": \"back\"", "16:139", "\"both\" or \"front\""},
    {"\"emission\": [0,", "\"emission\": [-1,", "16:118", "from 0 to"},
    {"\"diffuse\": [1, 0, 0]", "\"diffuse\": [1, -1, 0]", "16:49", "from 0 to"},
};

}  // namespace

TEST_CASE("scene: every error says what is wrong and where") {
  for (const BadScene& bad : kBadScenes) {
    CAPTURE(std::string(bad.from));
    CAPTURE(std::string(bad.to));
    const auto scene = parse_scene(replaced(kFull, bad.from, bad.to), "dir/scene.json");
    REQUIRE(!scene);
    CHECK(scene.error().error_class == ErrorClass::scene);
    CHECK(scene.error().where == fmt::format("dir/scene.json:{}", bad.where));
    CHECK_MESSAGE(scene.error().what.find(bad.what) != std::string::npos, scene.error().what);
  }
}

TEST_CASE("scene: spot lights, falloff and reach") {
  const auto read = [](const std::string& light) {
    return parse_scene(
        replaced(kSmallest, "\"objects\"", "\"lights\": [{\"colour\": [1, 1, 1], " + light + "}],\n\"objects\""), "s");
  };
  const std::string spot = R"("kind": "spot", "position": [1, 2, 3], "direction": [0, 0, 2])";
  const auto full = read(spot + R"(, "inner_angle": 10, "outer_angle": 20.5, "falloff": "inverse_square", "reach": 7)");
  REQUIRE(full);
  const Light& light = full->lights.at(0);
  CHECK(light.kind == LightKind::spot);
  CHECK(light.position == Vec3d{1, 2, 3});
  CHECK(light.direction == Vec3d{0, 0, 1});
  CHECK(light.inner_degrees == 10);
  CHECK(light.outer_degrees == 20.5);
  CHECK(light.falloff == Falloff::inverse_square);
  CHECK(light.reach == 7);
  const auto point = read(R"("kind": "point", "position": [0, 0, 0])");
  REQUIRE(point);
  CHECK(point->lights[0].falloff == Falloff::none);
  CHECK(point->lights[0].reach == std::numeric_limits<double>::infinity());
  CHECK(read(spot + R"(, "inner_angle": 0, "outer_angle": 180)"));
  CHECK(read(spot + R"(, "inner_angle": 30, "outer_angle": 30)"));
  const auto error_of = [&](const std::string& angles) {
    const auto bad = read(spot + angles);
    REQUIRE(!bad);
    return bad.error().what;
  };
  CHECK(error_of("") == "a spot light needs an 'inner_angle' and an 'outer_angle'");
  CHECK(error_of(R"(, "inner_angle": 5)") == "a spot light needs an 'inner_angle' and an 'outer_angle'");
  CHECK(error_of(R"(, "inner_angle": 31, "outer_angle": 30)") == "'inner_angle' must be from 0 to 'outer_angle'");
  CHECK(error_of(R"(, "inner_angle": -1, "outer_angle": 30)") == "'inner_angle' must be from 0 to 'outer_angle'");
  CHECK(error_of(R"(, "inner_angle": 0, "outer_angle": 0)") ==
        "'outer_angle' must be more than 0 and at most 180 degrees");
  CHECK(error_of(R"(, "inner_angle": 0, "outer_angle": 181)") ==
        "'outer_angle' must be more than 0 and at most 180 degrees");
}

TEST_CASE("scene: texts that are no scene at all") {
  const auto error_of = [](const std::string& text) {
    const auto scene = parse_scene(text, "s");
    REQUIRE(!scene);
    return scene.error().line();
  };
  CHECK(error_of("") == "s:1:1: the scene must be an object, {...}, not the end of the file");
  CHECK(error_of("{}") == "s:1:1: the scene lacks 'camera'");
  CHECK(error_of("{\"objects\": [") == "s:1:14: 'objects[0]' must be an object, {...}, not the end of the file");
  CHECK(error_of("{\"film") == "s:1:2: this string does not end");
  CHECK(error_of(kSmallest + "{}") == "s:5:2: an object after the end of the scene");
  CHECK(error_of(kSmallest + std::string(1, '\0') + "junk") == "s:5:2: byte 0x00 after the end of the scene");
  CHECK(error_of(std::string(100000, '[')).starts_with("s:1:1:"));
  CHECK(error_of("{\"background\": " + std::string(100000, '[')).starts_with("s:1:17:"));
  CHECK(error_of(replaced(kSmallest, "{\"object\": \"bay\"}", "")).starts_with("s:4:28: the character has no parts"));
  CHECK(error_of(replaced(kSmallest, "{\"parts\": [{\"object\": \"bay\"}]}", ""))
            .starts_with("s:4:17: the scene has no characters"));
  CHECK(error_of(replaced(kSmallest, "{\"name\": \"bay\", \"file\": \"compiled/bay.nkd\"}", ""))
            .starts_with("s:3:14: the scene has no objects"));
  CHECK(error_of(std::string(kMaxSceneBytes + 1, ' ')) == "s:1:1: a scene has at most 134217728 bytes");
}

TEST_CASE("scene: with a library, what no object is named is a file in it, looked for once") {
  const std::string objects = "\"objects\": [{\"name\": \"bay\", \"file\": \"compiled/bay.nkd\"}]";
  const std::string parts = "{\"object\": \"bay\"}, {\"object\": \"trees/oak\"}, {\"object\": \"trees/oak\"}";
  const std::string json = replaced(kSmallest, "{\"object\": \"bay\"}", parts);
  const auto scene = parse_scene(replaced(json, objects, "\"library\": \"stones\", " + objects), "at/s");
  REQUIRE_MESSAGE(scene, (scene ? "" : scene.error().line()));
  REQUIRE(scene->objects.size() == 2);
  CHECK(scene->objects[0].file == "at/compiled/bay.nkd");
  CHECK(scene->objects[1].name == "trees/oak");
  CHECK(scene->objects[1].file == "at/stones/trees/oak.nkd");
  CHECK(scene->characters[0].parts[1].object == 1);
  CHECK(scene->characters[0].parts[2].object == 1);

  const auto all = parse_scene(replaced(json, objects, "\"library\": \"/stones\""), "at/s");
  REQUIRE_MESSAGE(all, (all ? "" : all.error().line()));
  REQUIRE(all->objects.size() == 2);
  CHECK(all->objects[0].file == "/stones/bay.nkd");
  CHECK(all->library == "/stones");

  const auto error_of = [](const std::string& text) {
    const auto bad = parse_scene(text, "s");
    return bad ? std::string() : bad.error().line();
  };
  CHECK(error_of(replaced(kSmallest, objects, "\"library\": \"\"")).ends_with("'library' must not be empty"));
  CHECK(error_of(replaced(kSmallest, objects + ",", "")) == "s:1:1: the scene lacks 'objects', or a 'library'");
  CHECK(
      error_of(replaced(replaced(kSmallest, objects, "\"library\": \"l\""), "\"object\": \"bay\"", "\"object\": \"\""))
          .ends_with("'object' must not be empty"));
}

TEST_CASE("scene: a file that cannot be read is missing, not bad") {
  const auto scene = read_scene("/nonexistent/scene.json");
  REQUIRE(!scene);
  CHECK(scene.error().error_class == ErrorClass::missing);
  CHECK(read_scene("/tmp").error().error_class == ErrorClass::missing);
}
