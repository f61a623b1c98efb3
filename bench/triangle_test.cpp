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

std::string option(const std::string& name) { return "--triangle-test " + name; }

}  // namespace

std::string triangle_test_names() { return fmt::format("{}, {} or {}", kRows[0].name, kRows[1].name, kRows[2].name); }

const char* name_of(render::TriangleTest test) {
  for (const Row& row : kRows) {
    if (row.test == test) return row.name;
  }
  return "";
}

Result<render::TriangleTest> triangle_test_named(const std::string& name) {
  for (const Row& row : kRows) {
    if (row.name == name) return row.test;
  }
  return Error{ErrorClass::usage, option(name), "no triangle test: use " + triangle_test_names()};
}

Result<render::TriangleTest> choose_triangle_test(const std::string& name, const nkd::ObjectFile& object) {
  const bool on_lattice = object.geometry().form == VertexForm::lattice;
  if (name.empty()) return on_lattice ? render::TriangleTest::exact : render::TriangleTest::woop;
  const auto test = triangle_test_named(name);
  if (!test || *test != render::TriangleTest::exact || on_lattice) return test;
  return Error{ErrorClass::usage, option(name),
               fmt::format("the vertices of {} are float32, and the test is exact only on the lattice: use another, "
                           "or compile it without --vertices float32",
                           object.path())};
}

}  // namespace kd::bench
