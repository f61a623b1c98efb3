// Why a tree costs what it costs: against tree_statistics, against trees small enough to work out by hand, and as
// kdbuild prints and draws it.
#include <numeric>

#include <doctest/doctest.h>

#include "cli/run_tool.h"
#include "core/tree_statistics.h"
#include "kdbuild/bar_chart.h"
#include "kdbuild/explain_report.h"

using namespace kd;
using namespace kd::test;
using tools::Bin;
using tools::Explanation;
using tools::xml_text;

namespace {

/// A cube of edge 1 on a lattice of 2 bits: coordinates 0 to 3.
Lattice unit_lattice() { return {{0, 0, 0}, {1, 1, 1}, 2}; }

uint64_t total(const std::vector<Bin>& bins) {
  return std::accumulate(bins.begin(), bins.end(), uint64_t{0},
                         [](uint64_t sum, const Bin& b) { return sum + b.count; });
}

/// That the parts of an object's explanation add up to what its summary and its sections say.
void check_sums(const nkd::ObjectFile& file) {
  const tools::ObjectExplanation e = tools::explain_object(file);
  const Explanation& t = e.tree;
  const TreeStatistics& s = file.summary().tree;
  CHECK(t.sah_cost() == doctest::Approx(s.sah_cost).epsilon(1e-9));
  CHECK(t.inner_nodes == s.inner_nodes);
  CHECK(t.leaves == s.leaves);
  CHECK(t.empty_leaves == s.empty_leaves);
  CHECK(t.levels.size() == s.depth + 1);
  CHECK(t.references == file.geometry().references.size());
  CHECK(t.triangles == file.geometry().triangle_count());
  CHECK(total(t.leaf_sizes) == s.leaves);
  CHECK(t.leaf_sizes.back().lowest <= s.largest_leaf);
  CHECK(t.leaf_sizes.back().highest >= s.largest_leaf);
  CHECK(total(t.triangle_references) == t.triangles);
  CHECK(t.median_references <= t.references_95);
  CHECK(t.references_95 <= t.most_references);
  CHECK(t.empty_volume <= doctest::Approx(1));  // all of it where every triangle lies in a flat cell: a box
  CHECK(t.empty_visits <= t.leaf_visits);
  uint64_t bytes = 0;
  for (const tools::SectionBytes& section : e.sections) bytes += section.bytes;
  CHECK(bytes == file.size());
}

}  // namespace

