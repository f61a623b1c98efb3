// kdrender, from outside: what it refuses, in one line, leaving nothing behind.
#include <csignal>
#include <filesystem>

#include <doctest/doctest.h>

#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

namespace {

constexpr const char* kTool = "kdrender";

/// A scene of one quad; `head` and `part` go into the scene and into the part.
std::string quad_scene(const std::string& part, const std::string& head = "") {
  return "{\n  \"film\": {\"width\": 16, \"height\": 16},\n"
         "  \"camera\": {\"position\": [0, 2, 2], \"target\": [0, 0, 0]},\n"
         "  \"objects\": [{\"name\": \"quad\", \"file\": \"compiled/quad.nkd\"}],\n" +
         head + "  \"characters\": [{\"parts\": [\n    {" + part + "}\n  ]}]\n}\n";
}

const std::string kQuadPart = "\"object\": \"quad\"";

/// A folder with scene.json and its object.
class Studio : public Terminal {
 public:
  Studio() {
    compile_data("quad.obj");
    write("scene.json", quad_scene(kQuadPart));
  }
  void fails_with(const Arguments& more, ErrorClass error_class, const std::vector<std::string>& fragments) const {
    fails(kTool, joined({"scene.json"}, more), error_class, fragments);
  }
};

}  // namespace

