// kdrender, from outside: what it renders and tells. (What it refuses: kdrender_errors.cpp.)
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <doctest/doctest.h>

#include "cli/json_schema.h"
#include "cli/run_tool.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

using namespace kd;
using namespace kd::test;
using nlohmann::json;

namespace {

constexpr const char* kTool = "kdrender";
constexpr const char* kAllAovs = "depth,normal,position,object,instance,primitive,bary,visits";

struct Exr {
  int width = 0, height = 0;
  std::vector<float> green;
  std::set<std::string> channels;
  std::optional<float> gamma;
};

Exr read_exr(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  Exr exr;
  exr.width = header.dataWindow().max.x + 1;
  exr.height = header.dataWindow().max.y + 1;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) exr.channels.insert(c.name());
  if (const auto* gamma = header.findTypedAttribute<Imf::FloatAttribute>("gamma")) exr.gamma = gamma->value();
  exr.green.resize(static_cast<size_t>(exr.width) * static_cast<size_t>(exr.height));
  Imf::FrameBuffer frame;
  frame.insert("G", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(exr.green.data()), sizeof(float),
                               sizeof(float) * static_cast<size_t>(exr.width)));
  file.setFrameBuffer(frame);
  file.readPixels(0, exr.height - 1);
  return exr;
}

/// The words of all channels, one after the other; a header has times.
std::string read_pixels(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const auto width = static_cast<size_t>(window.max.x + 1), height = static_cast<size_t>(window.max.y + 1);
  std::string bytes;
  const Imf::ChannelList& channels = file.header().channels();
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    std::string channel(4 * width * height, '\0');
    Imf::FrameBuffer frame;
    frame.insert(c.name(), Imf::Slice(c.channel().type, channel.data(), 4, 4 * width));
    file.setFrameBuffer(frame);
    file.readPixels(0, window.max.y);
    bytes += channel;
  }
  return bytes;
}

/// data/spheres.json at 96 x 64, with changes.
json small_spheres(const Terminal& t) {
  json scene = json::parse(t.read("spheres.json"));
  scene["film"] = {{"width", 96}, {"height", 64}};
  return scene;
}

json rendered(const Terminal& t, const json& scene, const Arguments& more = {}) {
  t.write("scene.json", scene.dump(1));
  json report = t.report(kTool, joined({"scene.json", "-o", "o.exr", "--device", "cpu", "--stats", "-"}, more));
  check_report("kdrender-stats", report);
  return report;
}

bool ran(const json& report, const std::string& stage) {
  return std::any_of(report["stages"].begin(), report["stages"].end(),
                     [&](const json& s) { return s["stage"] == stage; });
}

}  // namespace

