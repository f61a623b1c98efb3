#include "kdbuild/batch.h"

#include <new>

#include "common/console.h"
#include "kdbuild/in_order.h"

namespace kd::tools {

namespace {

/// Whether to go on; else that is the item's error.
bool is_wanted(Item& item) {
  if (!interrupted()) return true;
  item.error = Error{ErrorClass::interrupted, item.job.input, "interrupted"};
  return false;
}

void look_at(Item& item, const BatchSettings& settings) {
  if (!is_wanted(item)) return;
  auto print = fingerprint(item.job.input, [](double) { return !interrupted(); });
  if (!print) {
    item.error = print.error();
    return;
  }
  item.fingerprint = std::move(*print);
  item.freshness = freshness(item.job, item.fingerprint.hash, settings.compile);
  if (settings.force) item.freshness = {"--force", {}, ""};
  item.report.objects = item.freshness.objects;
  item.report.scene = item.freshness.scene;
  item.report.files = item.fingerprint.files;
}

void build(Item& item, const BatchSettings& settings, const Progress& progress) {
  if (item.error || item.up_to_date() || !is_wanted(item)) return;
  try {
    auto built = build_source(item.job, item.fingerprint, settings.compile, *settings.claims, progress);
    if (!built) {
      item.error = built.error();
      return;
    }
    item.report = std::move(*built);
    if (!item.report.failed.empty()) item.error = item.report.failed.front();
  } catch (const std::bad_alloc&) {  // the next source may be smaller
    item.error = Error{ErrorClass::resource, item.job.input, "out of memory"};
  }
}

}  // namespace

std::vector<Item> look_at(const std::vector<Job>& jobs, const BatchSettings& settings) {
  std::vector<Item> items;
  items.reserve(jobs.size());
  for (const Job& job : jobs) items.push_back({job, {}, {}, std::nullopt, {}});
  in_order(
      items.size(), settings.at_once, [&](size_t i) { look_at(items[i], settings); }, [](size_t) {});
  return items;
}

void build_items(std::vector<Item>& items, const BatchSettings& settings, const Progress& progress,
                 const std::function<void(const Item&)>& after) {
  in_order(
      items.size(), settings.at_once, [&](size_t i) { build(items[i], settings, progress); },
      [&](size_t i) { after(items[i]); });
}

}  // namespace kd::tools
