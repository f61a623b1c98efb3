// kdbench frame, from outside.
#include <doctest/doctest.h>

#include "cli/run_tool.h"

using namespace kd;
using namespace kd::test;

TEST_SUITE("kdbench frame") {
  TEST_CASE("every stage of a frame, and the frame") {
    Terminal t;
    t.set_up_spheres();
    const std::string table =
        t.succeeds("kdbench", {"frame", "spheres.json", "--device", "cpu", "--repeat", "1", "--gamma-exr"}).out;
    for (const char* word : {"object intersection", "shadow, colour", "gamma", "all, first launch to last", "rays"})
      CHECK_MESSAGE(table.find(word) != std::string::npos, table);
    const std::string linear = t.succeeds("kdbench", {"frame", "spheres.json", "--device", "cpu", "--repeat", "1"}).out;
    CHECK(linear.find("gamma") == std::string::npos);
  }

  TEST_CASE("errors") {
    const Terminal t;
    t.fails("kdbench", {"frame", "none.json", "--device", "cpu"}, ErrorClass::missing, {"none.json"});
    t.fails("kdbench", {"frame", "none.json", "--repeat", "0"}, ErrorClass::usage, {"--repeat"});
    t.fails("kdbench", {"frame"}, ErrorClass::usage, {"scene"});
  }
}