TEST_SUITE("kdrender") {
  TEST_CASE("spheres, end to end") {
    Terminal t;
    t.set_up_spheres();
    const ToolRun run = t.succeeds(kTool, {"spheres.json", "-o", "o.exr", "--preview", "p.png", "--aov", kAllAovs,
                                           "--stats", "s.json", "--device", "cpu"});
    CHECK(run.out.starts_with("spheres.json: on CPU"));
    CHECK(run.out.find("512 x 512") != std::string::npos);

    const auto report = json::parse(t.read("s.json"));
    check_report("kdrender-stats", report);
    CHECK(report["counts"]["objects"] == 3);
    CHECK(report["counts"]["instances"] == 5);
    CHECK(report["counts"]["triangles_as_seen"] == 2 + 12 + 3 * 1280);
    CHECK(report["rays"]["primary"] == 512 * 512);
    CHECK(report["skipped"]["aov_buffers"] == 0);
    CHECK(ran(report, "shadow, colour"));

    const std::set<std::string> channels{
        "R",   "G",   "B",        "A",          "Z",           "N.X",    "N.Y",    "N.Z",          "P.X",
        "P.Y", "P.Z", "objectId", "instanceId", "primitiveId", "bary.u", "bary.v", "visits.nodes", "visits.triangles"};
    const Exr exr = read_exr(t.path("o.exr"));
    CHECK(exr.width == 512);
    CHECK(exr.height == 512);
    CHECK(exr.channels == channels);
    CHECK(std::all_of(exr.green.begin(), exr.green.end(), [](float g) { return g >= 0 && std::isfinite(g); }));
    if (const auto listed = system_output("exrinfo", "-a -v " + t.path("o.exr"))) {
      for (const std::string& channel : channels)
        CHECK_MESSAGE(listed->find("'" + channel + "'") != std::string::npos, channel << *listed);
    }

    int width = 0, height = 0, components = 0;
    stbi_uc* pixels = stbi_load(t.path("p.png").c_str(), &width, &height, &components, 3);
    REQUIRE(pixels);
    CHECK(width == 512);
    CHECK(height == 512);
    const std::set<stbi_uc> values(pixels, pixels + 3 * width * height);
    stbi_image_free(pixels);
    CHECK(values.size() > 50);
  }

  TEST_CASE("only what is asked for is in the EXR") {
    Terminal t;
    t.set_up_spheres();
    rendered(t, small_spheres(t));
    CHECK(read_exr(t.path("o.exr")).channels == std::set<std::string>{"A", "B", "G", "R"});
    const json report = rendered(t, small_spheres(t), {"--aov", "depth"});
    CHECK(read_exr(t.path("o.exr")).channels == std::set<std::string>{"A", "B", "G", "R", "Z"});
    CHECK(report["skipped"]["aov_buffers"] == 7);
  }

  TEST_CASE("gamma is the preview's, and the EXR's only if asked") {
    Terminal t;
    t.set_up_spheres();
    const json scene = small_spheres(t);
    rendered(t, scene, {"--preview", "p.png"});
    const std::string preview = t.read("p.png");
    const Exr before = read_exr(t.path("o.exr"));
    CHECK(!before.gamma);
    rendered(t, scene, {"--preview", "p.png", "--gamma", "1.0"});
    CHECK(read_exr(t.path("o.exr")).green == before.green);
    CHECK(!read_exr(t.path("o.exr")).gamma);
    CHECK(t.read("p.png") != preview);
    rendered(t, scene, {"--gamma-exr", "--gamma", "2"});
    const Exr after = read_exr(t.path("o.exr"));
    REQUIRE(after.gamma);
    CHECK(*after.gamma == 2);
    for (size_t i = 0; i < before.green.size(); i += 97) {
      CHECK(after.green[i] == doctest::Approx(std::sqrt(before.green[i])).epsilon(1e-5));
    }
  }

  TEST_CASE("the same image for any number of threads") {
    Terminal t;
    t.set_up_spheres();
    std::set<std::string> images;
    for (const char* threads : {"1", "8", "8"}) {
      t.succeeds(kTool, {"spheres.json", "-o", "o.exr", "--aov", kAllAovs, "--threads", threads, "--device", "cpu"});
      images.insert(read_pixels(t.path("o.exr")));
    }
    CHECK(images.size() == 1);
  }

  TEST_CASE("no lights, no shadow stage") {
    Terminal t;
    t.set_up_spheres();
    json scene = small_spheres(t);
    scene.erase("lights");
    const json report = rendered(t, scene);
    CHECK(!ran(report, "shadow, colour"));
    CHECK(report["rays"]["shadow"] == 0);
    CHECK(report["counts"]["lights"] == 0);
    CHECK(report["rays"]["primary_hits"] > 0);
  }

  TEST_CASE("a black light is none") {
    Terminal t;
    t.set_up_spheres();
    json scene = small_spheres(t);
    scene.erase("lights");
    rendered(t, scene);
    const Exr dark = read_exr(t.path("o.exr"));
    scene["lights"] = {{{"kind", "point"}, {"position", {0, 5, 0}}, {"colour", {0, 0, 0}}}};
    const json report = rendered(t, scene);
    CHECK(report["skipped"]["black_lights"] == 1);
    CHECK(!ran(report, "shadow, colour"));
    CHECK(report["rays"]["shadow"] == 0);
    CHECK(read_exr(t.path("o.exr")).green == dark.green);
  }

  TEST_CASE("a view of nothing") {
    Terminal t;
    t.set_up_spheres();
    json scene = small_spheres(t);
    scene["camera"] = {{"position", {0, 2, 6}}, {"target", {0, 9, 6.1}}};
    const json report = rendered(t, scene);
    CHECK(report["rays"]["primary_hits"] == 0);
    CHECK(!ran(report, "shadow, colour"));
    CHECK(report["counts"]["instances"] == 0);
    CHECK(report["skipped"]["objects_not_loaded"] == 3);
    CHECK(report["skipped"]["instances_not_loaded"] == scene["characters"][0]["parts"].size());
    CHECK(report["bytes"]["objects"] == 0);
  }

  TEST_CASE("what a film does not show is checked by --check alone") {
    Terminal t;
    t.set_up_spheres();
    json scene = small_spheres(t);
    t.write("away.json", scene.dump());
    const std::string name = "compiled/icosphere.nkd";
    std::string bytes = t.read(name);
    bytes[bytes.size() / 2] ^= 1;  // in a section
    t.write(name, bytes);
    t.fails(kTool, {"away.json", "--check"}, ErrorClass::object, {name});
    t.fails(kTool, {"away.json", "-o", "o.exr"}, ErrorClass::object, {name});
    scene["camera"] = {{"position", {0, 2, 6}}, {"target", {0, 9, 6.1}}};
    t.write("away.json", scene.dump());
    t.succeeds(kTool, {"away.json", "-o", "o.exr"});
    t.fails(kTool, {"away.json", "--check"}, ErrorClass::object, {name});
  }

  TEST_CASE("an unused object is not opened") {
    Terminal t;
    t.set_up_spheres();
    json scene = small_spheres(t);
    scene["objects"].push_back({{"name", "unused"}, {"file", "no/such/file.nkd"}});
    const json report = rendered(t, scene);
    CHECK(report["skipped"]["objects_not_opened"] == 1);
    CHECK(report["counts"]["objects"] == 3);
  }

  TEST_CASE("auto says which device and why") {
    Terminal t;
    t.set_up_spheres();
    const auto report = t.report(kTool, {"spheres.json", "-o", "o.exr", "--stats", "-"});
    check_report("kdrender-stats", report);
    CHECK(report["device"]["description"] != "");
    CHECK(report["device"]["reason"] != "");
    const std::string text = t.succeeds(kTool, {"spheres.json", "-o", "o.exr"}).out;
    CHECK(text.find("on " + report["device"]["description"].get<std::string>()) != std::string::npos);
    CHECK(text.find(report["device"]["reason"].get<std::string>()) != std::string::npos);
    CHECK(t.succeeds(kTool, {"spheres.json", "-o", "o.exr", "--quiet"}).out == "");
  }

  TEST_CASE("--help tells of every option") {
    const Terminal t;
    const std::string help = t.succeeds(kTool, {"--help"}).out;
    for (const char* option : {"scene", "--output", "--preview", "--device", "--aov", "--gamma", "--gamma-exr",
                               "--stats", "--threads", "--quiet", "--version", "Exit status", "bary"}) {
      CHECK_MESSAGE(help.find(option) != std::string::npos, option);
    }
  }
}