TEST_SUITE("kdrender errors") {
  TEST_CASE("usage") {
    const Studio s;
    s.succeeds(kTool, {"scene.json", "-o", "warm.exr"});
    s.fails(kTool, {}, ErrorClass::usage, {});
    s.fails_with({}, ErrorClass::usage, {"--output"});
    s.fails_with({"-o", "o.exr", "--frob"}, ErrorClass::usage, {"--frob"});
    s.fails_with({"-o", "o.exr", "--aov", "depth,flavour"}, ErrorClass::usage, {"flavour", "depth", "bary"});
    s.fails_with({"-o", "o.exr", "--aov", "depth,"}, ErrorClass::usage, {"AOV ''"});
    for (const char* gamma : {"0", "-1", "11", "inf", "abc"}) {
      s.fails_with({"-o", "o.exr", "--gamma", gamma}, ErrorClass::usage, {"--gamma", gamma});
    }
    for (const char* device : {"nonsense", "cpu:1", "cuda:", "cuda:x", "CPU", ""}) {
      s.fails_with({"-o", "o.exr", "--device", device}, ErrorClass::usage, {"--device", device, "cuda:N"});
    }
    s.fails_with({"-o", "o.exr", "--device", "cuda:99"}, ErrorClass::device, {"--device cuda:99"});
  }

  TEST_CASE("an object whose vertices are float32") {
    const Studio s;
    s.succeeds("kdbuild", {"build", data_file("quad.obj"), "-o", "compiled/quad.nkd", "--vertices", "float32"});
    s.fails_with({"-o", "o.exr"}, ErrorClass::object, {"compiled/quad.nkd", "without --vertices float32"});
  }

  TEST_CASE("a gamma that is no number") {
    const Studio s;
    s.fails_with({"-o", "o.exr", "--gamma", "nan"}, ErrorClass::usage, {"--gamma", "nan"});
  }

  TEST_CASE("scenes that do not parse") {
    const Studio s;
    const auto fails = [&](const std::string& scene, const std::vector<std::string>& fragments) {
      s.write("scene.json", scene);
      s.write("o.exr", "what was there before");
      s.fails_with({"-o", "o.exr"}, ErrorClass::scene, fragments);
    };
    fails("", {"scene.json:1:1"});
    fails("not JSON", {"scene.json:1:1"});
    fails(quad_scene(kQuadPart, "  \"colour\": 1,\n"), {"scene.json:5:3", "colour"});
    fails(quad_scene(kQuadPart + ", \"scale\": \"big\""), {"scene.json:6:", "scale"});
    fails(quad_scene(kQuadPart + ", \"scale\": [1, 0, 1]"), {"scene.json:6:", "scale", "zero"});
    fails(quad_scene(kQuadPart) + "garbage", {"scene.json:9:1"});
    fails(quad_scene(kQuadPart).substr(0, 150), {"scene.json:"});
    fails(quad_scene("\"object\": \"quod\""), {"scene.json:6:", "quod", "quad"});
    fails(quad_scene(kQuadPart +
                     ", \"box\": {\"point\": [0,0,0], \"x_axis\": [1,0,0], \"y_axis\": [2,0,0], \"z_axis\": [0,0,1]}"),
          {"scene.json:6"});
    fails(quad_scene(kQuadPart, "  \"film\": {\"width\": 0},\n"), {"scene.json:5:"});
  }

  TEST_CASE("files that are not there, or not what they should be") {
    const Studio s;
    s.fails(kTool, {"gone.json", "-o", "o.exr"}, ErrorClass::missing, {"gone.json"});
    s.fails(kTool, {"compiled", "-o", "o.exr"}, ErrorClass::missing, {"compiled"});
    s.fails(kTool, {"compiled/quad.nkd", "-o", "o.exr"}, ErrorClass::scene, {"compiled/quad.nkd"});
    const std::string object = s.read("compiled/quad.nkd");
    s.write("compiled/quad.nkd", object.substr(0, object.size() / 2));
    s.fails_with({"-o", "o.exr"}, ErrorClass::object, {"compiled/quad.nkd", "NKD"});
    s.write("compiled/quad.nkd", "text");
    s.fails_with({"-o", "o.exr"}, ErrorClass::object, {"compiled/quad.nkd", "NKD101"});
    std::filesystem::remove(s.path("compiled/quad.nkd"));
    s.fails_with({"-o", "o.exr"}, ErrorClass::missing, {"compiled/quad.nkd"});
  }

  TEST_CASE("outputs that cannot be written") {
    const Studio s;
    for (const char* bad : {"gone/x", "scene.json/x", "compiled"}) {
      s.fails_with({"-o", bad}, ErrorClass::output, {bad});
      s.fails_with({"-o", "o.exr", "--preview", bad}, ErrorClass::output, {bad});
      s.fails_with({"-o", "o.exr", "--stats", bad}, ErrorClass::output, {bad});
    }
  }

  TEST_CASE("an output that is an input, or another output, is refused") {
    const auto refused = [](const Arguments& arguments, const char* name) {
      Studio().fails_with(arguments, ErrorClass::usage, {name});
    };
    refused({"-o", "scene.json"}, "scene.json");
    refused({"-o", "o.exr", "--preview", "o.exr"}, "o.exr");
    refused({"-o", "o.exr", "--stats", "o.exr"}, "o.exr");
    refused({"-o", "o.exr", "--preview", "compiled/quad.nkd"}, "compiled/quad.nkd");
  }

  TEST_CASE("an output without a name is refused before the render") {
    const Studio s;
    s.fails_with({"-o", "", "--quiet"}, ErrorClass::usage, {"--output", "file name"});
  }

  TEST_CASE("a full disk leaves what was there") {
    Studio s;
    s.set_up_spheres();
    s.write("o.exr", "what was there before");
    Conditions full;
    full.largest_file = 20000;
    s.fails(kTool, {"spheres.json", "-o", "o.exr", "--quiet"}, ErrorClass::output, {"o.exr"}, full);
  }

  TEST_CASE("interrupted, it says so and leaves nothing") {
    Studio s;
    s.set_up_spheres();
    auto scene = nlohmann::json::parse(s.read("spheres.json"));
    scene["film"] = {{"width", 3000}, {"height", 3000}};
    s.write("spheres.json", scene.dump());
    Conditions conditions;
    conditions.signal = SIGINT;
    conditions.signal_after = std::chrono::milliseconds(500);
    s.fails(kTool, {"spheres.json", "-o", "o.exr", "--device", "cpu"}, ErrorClass::interrupted, {}, conditions);
  }
}
