// kdrender, from outside: what is looked at, and how. Size, crop, samples, heatmap, comparison, check.
#include <doctest/doctest.h>

#include "cli/run_tool.h"
#include "image/compare.h"

using namespace kd;
using namespace kd::test;
using nlohmann::json;

namespace {

constexpr const char* kTool = "kdrender";

/// A folder with spheres.json, and kdrender on the CPU in it.
class Studio : public Terminal {
 public:
  Studio() { set_up_spheres(); }

  image::Film film(const Arguments& more) const {
    succeeds(kTool, joined({"spheres.json", "-o", "o.exr", "--device", "cpu", "--quiet"}, more));
    auto film = image::read_exr_colour(path("o.exr"));
    REQUIRE(film);
    return std::move(*film);
  }
  void refuses(const Arguments& more, ErrorClass error_class, const std::vector<std::string>& fragments) const {
    fails(kTool, joined({"spheres.json", "--device", "cpu"}, more), error_class, fragments);
  }
};

}  // namespace

TEST_SUITE("kdrender view") {
  TEST_CASE("a crop is that part of the film, samples included") {
    const Studio s;
    const image::Film whole = s.film({"--size", "61x43", "--spp", "3"});
    const image::Film part = s.film({"--size", "61x43", "--spp", "3", "--crop", "10,20,31,17"});
    CHECK(whole.width == 61);
    CHECK(whole.height == 43);
    CHECK(part.width == 31);
    CHECK(part.height == 17);
    CHECK(part.column == 10);
    CHECK(part.row == 20);
    CHECK(part.picture_width == 61);
    CHECK(part.picture_height == 43);
    size_t differing = 0;
    for (size_t row = 0; row < 17; ++row) {
      for (size_t i = 0; i < 4 * 31; ++i) {
        differing += part.colour[4 * 31 * row + i] != whole.colour[4 * (61 * (row + 20) + 10) + i];
      }
    }
    CHECK(differing == 0);
    for (const char* crop : {"", "0", "0,0,10", "0,0,0,5", "0,0,5,0", "60,0,2,1", "0,43,1,1", "-1,0,1,1", "0,0,1,1,1",
                             "0,0,4294967295,1", "a,0,1,1"}) {
      if (*crop) s.refuses({"--size", "61x43", "--check", "--crop", crop}, ErrorClass::usage, {"--crop", crop});
    }
    for (const char* size : {"0x1", "1x0", "61", "61x", "x43", "70000x1", "65536x65536", "1x1x1", "61 x 43"}) {
      s.refuses({"--check", "--size", size}, ErrorClass::usage, {"--size", size, "1920x1080"});
    }
    for (const char* count : {"0", "65537", "1.5"}) {
      s.refuses({"--check", "--spp", count}, ErrorClass::usage, {"--spp", count});
    }
  }

  TEST_CASE("a comparison says by its status whether pictures differ") {
    const Studio s;
    const image::Film film = s.film({"--size", "32x32"});
    std::filesystem::rename(s.path("o.exr"), s.path("reference.exr"));
    const ToolRun same =
        s.succeeds(kTool, {"spheres.json", "--size", "32x32", "--device", "cpu", "--compare", "reference.exr"});
    CHECK(same.out.find("0 pixels differ") != std::string::npos);
    CHECK_FALSE(s.exists("o.exr"));
    const Arguments blurred{"--size", "32x32", "--spp", "4", "--compare", "reference.exr"};
    s.refuses(blurred, ErrorClass::differs, {"reference.exr", "pixels differ"});
    const image::Difference by = image::compare_colour(film, s.film({"--size", "32x32", "--spp", "4"}));
    CHECK(by.largest > 0.05);
    const auto with_threshold = [&](double threshold) {
      return s
          .run(kTool, joined({"spheres.json", "--device", "cpu", "--threshold", std::to_string(threshold)}, blurred))
          .status;
    };
    CHECK(with_threshold(by.largest + 1e-5) == 0);
    CHECK(with_threshold(by.largest - 1e-5) == 11);
    s.film({"--size", "32x32", "--crop", "0,0,8,8"});
    std::filesystem::rename(s.path("o.exr"), s.path("part.exr"));
    s.refuses({"--size", "32x32", "--crop", "8,8,8,8", "--compare", "part.exr"}, ErrorClass::differs, {"part.exr"});
    s.refuses({"--size", "32x31", "--compare", "reference.exr"}, ErrorClass::differs, {"32 x 32", "32 x 31"});
    s.refuses({"--compare", "none.exr"}, ErrorClass::missing, {"none.exr"});
    s.write("text.exr", "no EXR");
    s.refuses({"--size", "8x8", "--compare", "text.exr"}, ErrorClass::usage, {"text.exr"});
    const std::string whole = s.read("reference.exr");
    s.write("cut.exr", whole.substr(0, whole.size() / 2));
    s.refuses({"--size", "32x32", "--compare", "cut.exr"}, ErrorClass::usage, {"cut.exr"});
  }

  TEST_CASE("a heatmap adds nothing to the EXR that was not asked for") {
    const Studio s;
    const auto has_visits = [&] { return s.read("o.exr").find("visits.nodes") != std::string::npos; };
    const image::Film plain = s.film({"--size", "32x32"});
    CHECK(image::compare_colour(plain, s.film({"--size", "32x32", "--heatmap", "h.png"})).pixels == 0);
    CHECK_FALSE(has_visits());
    CHECK(s.exists("h.png"));
    s.film({"--size", "32x32", "--heatmap", "h.png", "--aov", "visits"});
    CHECK(has_visits());
    s.refuses({"--heatmap", "spheres.json"}, ErrorClass::usage, {"spheres.json"});
  }

  TEST_CASE("a check renders nothing, and sees what rendering would") {
    const Studio s;
    const auto before = s.snapshot();
    const ToolRun sound = s.succeeds(kTool, {"spheres.json", "--check"});
    CHECK(sound.out.find("5 instances") != std::string::npos);
    CHECK(s.snapshot() == before);
    s.succeeds(kTool, {"spheres.json", "--check", "-o", "o.exr"});
    CHECK_FALSE(s.exists("o.exr"));
    std::filesystem::remove(s.path("compiled/icosphere.nkd"));
    s.refuses({"--check"}, ErrorClass::missing, {"icosphere.nkd"});
  }
}
