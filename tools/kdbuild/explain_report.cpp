#include "kdbuild/explain_report.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace kd::tools {

namespace {

constexpr int kBarWidth = 24;

/// As long as the value is of the largest; at least one # for what is not nothing.
std::string bar(double value, double largest) {
  if (!(value > 0)) return "";
  return std::string(static_cast<size_t>(std::max(1.0, kBarWidth * value / largest + 0.5)), '#');
}

/// Without the blanks that a short last column leaves.
void print_line(const std::string& line) { fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1)); }

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

template <class Element, class Measure>
double largest_of(const std::vector<Element>& elements, const Measure& measure) {
  double largest = 0;
  for (const Element& e : elements) largest = std::max(largest, static_cast<double>(measure(e)));
  return largest;
}

double cost(const Level& level) { return level.traversal_cost + level.intersection_cost; }

void print_levels(const Explanation& t) {
  const double most_cost = largest_of(t.levels, cost);
  const double most_leaves = largest_of(t.levels, [](const Level& l) { return l.leaves; });
  fmt::print("\n  {:>5} {:>10} {:>9} {:>9} {:>7}  {:<{}}  {:>10}\n", "depth", "inner", "traverse", "intersect", "share",
             "of SAH cost", kBarWidth, "leaves");
  for (size_t depth = 0; depth < t.levels.size(); ++depth) {
    const Level& l = t.levels[depth];
    print_line(fmt::format("  {:>5} {:>10} {:>9.3f} {:>9.3f} {:>5.1f} %  {:<{}}  {:>10}  {}", depth, l.inner_nodes,
                           l.traversal_cost, l.intersection_cost, percent(cost(l), t.sah_cost()),
                           bar(cost(l), most_cost), kBarWidth, l.leaves,
                           bar(static_cast<double>(l.leaves), most_leaves)));
  }
}

void print_leaf_sizes(const Explanation& t) {
  const double most_leaves = largest_of(t.leaf_sizes, [](const Bin& b) { return b.count; });
  const double most_visits = largest_of(t.leaf_sizes, [](const Bin& b) { return b.visits; });
  fmt::print("\n  {:>10} {:>10} {:>7}  {:<{}}  {:>7}  {}\n", "leaf holds", "leaves", "share", "", kBarWidth, "visits",
             "of all visits to leaves");
  for (const Bin& b : t.leaf_sizes) {
    const auto count = static_cast<double>(b.count);
    print_line(fmt::format("  {:>10} {:>10} {:>5.1f} %  {:<{}}  {:>5.1f} %  {}", bin_name(b), b.count,
                           percent(count, static_cast<double>(t.leaves)), bar(count, most_leaves), kBarWidth,
                           percent(b.visits, t.leaf_visits), bar(b.visits, most_visits)));
  }
}

void print_triangle_references(const Explanation& t) {
  const double most = largest_of(t.triangle_references, [](const Bin& b) { return b.count; });
  fmt::print("\n  {:>10} {:>10} {:>7}\n", "in leaves", "triangles", "share");
  for (const Bin& b : t.triangle_references) {
    const auto count = static_cast<double>(b.count);
    print_line(fmt::format("  {:>10} {:>10} {:>5.1f} %  {}", bin_name(b), b.count,
                           percent(count, static_cast<double>(t.triangles)), bar(count, most)));
  }
  fmt::print("  mean {:.2f}, median {}, 95 % of the triangles at most {}, largest {}\n", t.mean_references(),
             t.median_references, t.references_95, t.most_references);
}

Json bins_json(const std::vector<Bin>& bins, bool with_visits) {
  Json all = Json::array();
  for (const Bin& b : bins) {
    all.push_back({{"lowest", b.lowest}, {"highest", b.highest}, {"count", b.count}});
    if (with_visits) all.back()["visits"] = b.visits;
  }
  return all;
}

}  // namespace

double ObjectExplanation::bytes_per_triangle() const {
  uint64_t bytes = 0;
  for (const SectionBytes& section : sections) bytes += section.bytes;
  return static_cast<double>(bytes) / static_cast<double>(tree.triangles);
}

