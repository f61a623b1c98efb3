// Objects of the real meshes, the bad ones included, are sound in depth: no leaf lacks a triangle that passes through
// its cell, decided in exact integers.
#include <doctest/doctest.h>

#include "nkd/validate.h"
#include "support/workshop.h"

using namespace kd;
using namespace kd::test;

TEST_CASE("objects of real meshes are sound") {
  Workshop workshop;
  for (const char* name : kRealMeshes) {
    const auto mesh = shared_mesh(std::string(name) + ".ply");
    if (!mesh) {
      MESSAGE("skipped: no " << name << " in " << shared_data().string());
      continue;
    }
    CAPTURE(name);
    const auto object = nkd::ObjectFile::open(workshop.compile(*mesh));
    REQUIRE(object);
    for (const nkd::Finding& finding : nkd::validate(*object)) FAIL_CHECK(finding.line());
  }
}
