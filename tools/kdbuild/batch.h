// A run over many sources: which need building, building them, and what came of each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kdbuild/build_source.h"
#include "kdbuild/fingerprint.h"
#include "kdbuild/freshness.h"

namespace kd::tools {

/// One source of a run.
struct Item {
  Job job;
  Fingerprint fingerprint;
  Freshness freshness;
  std::optional<Error> error;  // what kept it from being built, or all of it
  SourceReport report;         // without an error: of what was built, or else found up to date

  bool up_to_date() const { return !error && freshness.stale.empty(); }
  /// The file that stands for all that the source is made into.
  const std::string& output() const { return report.scene.empty() ? report.objects.front().output : report.scene; }
};

struct BatchSettings {
  CompileSettings compile;
  bool force = false;
  size_t at_once = 1;
  Claims* claims = nullptr;  // while building
};

/// Looks at each source and at what stands in its place. Sources that cannot be read get their error.
std::vector<Item> look_at(const std::vector<Job>& jobs, const BatchSettings& settings);

/// Builds what has to be, and calls `after` for each item in order, as soon as all before it are done. `progress` is
/// told of what one source alone is doing, by several threads if several are built at once.
void build_items(std::vector<Item>& items, const BatchSettings& settings, const Progress& progress,
                 const std::function<void(const Item&)>& after);

}  // namespace kd::tools
