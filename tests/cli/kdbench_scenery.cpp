// kdbench forest and kdbench city, from outside.
#include <doctest/doctest.h>

#include <utility>

#include "cli/run_tool.h"
#include "sys/hash.h"

using namespace kd;
using namespace kd::test;

namespace {

/// Of all files of a scene, in the order of their names.
std::string hash_of(const Terminal& t, const std::string& folder) {
  std::string bytes;
  for (const auto& [name, content] : t.snapshot()) {
    if (name.starts_with(folder + "/")) bytes += name.substr(folder.size()) + content;
  }
  return hash_text(hash_span(std::span(std::as_const(bytes))));
}

struct Kind {
  std::string command;
  size_t meshes;
  std::string hash;  // of its files, with the seed 1
};

const Kind kKinds[] = {{"forest", 14, "c21d280e8f8f5a3f"}, {"city", 21, "ba76fc5feeb93f69"}};

}  // namespace

TEST_SUITE("kdbench scenery") {
  TEST_CASE("it compiles, and its picture has as many triangles as it says") {
    for (const Kind& kind : kKinds) {
      CAPTURE(kind.command);
      const Terminal t;
      const std::string out = t.succeeds("kdbench", {kind.command, "-o", "f", "--triangles", "10000000"}).out;
      Arguments build{"build", "-o", "f/compiled/", "--quiet"};
      for (const auto& [name, content] : t.snapshot()) {
        if (name.ends_with(".obj")) build.push_back(name);
      }
      CHECK(build.size() == 4 + kind.meshes);
      t.succeeds("kdbuild", build);
      const auto report = t.report("kdrender", {"f/" + kind.command + ".json", "-o", "f.exr", "--device", "cpu",
                                                "--size", "32x18", "--quiet", "--stats", "-"});
      const auto& counts = report["counts"];
      CHECK(counts["triangles_as_seen"] >= 8'000'000);
      CHECK(counts["triangles_as_seen"] <= 40'000'000);
      CHECK(report["rays"]["primary_hits"] >= 100);
      const uint64_t placed =
          counts["instances"].get<uint64_t>() + report["skipped"]["instances_not_loaded"].get<uint64_t>();
      CHECK_MESSAGE(out.find(std::to_string(placed) + " instances") != std::string::npos, out);
    }
  }

  TEST_CASE("the same bytes on every machine, and another seed's are others") {
    for (const Kind& kind : kKinds) {
      CAPTURE(kind.command);
      const Terminal t;
      for (const auto& [folder, seed] : {std::pair{"a", "1"}, {"b", "1"}, {"c", "2"}})
        t.succeeds("kdbench", {kind.command, "-o", folder, "--triangles", "10000000", "--seed", seed});
      CHECK(hash_of(t, "a") == kind.hash);
      CHECK(hash_of(t, "b") == hash_of(t, "a"));
      CHECK(hash_of(t, "c") != hash_of(t, "a"));
    }
  }

  TEST_CASE("errors") {
    for (const Kind& kind : kKinds) {
      const Terminal t;
      t.fails("kdbench", {kind.command}, ErrorClass::usage, {"--output"});
      t.fails("kdbench", {kind.command, "-o", "f", "--triangles", "1000"}, ErrorClass::usage, {"--triangles"});
      t.fails("kdbench", {kind.command, "-o", "f", "--seed", "-1"}, ErrorClass::usage, {"--seed"});
      t.write("file", "");
      t.fails("kdbench", {kind.command, "-o", "file/f"}, ErrorClass::output, {"file/f"});
    }
  }
}
