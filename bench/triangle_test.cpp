#include "triangle_test.h"

#include <array>

#include <fmt/format.h>

namespace kd::bench {

namespace {

struct Row {
  render::TriangleTest test;
  const char* name;
};

constexpr std::array kRows{Row{render::TriangleTest::exact, "exact"},
                           Row{render::TriangleTest::moller_trumbore, "moller-trumbore"},
                           Row{render::TriangleTest::woop, "woop"}};

}  // namespace

std::string triangle_test_names() { return fmt::format("{}, {} or {}", kRows[0].name, kRows[1].name, kRows[2].name); }

const char* name_of(render::TriangleTest test) {
  for (const Row& row : kRows) {
    if (row.test == test) return row.name;
  }
  return "";
}

Result<render::TriangleTest> choose_triangle_test(const std::string& name, const nkd::ObjectFile& object) {
  const bool on_lattice = object.geometry().form == VertexForm::lattice;
  if (name.empty()) return on_lattice ? render::TriangleTest::exact : render::TriangleTest::woop;
  const std::string where = "--triangle-test " + name;
  for (const Row& row : kRows) {
    if (row.name != name) continue;
    if (row.test == render::TriangleTest::exact && !on_lattice) {
      return Error{
          ErrorClass::usage, where,
          fmt::format("the vertices of {} are float32, and the test is exact only on the lattice: use another, "
                      "or compile it without --vertices float32",
                      object.path())};
    }
    return row.test;
  }
  return Error{ErrorClass::usage, where, "no triangle test: use " + triangle_test_names()};
}

}  // namespace kd::bench
