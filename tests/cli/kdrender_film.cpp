// kdrender, from outside: films of frames, values set from the command line, and what the headers say.
#include <fstream>

#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <doctest/doctest.h>

#include "cli/run_tool.h"
#include "image/compare.h"

using namespace kd;
using namespace kd::test;
using nlohmann::json;

namespace {

constexpr const char* kTool = "kdrender";

/// spheres.json with a camera that moves, a sphere that turns and a light that goes out, frames 1 to 11.
class Studio : public Terminal {
 public:
  Studio() {
    set_up_spheres();
    json scene = json::parse(read("spheres.json"));
    scene["film"] = {{"width", 40}, {"height", 30}};
    json& camera = scene["camera"];
    json away = camera["position"];
    away[0] = away[0].get<double>() + 2;
    camera["keys"] = {{{"frame", 1}, {"position", camera["position"]}}, {{"frame", 11}, {"position", away}}};
    json& light = scene["lights"][0];
    light["keys"] = {{{"frame", 1}, {"colour", light["colour"]}}, {{"frame", 9}, {"colour", {0, 0, 0}}}};
    json& part = scene["characters"][0]["parts"].back();
    part["keys"] = {{{"frame", 1}, {"rotate", {{"axis", {0, 1, 0}}, {"degrees", 0}}}},
                    {{"frame", 11}, {"rotate", {{"axis", {0, 1, 0}}, {"degrees", 90}}}}};
    part.erase("box");
    write("film.json", scene.dump(1));
  }
  ToolRun film(const Arguments& more) const { return succeeds(kTool, joined({"film.json", "--device", "cpu"}, more)); }
  void refuses(const Arguments& more, ErrorClass error_class, const std::vector<std::string>& fragments) const {
    fails(kTool, joined({"film.json", "--device", "cpu"}, more), error_class, fragments);
  }
};

}  // namespace