ObjectExplanation explain_object(const nkd::ObjectFile& file) {
  const nkd::Geometry& g = file.geometry();
  const uint64_t geometry =
      g.nodes.size_bytes() + g.references.size_bytes() + g.triangles.size_bytes() + g.vertices.size_bytes();
  return {std::filesystem::path(file.path()).filename().string(),
          explain(g.nodes, g.references, g.triangle_count(), file.summary().lattice),
          {{"nodes", g.nodes.size_bytes()},
           {"references", g.references.size_bytes()},
           {"triangles", g.triangles.size_bytes()},
           {"vertices", g.vertices.size_bytes()},
           {"rest", file.size() - geometry}}};
}

void print_explanation(const ObjectExplanation& e) {
  const Explanation& t = e.tree;
  const auto triangles = static_cast<double>(t.triangles);
  fmt::print("{}: {} triangles, SAH cost {:.2f} (1 : 1.5)\n", e.name, t.triangles, t.sah_cost());
  fmt::print("  traversal    {:>9.3f}  {:>5.1f} %  a ray that meets the box passes {:.1f} inner nodes\n",
             t.traversal_cost, percent(t.traversal_cost, t.sah_cost()), t.traversal_cost);
  fmt::print("  intersection {:>9.3f}  {:>5.1f} %  and {:.1f} leaves with {:.1f} triangles\n", t.intersection_cost,
             percent(t.intersection_cost, t.sah_cost()), t.leaf_visits, t.intersection_cost / kIntersectionCost);
  print_levels(t);
  print_leaf_sizes(t);
  fmt::print("  empty: {} of {} leaves, {:.1f} % of the box's volume, {:.1f} % of the visits to leaves\n",
             t.empty_leaves, t.leaves, 100 * t.empty_volume, percent(t.empty_visits, t.leaf_visits));
  print_triangle_references(t);
  fmt::print("\n  {:<18} {:>12} {:>13}\n", "section", "bytes", "a triangle");
  for (const SectionBytes& s : e.sections) {
    fmt::print("  {:<18} {:>12} {:>13.2f}\n", s.name, s.bytes, static_cast<double>(s.bytes) / triangles);
  }
  fmt::print("  {:.2f} nodes and {:.1f} bytes a triangle in all\n", t.nodes_per_triangle(), e.bytes_per_triangle());
}

Json explanation_json(const ObjectExplanation& e) {
  const Explanation& t = e.tree;
  Json levels = Json::array(), sections = Json::object();
  for (const Level& l : t.levels) {
    levels.push_back({{"inner_nodes", l.inner_nodes},
                      {"leaves", l.leaves},
                      {"traversal_cost", l.traversal_cost},
                      {"intersection_cost", l.intersection_cost}});
  }
  for (const SectionBytes& s : e.sections)
    sections[s.name] = static_cast<double>(s.bytes) / static_cast<double>(t.triangles);
  return {{"traversal_cost", t.traversal_cost},
          {"intersection_cost", t.intersection_cost},
          {"levels", levels},
          {"leaf_sizes", bins_json(t.leaf_sizes, true)},
          {"leaf_visits", t.leaf_visits},
          {"empty_leaves", {{"count", t.empty_leaves}, {"volume", t.empty_volume}, {"visits", t.empty_visits}}},
          {"triangle_references",
           {{"mean", t.mean_references()},
            {"median", t.median_references},
            {"percentile_95", t.references_95},
            {"largest", t.most_references},
            {"histogram", bins_json(t.triangle_references, false)}}},
          {"nodes_per_triangle", t.nodes_per_triangle()},
          {"bytes_per_triangle", sections}};
}

Result<void> explain_file(const std::string& object_path, bool print, const std::string& plot) {
  auto file = nkd::ObjectFile::open(object_path);
  if (!file) return file.error();
  const ObjectExplanation explanation = explain_object(*file);
  if (print) print_explanation(explanation);
  return plot.empty() ? Result<void>{} : write_explanation_svg(plot, explanation);
}

}  // namespace kd::tools
