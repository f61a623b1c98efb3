// kdbench instances, from outside.
#include <doctest/doctest.h>

#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

TEST_SUITE("kdbench instances") {
  TEST_CASE("our hits are Embree's") {
    Terminal t;
    t.set_up_spheres();
    const ToolRun run = t.run("kdbench", {"instances", "spheres.json", "--size", "200x150", "--repeat", "1"});
    if (run.err.find("Embree 3 was not found") != std::string::npos) {
      MESSAGE("skipped: kdbench was built without Embree 3");
      return;
    }
    REQUIRE_MESSAGE(run.status == 0, run.err);
    // A ray along a silhouette may meet the one and miss the other, whose vertices are rounded once more.
    const size_t at = run.out.find(" rays differ");
    REQUIRE_MESSAGE(at != std::string::npos, run.out);
    CHECK_MESSAGE(std::stoi(run.out.substr(run.out.rfind('\n', at) + 1)) <= 3, run.out);
    CHECK(run.out.find("of Embree") != std::string::npos);
  }

  TEST_CASE("errors") {
    const Terminal t;
    t.fails("kdbench", {"instances", "none.json"}, ErrorClass::missing, {"none.json"});
    t.fails("kdbench", {"instances", "none.json", "--size", "0x5"}, ErrorClass::usage, {"0x5"});
    t.fails("kdbench", {"instances"}, ErrorClass::usage, {"scene"});
  }
}
