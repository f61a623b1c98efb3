#include "render/geometry_checks.h"

#include "sys/parallel.h"

namespace kd::render {

GeometryChecks::~GeometryChecks() {
  if (given_up_) *given_up_ = true;
}

void GeometryChecks::start(std::vector<const nkd::ObjectFile*> files) {
  if (files.empty()) return;
  std::vector<std::packaged_task<Result<void>()>> tasks;
  for (const nkd::ObjectFile* file : files) {
    checks_.push_back(tasks.emplace_back([file] { return file->check_geometry(); }).get_future().share());
  }
  given_up_ = std::make_unique<std::atomic<bool>>(false);
  running_ = std::async(std::launch::async, [tasks = std::move(tasks), given_up = given_up_.get()]() mutable {
    parallel_ranges(tasks.size(), 1, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end && !*given_up; ++i) tasks[i]();
    });
  });
}

Result<void> GeometryChecks::sound(size_t file) const {
  return file < checks_.size() ? checks_[file].get() : Result<void>();
}

Result<void> GeometryChecks::all_sound() const {
  for (size_t i = 0; i < checks_.size(); ++i) {
    if (auto sound = checks_[i].get(); !sound) return sound;
  }
  return {};
}

}  // namespace kd::render
