// kdbench forest, from outside.
#include <doctest/doctest.h>

#include <utility>

#include "cli/run_tool.h"
#include "sys/hash.h"

using namespace kd;
using namespace kd::test;

namespace {

/// Of all files of a forest, in the order of their names.
std::string hash_of(const Terminal& t, const std::string& folder) {
  std::string bytes;
  for (const auto& [name, content] : t.snapshot()) {
    if (name.starts_with(folder + "/")) bytes += name.substr(folder.size()) + content;
  }
  return hash_text(hash_span(std::span(std::as_const(bytes))));
}

}  // namespace

TEST_SUITE("kdbench forest") {
  TEST_CASE("it compiles, and its picture has as many triangles as it says") {
    const Terminal t;
    const std::string out = t.succeeds("kdbench", {"forest", "-o", "f", "--triangles", "10000000"}).out;
    Arguments build{"build", "-o", "f/compiled/", "--quiet"};
    for (const auto& [name, content] : t.snapshot()) {
      if (name.ends_with(".obj")) build.push_back(name);
    }
    CHECK(build.size() == 4 + 14);
    t.succeeds("kdbuild", build);
    const auto report = t.report(
        "kdrender", {"f/forest.json", "-o", "f.exr", "--device", "cpu", "--size", "32x18", "--quiet", "--stats", "-"});
    const auto& counts = report["counts"];
    CHECK(counts["triangles_as_seen"] >= 10'000'000);
    CHECK(counts["triangles_as_seen"] <= 40'000'000);
    const uint64_t placed =
        counts["instances"].get<uint64_t>() + report["skipped"]["instances_not_loaded"].get<uint64_t>();
    CHECK_MESSAGE(out.find(std::to_string(placed) + " instances") != std::string::npos, out);
  }

  TEST_CASE("the same bytes on every machine, and another seed's are others") {
    const Terminal t;
    for (const auto& [folder, seed] : {std::pair{"a", "1"}, {"b", "1"}, {"c", "2"}})
      t.succeeds("kdbench", {"forest", "-o", folder, "--triangles", "10000000", "--seed", seed});
    CHECK(hash_of(t, "a") == "c21d280e8f8f5a3f");
    CHECK(hash_of(t, "b") == hash_of(t, "a"));
    CHECK(hash_of(t, "c") != hash_of(t, "a"));
  }

  TEST_CASE("errors") {
    const Terminal t;
    t.fails("kdbench", {"forest"}, ErrorClass::usage, {"--output"});
    t.fails("kdbench", {"forest", "-o", "f", "--triangles", "1000"}, ErrorClass::usage, {"--triangles"});
    t.fails("kdbench", {"forest", "-o", "f", "--seed", "-1"}, ErrorClass::usage, {"--seed"});
    t.write("file", "");
    t.fails("kdbench", {"forest", "-o", "file/f"}, ErrorClass::output, {"file/f"});
  }
}
