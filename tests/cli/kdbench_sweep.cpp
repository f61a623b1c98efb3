// kdbench sweep, from outside.
#include <algorithm>
#include <sstream>

#include <doctest/doctest.h>

#include "cli/run_tool.h"
#include "sweep_check.h"

using namespace kd;
using namespace kd::test;

namespace {

using Rows = std::vector<std::vector<std::string>>;

Rows parse_csv(const std::string& text) {
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

/// A sweep over the icosphere; the CSV's rows, heads first.
Rows sweep(const Terminal& t, const Arguments& lists) {
  t.write("cam.txt", "0 0 3  0 0 0  0 1 0  45  2 2 2\n");
  Arguments arguments{"sweep",    "--camera", "cam.txt", "--size",   "16x16",     "--device", "cpu",
                      "--repeat", "1",        "--csv",   "rows.csv", "--warm-up", "0"};
  arguments.insert(arguments.end(), lists.begin(), lists.end());
  arguments.push_back(data_file("icosphere.ply"));
  const std::string out = t.succeeds("kdbench", arguments).out;
  Rows rows = parse_csv(t.read("rows.csv"));
  REQUIRE(!rows.empty());
  for (const auto& row : rows) {
    REQUIRE(row.size() == rows[0].size());
    CHECK(out.find(row[3]) != std::string::npos);
  }
  return rows;
}

}  // namespace

TEST_SUITE("kdbench sweep") {
  TEST_CASE("a row for every combination, depths fastest") {
    const Terminal t;
    const Rows rows = sweep(t, {"--costs", "1:1.5,15:20", "--bonus", "0.1,0.2", "--price", "0.1", "--depth", "6,30"});
    REQUIRE(rows.size() == 1 + 8);
    CHECK(rows[0][0] == "costs");
    CHECK(std::vector(rows[1].begin(), rows[1].begin() + 4) == std::vector<std::string>{"1:1.5", "0.1", "0.1", "6"});
    CHECK(std::vector(rows[2].begin(), rows[2].begin() + 4) == std::vector<std::string>{"1:1.5", "0.1", "0.1", "30"});
    CHECK(std::vector(rows[8].begin(), rows[8].begin() + 4) == std::vector<std::string>{"15:20", "0.2", "0.1", "30"});
    CHECK(rows[1][7] == "6");
    CHECK(std::stod(rows[1][4]) > std::stod(rows[2][4]));  // a depth of 6 costs
  }

  TEST_CASE("the figures of a tree are those kdbuild gives") {
    const Terminal t;
    const Rows rows = sweep(t, {"--costs", "1:1.5", "--bonus", "0.08", "--price", "0.35"});
    const auto stats = t.report("kdbuild", {"build", data_file("icosphere.ply"), "-o", "s.nkd", "--stats", "-"});
    REQUIRE(rows.size() == 2);
    CHECK(std::stod(rows[1][4]) == doctest::Approx(stats["tree"]["sah_cost"].get<double>()).epsilon(1e-3));
    CHECK(std::stod(rows[1][5]) == doctest::Approx(stats["tree"]["references"].get<double>() / 1280).epsilon(1e-2));
    CHECK(std::stod(rows[1][8]) == doctest::Approx(stats["bytes"]["per_triangle"].get<double>()).epsilon(1e-2));
  }

  TEST_CASE("a dearer byte buys a smaller object for more SAH cost") {
    const Terminal t;
    const Rows rows = sweep(t, {"--costs", "1:1.5", "--bonus", "0.08", "--price", "0,0.1,1"});
    REQUIRE(rows.size() == 4);
    for (size_t i = 1; i + 1 < rows.size(); ++i) {
      CHECK(std::stod(rows[i][8]) > std::stod(rows[i + 1][8]));
      CHECK(std::stod(rows[i][4]) < std::stod(rows[i + 1][4]));
    }
  }

  TEST_CASE("without lists, the default settings are among the rows, and all trees answer alike") {
    const Terminal t;
    const Rows rows = sweep(t, {"--costs", "1:1.5", "--bonus", "0.08"});
    REQUIRE(rows.size() == 7);
    const auto settings = t.report("kdbuild", {"build", data_file("icosphere.ply"), "-o", "s.nkd", "--stats", "-"});
    CHECK(std::any_of(rows.begin() + 1, rows.end(), [&](const auto& row) {
      return row[2] == "0.35" && std::stod(row[4]) == doctest::Approx(settings["tree"]["sah_cost"]).epsilon(1e-3);
    }));
    const std::string out =
        t.succeeds("kdbench", {"sweep", data_file("icosphere.ply"), "--camera", "cam.txt", "--size", "16x16",
                               "--device", "cpu", "--repeat", "1", "--costs", "1:1.5", "--bonus", "0.08"})
            .out;
    CHECK_MESSAGE(out.find("All 6 trees answer alike: ") != std::string::npos, out);
  }

  TEST_CASE("trees that do not answer alike are an error") {
    bench::HitCheck check;
    CHECK(check.add({5, 4, 3}, "a.ply"));
    CHECK(check.add({5, 4, 3}, "a.ply"));
    CHECK(check.verdict().find("All 2 trees answer alike: 5 / 4 / 3") == 0);
    const auto other = check.add({5, 4, 2}, "a.ply");
    REQUIRE(!other);
    CHECK(other.error().line().find("a.ply: tree 3 answers 5 / 4 / 2") == 0);
  }

  TEST_CASE("errors") {
    const Terminal t;
    t.write("cam.txt", "0 0 3  0 0 0  0 1 0  45  2 2 2\n");
    const std::string mesh = data_file("icosphere.ply");
    const auto fails = [&](Arguments more, ErrorClass error_class, const std::vector<std::string>& fragments) {
      Arguments arguments{"sweep", mesh, "--camera", "cam.txt", "--device", "cpu"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      t.fails("kdbench", arguments, error_class, fragments);
    };
    for (const char* costs : {"1", "1:", ":1", "0:1", "1:-1", "1:1.5x", "1:nan", "1:1:1"}) {
      fails({"--costs", costs}, ErrorClass::usage, {"--costs", costs});
    }
    for (const char* bonus : {"-0.1", "1", "x", "nan"}) fails({"--bonus", bonus}, ErrorClass::usage, {"--bonus"});
    for (const char* price : {"-0.1", "x", "nan"}) fails({"--price", price}, ErrorClass::usage, {"--price"});
    for (const char* depth : {"0", "65", "deep"}) {
      fails({"--depth", depth}, ErrorClass::usage, {"--depth", depth});
    }
    fails({"--size", "0x3"}, ErrorClass::usage, {"--size"});
    fails({"--csv", "gone/rows.csv"}, ErrorClass::output, {"gone/rows.csv"});
    fails({"--csv", "cam.txt"}, ErrorClass::usage, {"cam.txt"});
    t.fails("kdbench", {"sweep", "gone.ply", "--camera", "cam.txt"}, ErrorClass::missing, {"gone.ply"});
    t.fails("kdbench", {"sweep", mesh, "--camera", "gone.txt"}, ErrorClass::missing, {"gone.txt"});
    t.fails("kdbench", {"sweep", mesh}, ErrorClass::usage, {"--camera"});
  }
}