TEST_SUITE("kdbuild explain") {
  TEST_CASE("a tree that is one leaf") {
    const std::vector<Node> nodes{make_leaf(0, 2), make_leaf(0, 0)};
    const std::vector<uint32_t> references{0, 1};
    const Explanation t = tools::explain(nodes, references, 2, unit_lattice());
    CHECK(t.traversal_cost == 0);
    CHECK(t.intersection_cost == 3);
    CHECK(t.inner_nodes == 0);
    CHECK(t.leaves == 1);
    CHECK(t.leaf_visits == 1);
    CHECK(t.empty_leaves == 0);
    CHECK(t.empty_volume == 0);
    REQUIRE(t.leaf_sizes.size() == 3);
    CHECK(t.leaf_sizes[2].count == 1);
    CHECK(t.most_references == 1);
    CHECK(t.mean_references() == 1);
  }

  TEST_CASE("a third of the box cut off") {
    // x = 1 of 3: below it nothing, above it three triangles; the third is in the leaf only, the first two come again
    // in the leaves that y = 2 makes of it.
    const std::vector<Node> nodes{make_inner(0, 1, 2), make_leaf(0, 0), make_leaf(0, 0),
                                  make_inner(1, 2, 4), make_leaf(0, 3), make_leaf(3, 2)};
    const std::vector<uint32_t> references{0, 1, 2, 0, 1};
    const Explanation t = tools::explain(nodes, references, 3, unit_lattice());
    const double below = (2 * (1.0 / 3) + 1) / 3, above = (2 * (2.0 / 3) + 1) / 3;  // shares of the surface
    const double near = (2.0 / 3 * 2 / 3 + 2.0 / 3 + 2.0 / 3) / 3, far = (2.0 / 3 * 1 / 3 + 2.0 / 3 + 1.0 / 3) / 3;
    CHECK(t.traversal_cost == doctest::Approx(1 + above));
    CHECK(t.intersection_cost == doctest::Approx(1.5 * (3 * near + 2 * far)));
    REQUIRE(t.levels.size() == 3);
    CHECK(t.levels[0].traversal_cost == doctest::Approx(1));
    CHECK(t.levels[1].traversal_cost == doctest::Approx(above));
    CHECK(t.levels[1].leaves == 1);
    CHECK(t.levels[2].leaves == 2);
    CHECK(t.levels[2].intersection_cost == doctest::Approx(t.intersection_cost));
    CHECK(t.empty_leaves == 1);
    CHECK(t.empty_volume == doctest::Approx(1.0 / 3));
    CHECK(t.empty_visits == doctest::Approx(below));
    CHECK(t.leaf_visits == doctest::Approx(below + near + far));
    REQUIRE(t.triangle_references.size() == 3);
    CHECK(t.triangle_references[1].count == 1);
    CHECK(t.triangle_references[2].count == 2);
    CHECK(t.median_references == 2);
    CHECK(t.most_references == 2);
    CHECK(t.nodes_per_triangle() == doctest::Approx(5.0 / 3));
    CHECK(t.sah_cost() == doctest::Approx(tree_statistics(nodes, unit_lattice()).sah_cost));
  }

  TEST_CASE("bins: single numbers up to 8, then doubling") {
    const auto last_bin = [](uint32_t count) {
      const std::vector<Node> nodes{make_leaf(0, count), make_leaf(0, 0)};
      std::vector<uint32_t> references(count);
      std::iota(references.begin(), references.end(), 0u);
      const Explanation t = tools::explain(nodes, references, count, unit_lattice());
      CHECK(total(t.leaf_sizes) == 1);
      CHECK(t.leaf_sizes.back().count == 1);
      return tools::bin_name(t.leaf_sizes.back());
    };
    CHECK(last_bin(1) == "1");
    CHECK(last_bin(8) == "8");
    CHECK(last_bin(9) == "9-16");
    CHECK(last_bin(16) == "9-16");
    CHECK(last_bin(17) == "17-32");
    CHECK(last_bin(32) == "17-32");
    CHECK(last_bin(33) == "33-64");
    CHECK(last_bin(1025) == "1025-2048");
  }

  TEST_CASE("a flat mesh: shares are finite") {
    const Lattice flat{{0, 0, 0}, {1, 0, 1}, 2};
    const std::vector<Node> nodes{make_inner(0, 1, 2), make_leaf(0, 0), make_leaf(0, 0), make_leaf(0, 1)};
    const Explanation t = tools::explain(nodes, std::vector<uint32_t>{0}, 1, flat);
    CHECK(t.empty_volume == doctest::Approx(1.0 / 3));
    CHECK(t.sah_cost() == doctest::Approx(tree_statistics(nodes, flat).sah_cost));
  }

  TEST_CASE("sums agree with the object") {
    for (const char* name : {"icosphere.ply", "cube.obj", "quad.obj", "cathedral_pier.obj"}) {
      CAPTURE(name);
      Workshop workshop;
      auto file = nkd::ObjectFile::open(workshop.compile(data_file(name)));
      REQUIRE(file);
      check_sums(*file);
    }
    for (const char* name : {"teapot", "sibenik", "bad_thingi_112932"}) {
      CAPTURE(name);
      Workshop workshop;
      const auto mesh = shared_mesh(std::string(name) + ".ply");
      if (!mesh) continue;
      auto file = nkd::ObjectFile::open(workshop.compile(*mesh));
      REQUIRE(file);
      check_sums(*file);
    }
  }

  TEST_CASE("info and build explain alike, and draw the same bytes") {
    const Terminal t;
    const std::string mesh = data_file("icosphere.ply");
    const std::string built = t.succeeds("kdbuild", {"build", mesh, "-o", "s.nkd", "--quiet", "--explain"}).out;
    const std::string told = t.succeeds("kdbuild", {"info", "s.nkd", "--explain", "--plot", "b.svg"}).out;
    CHECK(built.starts_with("s.nkd: 1280 triangles, SAH cost "));
    CHECK(told.ends_with(built));
    CHECK(t.read("s.svg") == t.read("b.svg"));
    CHECK(t.succeeds("kdbuild", {"info", "s.nkd"}).out + built == told);
  }

  TEST_CASE("as JSON") {
    const Terminal t;
    t.succeeds("kdbuild", {"build", data_file("icosphere.ply"), "-o", "s.nkd", "--quiet"});
    CHECK(!t.report("kdbuild", {"info", "s.nkd", "--format", "json"}).contains("explanation"));
    const auto info = t.report("kdbuild", {"info", "s.nkd", "--format", "json", "--explain"});
    const auto& e = info["explanation"];
    CHECK(e["traversal_cost"].get<double>() + e["intersection_cost"].get<double>() ==
          doctest::Approx(info["tree"]["sah_cost"].get<double>()));
    CHECK(e["levels"].size() == info["tree"]["depth"].get<size_t>() + 1);
    CHECK(e["empty_leaves"]["count"] == info["tree"]["empty_leaves"]);
    CHECK(e["triangle_references"]["mean"].get<double>() * 1280 ==
          doctest::Approx(info["tree"]["references"].get<double>()));
  }

  TEST_CASE("the picture is XML, whatever the object is called") {
    const Terminal t;
    const std::string name = "<b> & \"c\" d\xc3\xa4\x01\xff " + std::string(120, 'x') + ".nkd";
    t.succeeds("kdbuild", {"build", data_file("cube.obj"), "-o", name, "--quiet"});
    t.succeeds("kdbuild", {"info", name, "--plot", "p.svg"});
    const std::string svg = t.read("p.svg");
    CHECK(svg.find("&lt;b&gt; &amp; &quot;c&quot; d\xc3\xa4\xef\xbf\xbd\xef\xbf\xbd x") != std::string::npos);
    system_output("xmllint", "--noout '" + t.path("p.svg") + "'");
  }

  TEST_CASE("texts for XML") {
    CHECK(xml_text("plain") == "plain");
    CHECK(xml_text("a<b>&\"") == "a&lt;b&gt;&amp;&quot;");
    CHECK(xml_text("\xe2\x89\xa4\xf0\x9f\x90\xb0") == "\xe2\x89\xa4\xf0\x9f\x90\xb0");
    const std::string replaced = "\xef\xbf\xbd";
    CHECK(xml_text("\n") == replaced);
    CHECK(xml_text("\xc3") == replaced);                                // cut short
    CHECK(xml_text("\x80") == replaced);                                // starts nothing
    CHECK(xml_text("\xc0\xaf") == replaced + replaced);                 // longer than need be
    CHECK(xml_text("\xed\xa0\x80") == replaced + replaced + replaced);  // half of a pair
    CHECK(xml_text("\xef\xbf\xbf") == replaced + replaced + replaced);  // no character
  }

  TEST_CASE("errors") {
    const Terminal t;
    t.succeeds("kdbuild", {"build", data_file("cube.obj"), "-o", "c.nkd", "--quiet"});
    t.fails("kdbuild", {"info", "c.nkd", "--plot", "c.nkd"}, ErrorClass::usage, {"c.nkd"});
    t.fails("kdbuild", {"info", "c.nkd", "--plot", ""}, ErrorClass::usage, {"--plot"});
    t.fails("kdbuild", {"build", data_file("cube.obj"), "-o", "d.nkd", "--explain", "--stats", "-"}, ErrorClass::usage,
            {"--explain", "--stats"});
    t.fails("kdbuild", {"info", "c.nkd", "--plot", "gone/p.svg"}, ErrorClass::output, {"gone/p.svg"});
    t.fails("kdbuild", {"info", "gone.nkd", "--explain", "--plot", "p.svg"}, ErrorClass::missing, {"gone.nkd"});
  }
}
