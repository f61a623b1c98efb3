#include "stress_report.h"

#include <filesystem>
#include <functional>

#include <fmt/format.h>

#include "common/console.h"
#include "embree_build.h"
#include "machine.h"
#include "table.h"
#include "triangle_test.h"

namespace kd::bench {

namespace {

using stress::StressRow;
using stress::Tally;
using tools::Json;

std::string_view class_name(stress::RayClass c) { return stress::class_rows()[static_cast<size_t>(c)].name; }

std::string mesh_name(const StressRow& row) { return std::filesystem::path(row.mesh).stem().string(); }

constexpr const char* kFaultNames[] = {"none",         "unsnapped", "off-grid",     "displaced",   "test-missed",
                                       "test-doubled", "test-off",  "closest-none", "closest-off", "closest-far",
                                       "any-none",     "any-off",   "leak",         "odd",         "acne",
                                       "contact-lost", "packet-off"};
static_assert(std::size(kFaultNames) == stress::kFaults);

/// Rows that have a key in common, in the order in which keys come first.
struct Group {
  std::string key;
  Tally tally;
  double seconds = 0;
};
using Key = std::function<std::string(const StressRow&)>;

std::vector<Group> grouped(const StressRun& run, const Key& key) {
  std::vector<Group> groups;
  for (const StressRow& row : run.rows) {
    const std::string name = key(row);
    auto at = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.key == name; });
    if (at == groups.end()) at = groups.insert(groups.end(), {name, {}, 0});
    at->tally.add(row.tally);
    at->seconds += row.seconds;
  }
  return groups;
}

std::vector<Group> by_class(const StressRun& run) {
  std::vector<Group> ordered;
  const auto groups = grouped(run, [](const StressRow& row) { return std::string(class_name(row.ray_class)); });
  for (const stress::ClassRow& row : stress::class_rows()) {
    for (const Group& g : groups) {
      if (g.key == row.name) ordered.push_back(g);
    }
  }
  return ordered;
}
std::vector<Group> by_bits(const StressRun& run) {
  return grouped(run, [](const StressRow& row) { return fmt::format("{}", row.bits); });
}
std::vector<Group> by_mesh(const StressRun& run) { return grouped(run, mesh_name); }

/// Rays from inside closed meshes: any miss is a leak.
std::vector<Group> leaks(const StressRun& run) {
  StressRun inside;
  for (const StressRow& row : run.rows) {
    if (row.ray_class == stress::RayClass::inside) inside.rows.push_back(row);
  }
  return grouped(inside, [](const StressRow& row) { return fmt::format("{}, {} bits", mesh_name(row), row.bits); });
}

double double_share(const Tally& t) {
  return t[stress::kTriangleTests] > 0
             ? static_cast<double>(t[stress::kDoubleTests]) / static_cast<double>(t[stress::kTriangleTests])
             : 0;
}

bool has_peers(const StressRun& run) { return total_of(run)[stress::kPeerRays] > 0; }

std::string cell(const Tally& t, stress::Count count) { return fmt::format("{}", t[count]); }

Table table_of(const char* head, const std::vector<Group>& groups, bool peers) {
  std::vector<std::string> heads{head,         "rays",       "hits", "ties", "misses", "double counts",
                                 "mismatches", "FP64 tests", "s"};
  if (peers) heads.insert(heads.end(), {"Embree robust misses", "Embree default misses"});
  Table table(heads);
  for (const Group& g : groups) {
    const Tally& t = g.tally;
    std::vector<std::string> cells{g.key,
                                   cell(t, stress::kRays),
                                   cell(t, stress::kHits),
                                   cell(t, stress::kTies),
                                   cell(t, stress::kMisses),
                                   cell(t, stress::kDoubleCounts),
                                   cell(t, stress::kMismatches),
                                   fmt::format("{:.2f} %", 100 * double_share(t)),
                                   fmt::format("{:.2f}", g.seconds)};
    if (peers) cells.insert(cells.end(), {cell(t, stress::kRobustMisses), cell(t, stress::kDefaultMisses)});
    table.add(std::move(cells));
  }
  return table;
}

/// The largest displacements of snapped rays, up to 23 bits or at 24.
Tally displaced(const StressRun& run, bool at_most_bits) {
  Tally tally;
  for (const StressRow& row : run.rows) {
    if ((row.bits == kMaxLatticeBits) == at_most_bits) tally.add(row.tally);
  }
  return tally;
}

Json counts_json(const Tally& t, bool peers) {
  Json j{{"rays", t[stress::kRays]},
         {"misses", t[stress::kMisses]},
         {"double_counts", t[stress::kDoubleCounts]},
         {"mismatches", t[stress::kMismatches]},
         {"traced", t[stress::kSnapped]},
         {"hits", t[stress::kHits]},
         {"ties", t[stress::kTies]},
         {"plain_oracle_rays", t[stress::kPlain]},
         {"oracle_triangles", t[stress::kExactTests]},
         {"triangle_tests", t[stress::kTriangleTests]},
         {"double_precision_tests", t[stress::kDoubleTests]},
         {"double_precision_share", double_share(t)}};
  if (peers) {
    j["embree"] = {{"rays", t[stress::kPeerRays]},
                   {"robust_misses", t[stress::kRobustMisses]},
                   {"robust_false_hits", t[stress::kRobustFalse]},
                   {"default_misses", t[stress::kDefaultMisses]},
                   {"default_false_hits", t[stress::kDefaultFalse]}};
  }
  return j;
}

