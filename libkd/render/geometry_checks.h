// Objects' geometry, checked on other threads while what needs none of it goes on: a device is opened, or the object
// before is uploaded.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <span>
#include <vector>

#include "nkd/object_file.h"

namespace kd::render {

class GeometryChecks {
 public:
  GeometryChecks() = default;
  GeometryChecks(GeometryChecks&&) = default;
  /// Gives up what has not begun, and waits for the rest.
  ~GeometryChecks();

  /// Begins to check them, the first ones first. They outlive the checks and keep their place in memory.
  void start(std::vector<const nkd::ObjectFile*> files);
  /// Waits until it is known of a file, by its place among them. Errors as ObjectFile::check_geometry. What has not
  /// been started is sound.
  Result<void> sound(size_t file) const;
  /// The same of all; the error is that of the first file that has one.
  Result<void> all_sound() const;

 private:
  std::vector<std::shared_future<Result<void>>> checks_;
  std::unique_ptr<std::atomic<bool>> given_up_;
  std::future<void> running_;  // the last member: gone, and so waited for, before what it uses
};

}  // namespace kd::render
