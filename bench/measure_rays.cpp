#include "measure_rays.h"

#include <algorithm>

#include "common/numbers.h"

namespace kd::bench {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

Result<ImageSize> parse_size(const std::string& text) {
  constexpr uint64_t kMostPixels = uint64_t{1} << 26;
  const Error refusal{ErrorClass::usage, "--size " + text, "not a size such as 1920x1080, of at most 2^26 pixels"};
  const auto sides = tools::parse_numbers(text, 'x');
  if (!sides || sides->size() != 2) return refusal;
  const ImageSize size{sides->front(), sides->back()};
  const uint64_t pixels = uint64_t{size.width} * size.height;
  if (size.width > 65536 || size.height > 65536 || pixels < 1 || pixels > kMostPixels) return refusal;
  return size;
}

Result<RayMeasurement> measure_rays(const render::Device& device, const nkd::ObjectFile& object, const char* name,
                                    std::span<const render::RayRecord> rays, RayMode mode, render::TriangleTest test,
                                    const Effort& effort, bool diffuse) {
  const bool scattered = effort.scattered == Scattered::all || (diffuse && effort.scattered == Scattered::diffuse);
  const bool can_be = test == render::TriangleTest::exact && device.backend->name != "cpu";
  const render::TraceJob job{rays, mode,          effort.warm_ups, effort.repeats,     effort.count_steps,
                             test, effort.layout, effort.packets,  scattered && can_be};
  auto outcome = device.backend->trace(object, job, device.index);
  if (!outcome) return outcome.error();
  RayMeasurement m{name, mode, job.scattered, rays.size(), ray_hash(rays), 0, 0, std::move(*outcome)};
  double sum_t = 0;
  for (const render::HitRecord& hit : m.outcome.hits) {
    if (hit.primitive < 0) continue;
    ++m.hit_count;
    sum_t += hit.t;
  }
  if (m.hit_count > 0) m.mean_t = sum_t / static_cast<double>(m.hit_count);
  return m;
}

SharedTrace::SharedTrace(const SharedCamera& camera, ImageSize size)
    : camera_(camera), primary_(primary_rays(camera, size.width, size.height)) {}

Result<std::array<RayMeasurement, 3>> SharedTrace::measure(const render::Device& device, const nkd::ObjectFile& object,
                                                           render::TriangleTest test, const Effort& effort) {
  auto primary = measure_rays(device, object, "primary", primary_.rays, RayMode::closest, test, effort);
  if (!primary) return primary.error();
  if (!secondary_) secondary_ = secondary_rays(object, camera_, primary_, primary->outcome.hits);
  auto shadow = measure_rays(device, object, "shadow", secondary_->shadow, RayMode::any, test, effort);
  if (!shadow) return shadow.error();
  auto diffuse = measure_rays(device, object, "diffuse", secondary_->diffuse, RayMode::closest, test, effort, true);
  if (!diffuse) return diffuse.error();
  return std::array{std::move(*primary), std::move(*shadow), std::move(*diffuse)};
}

}  // namespace kd::bench