Json groups_json(const char* key, const std::vector<Group>& groups, bool peers) {
  Json all = Json::array();
  for (const Group& g : groups) {
    Json j{{key, std::string_view(key) == "bits" ? Json(std::stoi(g.key)) : Json(g.key)}};
    j.update(counts_json(g.tally, peers));
    j["seconds"] = g.seconds;
    all.push_back(j);
  }
  return all;
}

Json displacement_json(const StressRun& run) {
  const auto one = [&](int bits) {
    const Tally t = displaced(run, bits == kMaxLatticeBits);
    return Json{{"near", t.moved_near},
                {"near_bound", stress::allowed_near(bits)},
                {"far", t.moved_far},
                {"far_bound", stress::allowed_far(bits)}};
  };
  return {{"below_24_bits", one(kMaxLatticeBits - 1)}, {"at_24_bits", one(kMaxLatticeBits)}};
}

/// A command line that traces one ray again.
std::string replay(const StressRun& run, const StressRow& row, const stress::Failure& f) {
  const bool ours = row.mesh.find('.') == std::string::npos;
  const bool exact = run.settings.test == render::TriangleTest::exact;
  return fmt::format("kdbench stress {} --bits {} --class {}{} --seed {} --first {} --rays 1 --device cpu",
                     ours ? "--mesh " + row.mesh : row.mesh + " --mesh none", row.bits, class_name(row.ray_class),
                     exact ? "" : fmt::format(" --triangle-test {}", name_of(run.settings.test)), run.settings.seed,
                     f.index);
}

void print_failures(const StressRun& run) {
  constexpr int kMost = 20;
  int printed = 0;
  for (const StressRow& row : run.rows) {
    for (const stress::Failure& f : row.failures) {
      if (printed++ == kMost) return;
      fmt::print("{}: {}\n", kFaultNames[static_cast<size_t>(f.fault)], replay(run, row, f));
    }
  }
}

}  // namespace

Tally total_of(const StressRun& run) {
  Tally total;
  for (const StressRow& row : run.rows) total.add(row.tally);
  return total;
}

void print_stress(const StressRun& run) {
  const bool peers = has_peers(run);
  const auto print = [&](const char* head, const std::vector<Group>& groups) {
    if (!groups.empty()) fmt::print("{}\n", table_of(head, groups, peers).markdown());
  };
  print("rays", by_class(run));
  print("bits", by_bits(run));
  print("mesh", by_mesh(run));
  print("from inside", leaks(run));
  const Tally t = total_of(run);
  for (const bool at_most_bits : {false, true}) {
    const int bits = at_most_bits ? kMaxLatticeBits : kMaxLatticeBits - 1;
    const Tally d = displaced(run, at_most_bits);
    if (d[stress::kRays] == 0) continue;
    fmt::print(
        "snapping, {} 24 bits: moved by at most {:.4f} grid steps where a ray starts (bound {}), {:.4f} where it "
        "leaves ({})\n",
        at_most_bits ? "at" : "below", d.moved_near, stress::allowed_near(bits), d.moved_far,
        stress::allowed_far(bits));
  }
  fmt::print(
      "oracle: {} triangles decided in integers; {} rays against every triangle, the others against all in reach\n",
      t[stress::kExactTests], t[stress::kPlain]);
  fmt::print(
      "{} rays, {} misses, {} double counts, {} mismatches; {:.2f} % of {} triangle tests in double precision; {:.1f} "
      "s\n",
      t[stress::kRays], t[stress::kMisses], t[stress::kDoubleCounts], t[stress::kMismatches], 100 * double_share(t),
      t[stress::kTriangleTests], run.seconds);
  print_failures(run);
}

Json stress_json(const StressRun& run) {
  const bool peers = has_peers(run);
  Json j{{"version", 1}, {"tool", tools::version_text()}, {"device", run.device}};
  const Machine machine = this_machine();
  j["machine"] = {{"processor", machine.processor}, {"cores", machine.cores}, {"compiler", machine.compiler}};
  if (run.threads > 0) j["threads"] = run.threads;
  if (const auto embree = embree_version(); peers && embree) j["embree_version"] = *embree;
  j["triangle_test"] = name_of(run.settings.test);
  j["seed"] = run.settings.seed;
  j["seconds"] = run.seconds;
  j.update(counts_json(total_of(run), peers));
  j["displacement"] = displacement_json(run);
  j["classes"] = groups_json("class", by_class(run), peers);
  j["bits"] = groups_json("bits", by_bits(run), peers);
  j["meshes"] = groups_json("mesh", by_mesh(run), peers);
  j["from_inside"] = groups_json("mesh", leaks(run), peers);
  j["failures"] = Json::array();
  for (const StressRow& row : run.rows) {
    for (const stress::Failure& f : row.failures) {
      j["failures"].push_back({{"fault", kFaultNames[static_cast<size_t>(f.fault)]}, {"replay", replay(run, row, f)}});
    }
  }
  return j;
}

}  // namespace kd::bench