TEST_SUITE("kdrender film") {
  TEST_CASE("a frame of a film is that frame alone, to the bit") {
    const Studio s;
    s.film({"-o", "f.###.exr", "--preview", "f.###.png", "--frames", "1-11x2"});
    for (const char* frame : {"001", "003", "005", "007", "009", "011"}) {
      CHECK(s.exists(std::string("f.") + frame + ".exr"));
      CHECK(s.exists(std::string("f.") + frame + ".png"));
    }
    CHECK_FALSE(s.exists("f.002.exr"));
    for (const char* frame : {"1", "5", "9", "11"}) {
      const ToolRun alone = s.film({"--frames", frame, "--compare", "f.###.exr"});
      CHECK(alone.out.find(": 0 pixels differ") != std::string::npos);
    }
    const auto first = image::read_exr_colour(s.path("f.001.exr")), fifth = image::read_exr_colour(s.path("f.005.exr"));
    CHECK(image::compare_colour(*first, *fifth).pixels > 100);
  }

  TEST_CASE("resuming leaves out what is done, and only that") {
    const Studio s;
    s.film({"-o", "f.#.exr", "--frames", "1-3"});
    std::filesystem::remove(s.path("f.2.exr"));
    const std::string first = s.read("f.1.exr"), third = s.read("f.3.exr");
    s.write("f.3.exr", third.substr(0, third.size() - 100));
    const ToolRun again = s.film({"-o", "f.#.exr", "--frames", "1-4", "--resume"});
    CHECK(again.out.find("1 frames were there") != std::string::npos);
    CHECK(s.read("f.1.exr") == first);
    CHECK(image::read_exr_colour(s.path("f.3.exr")));
    CHECK(s.exists("f.4.exr"));
    const auto skipped = [&](const Arguments& more) {
      return s.film(joined({"-o", "f.#.exr", "--frames", "1-4", "--resume"}, more)).out.find("4 frames were there") !=
             std::string::npos;
    };
    CHECK(skipped({}));
    CHECK(skipped({"--threads", "1"}));
    CHECK_FALSE(skipped({"--preview", "p.#.png"}));
    CHECK(skipped({"--preview", "p.#.png"}));
    CHECK_FALSE(skipped({"--spp", "2"}));
    CHECK(skipped({"--spp", "2"}));
    CHECK_FALSE(skipped({"--spp", "2", "--set", "camera.vertical_fov=30"}));
    s.succeeds("kdbuild", {"build", data_file("icosphere.ply"), "-o", "compiled/icosphere.nkd", "--bits", "9"});
    CHECK_FALSE(skipped({"--spp", "2", "--set", "camera.vertical_fov=30"}));
  }

  TEST_CASE("what cannot be a film") {
    const Studio s;
    for (const char* frames :
         {"", "a", "3-1", "1-", "1-4x0", "1-4x-1", "1 - 4", "1-2-3", "1.5", "0-1000000", "99999999999"}) {
      if (*frames) s.refuses({"-o", "f.#.exr", "--frames", frames}, ErrorClass::usage, {"--frames", frames, "1-240x2"});
    }
    s.refuses({"-o", "f.exr", "--frames", "1-2"}, ErrorClass::usage, {"f.exr", "####"});
    s.refuses({"-o", "f.#.exr", "--preview", "p.png", "--frames", "1-2"}, ErrorClass::usage, {"p.png", "####"});
    s.refuses({"--resume", "--check"}, ErrorClass::usage, {"--resume"});
    s.refuses({"-o", "f.#.exr", "--resume", "--compare", "r.exr"}, ErrorClass::usage, {"--compare"});
    s.refuses({"-o", "f.#.exr", "--frames", "1-2", "--compare", "r.exr"}, ErrorClass::usage, {"r.exr", "####"});
    s.refuses({"-o", "f.exr", "--compare", "none.exr"}, ErrorClass::missing, {"none.exr"});
    s.refuses({"--check", "--stats", "s.json"}, ErrorClass::usage, {"--check"});
    s.film({"-o", "f.#.exr", "--frames", "-2--1"});
    CHECK(s.exists("f.-1.exr"));
  }

  TEST_CASE("values of the scene can be set") {
    const Studio s;
    const ToolRun wide =
        s.succeeds(kTool, {"--set", "film.width=123", "film.json", "--check", "--set", "film.height=45"});
    CHECK(wide.out.find("123 x 45") != std::string::npos);
    s.refuses({"--check", "--set", "camera.fov=3"}, ErrorClass::usage, {"camera.fov=3"});
    s.refuses({"--check", "--set", "camera.vertical_fov"}, ErrorClass::usage, {"camera.vertical_fov"});
    s.refuses({"--check", "--set", "lights[7].colour=[1,1,1]"}, ErrorClass::usage, {"lights[7]"});
    s.refuses({"--check", "--set", "camera.vertical_fov=fast"}, ErrorClass::usage, {"fast"});
  }

  TEST_CASE("a header says what the picture is") {
    const Studio s;
    s.film({"-o", "f.exr", "--frames", "11", "--spp", "3"});
    Imf::InputFile file(s.path("f.exr").c_str());
    const Imf::Header& header = file.header();
    REQUIRE(Imf::hasWorldToCamera(header));
    REQUIRE(Imf::hasWorldToNDC(header));
    CHECK(Imf::hasChromaticities(header));
    CHECK(header.typedAttribute<Imf::DoubleAttribute>("samples").value() == 3);
    CHECK(header.typedAttribute<Imf::DoubleAttribute>("frame").value() == 11);
    CHECK(header.typedAttribute<Imf::DoubleAttribute>("renderSeconds").value() > 0);
    CHECK(header.typedAttribute<Imf::StringAttribute>("device").value().starts_with("CPU"));
    for (const char* hash : {"sceneHash", "objectsHash", "fingerprint"}) {
      CHECK(header.typedAttribute<Imf::StringAttribute>(hash).value().size() == 16);
    }
    const json scene = json::parse(s.read("film.json"));
    const auto vector = [](const json& v) { return Imath::V3f(v[0], v[1], v[2]); };
    const Imath::V3f position = vector(scene["camera"]["keys"][1]["position"]);
    const Imath::V3f target = vector(scene["camera"]["target"]);
    Imath::V3f seen;
    Imf::worldToCamera(header).multVecMatrix(position, seen);
    CHECK(seen.length() < 1e-4f);
    Imf::worldToCamera(header).multVecMatrix(target, seen);
    CHECK(std::hypot(seen.x, seen.y) < 1e-4f);
    CHECK(seen.z == doctest::Approx(-(target - position).length()).epsilon(1e-5));
    Imf::worldToNDC(header).multVecMatrix(target, seen);
    CHECK(seen.x == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(seen.y == doctest::Approx(0.5).epsilon(1e-4));
  }

  TEST_CASE("worldToNDC is where a pixel's hit lies in the picture") {
    const Studio s;
    s.film({"-o", "f.exr", "--aov", "position"});
    Imf::InputFile file(s.path("f.exr").c_str());
    const int width = 40, height = 30;
    std::vector<float> p[3];
    Imf::FrameBuffer frame;
    for (int c = 0; c < 3; ++c) {
      p[c].resize(size_t{40} * 30);
      frame.insert(std::string("P.") + "XYZ"[c],
                   Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(p[c].data()), 4, 4 * width));
    }
    file.setFrameBuffer(frame);
    file.readPixels(0, height - 1);
    int seen = 0, wrong = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<size_t>(y * width + x);
        if (p[0][i] == 0 && p[1][i] == 0 && p[2][i] == 0) continue;
        Imath::V3f at;
        Imf::worldToNDC(file.header()).multVecMatrix(Imath::V3f(p[0][i], p[1][i], p[2][i]), at);
        wrong += std::fabs(at.x * width - (static_cast<float>(x) + 0.5f)) > 1e-3f ||
                 std::fabs(at.y * height - (static_cast<float>(y) + 0.5f)) > 1e-3f;
        ++seen;
      }
    }
    CHECK(seen > 100);
    CHECK(wrong == 0);
  }
}
