#include "render/device_group.h"

#include <algorithm>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "render/strip.h"

namespace kd::render {

namespace {

/// The rows of a frame, handed out in strips, and what came of them.
class Rows {
 public:
  Rows(const image::Window& window, size_t devices, const Progress& progress)
      : rows_(window.height),
        devices_(static_cast<uint32_t>(devices)),
        least_rows_(std::min(window.height / devices_, kLeastPixels / window.width) + 1),
        progress_(progress) {}

  /// The next strip, or nothing when there are no rows left or a device failed. With several devices a strip is a share
  /// of what is left, so that the last strips are short and all devices end at about the same time.
  std::optional<Strip> take(uint32_t max_rows) {
    const std::lock_guard lock(mutex_);
    if (taken_ == rows_ || error_) return std::nullopt;
    uint32_t rows = rows_ - taken_;
    if (devices_ > 1) rows = std::min(rows, std::max(least_rows_, rows / (2 * devices_)));
    rows = std::min(rows, max_rows);
    const Strip strip{taken_, rows};
    taken_ += rows;
    ++strips_;
    return strip;
  }

  /// A strip's progress as the frame's.
  bool keep_going(Strip strip, double share) {
    const std::lock_guard lock(mutex_);
    if (error_) return false;
    return kd::keep_going(progress_, (done_ + share * strip.rows) / rows_);
  }

  void finish(Strip strip, const RenderStats& stats) {
    const std::lock_guard lock(mutex_);
    done_ += strip.rows;
    stats_ += stats;
  }

  void fail(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
  }

  const std::optional<Error>& error() const { return error_; }
  const RenderStats& stats() const { return stats_; }
  uint32_t strips() const { return strips_; }

 private:
  /// Fewer do not fill a GPU: on two H200 strips of 64 rows of 1920 pixels took a film back to the speed of one.
  static constexpr uint32_t kLeastPixels = 1 << 19;

  uint32_t rows_;
  uint32_t devices_;
  uint32_t least_rows_;
  const Progress& progress_;
  std::mutex mutex_;
  uint32_t taken_ = 0;
  uint32_t done_ = 0;
  uint32_t strips_ = 0;
  RenderStats stats_;
  std::optional<Error> error_;
};

/// One device's work on a frame; returns the time in its stages.
double work(Renderer& renderer, Rows& rows, Frame& frame) try {
  double seconds = 0;
  while (const auto strip = rows.take(renderer.max_rows())) {
    const auto stats = renderer.render(*strip, frame, [&](double share) { return rows.keep_going(*strip, share); });
    if (!stats) {
      rows.fail(stats.error());
      break;
    }
    seconds += stats->render_seconds;
    rows.finish(*strip, *stats);
  }
  return seconds;
} catch (const std::bad_alloc&) {  // which must not leave a thread
  rows.fail({ErrorClass::resource, "", "out of memory"});
  return 0;
}

}  // namespace

Result<DeviceGroup> DeviceGroup::open(std::vector<Device> devices, bool cpu_may_take_over, const LoadedScene& scene,
                                      const RenderSettings& settings) {
  DeviceGroup group;
  group.devices_ = std::move(devices);
  group.cpu_may_take_over_ = cpu_may_take_over;
  group.scene_ = &scene;
  group.settings_ = settings;
  auto opened = group.open_all();
  if (!opened && group.take_over(opened.error())) opened = group.open_all();
  if (!opened) return opened.error();
  return group;
}

Result<void> DeviceGroup::open_all() {
  for (const Device& device : devices_) {
    auto renderer = device.backend->open(*scene_, settings_, device.index);
    if (!renderer) {
      if (renderer.error().error_class == ErrorClass::object)
        return renderer.error();  // which no device is to blame for
      return Error{renderer.error().error_class, device.description, renderer.error().line()};
    }
    renderers_.push_back(std::move(*renderer));
  }
  return {};
}

bool DeviceGroup::take_over(const Error& error) {
  const bool device_failed = error.error_class == ErrorClass::device || error.error_class == ErrorClass::resource;
  if (!cpu_may_take_over_ || !device_failed || devices_.front().backend == cpu_device().backend) return false;
  taken_over_ = error.line();
  renderers_.clear();
  devices_ = {cpu_device()};
  devices_.front().reason = "it took over: " + taken_over_;
  return true;
}

Result<void> DeviceGroup::follow(const Moved& moved) {
  for (const auto& renderer : renderers_) {
    auto followed = renderer->follow(moved);
    if (followed) continue;
    return take_over(followed.error()) ? open_all() : followed;
  }
  return {};
}

Result<Frame> DeviceGroup::render(const Progress& progress) {
  auto frame = render_once(progress);
  if (frame || !take_over(frame.error())) return frame;
  if (auto opened = open_all(); !opened) return opened.error();
  return render_once(progress);
}

Result<Frame> DeviceGroup::render_once(const Progress& progress) {
  Frame frame = blank_frame(*scene_, settings_);
  Rows rows(scene_->window, renderers_.size(), progress);
  std::vector<double> seconds(renderers_.size());
  std::vector<std::thread> others;  // the first device works on this thread
  for (size_t i = 1; i < renderers_.size(); ++i) {
    others.emplace_back([&, i] { seconds[i] = work(*renderers_[i], rows, frame); });
  }
  seconds[0] = work(*renderers_[0], rows, frame);
  for (std::thread& other : others) other.join();
  if (rows.error()) return *rows.error();
  frame.stats = rows.stats();
  // They worked side by side.
  frame.stats.render_seconds = *std::max_element(seconds.begin(), seconds.end());
  strips_ = rows.strips();
  return frame;
}

Holding DeviceGroup::holding() const {
  Holding all;
  for (const auto& renderer : renderers_) {
    const Holding& one = renderer->holding();
    all.upload_seconds += one.upload_seconds;
    if (one.layout == TriangleLayout::compact) all.layout = one.layout;
    all.object_bytes += one.object_bytes;
    all.scene_bytes += one.scene_bytes;
    all.strip_bytes += one.strip_bytes;
    all.device_bytes += one.device_bytes;
  }
  return all;
}

}  // namespace kd::render
