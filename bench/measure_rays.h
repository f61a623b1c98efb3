// Rays against one object on a device, traced and timed: the measuring that commands share.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/backend.h"
#include "shared_rays.h"

namespace kd::bench {

/// Of at least one value; the mean of the middle two where there are two.
double median(std::vector<double> values);

/// Pixels of the shared rays; at most 2^26, so that three classes of rays and their hits take no more than 10 GiB.
struct ImageSize {
  uint32_t width = 0;
  uint32_t height = 0;
};

/// "1920x1080". ErrorClass::usage.
Result<ImageSize> parse_size(const std::string& text);

/// Which rays are taken as having nothing to do with their neighbours (CUDA and the exact test only).
enum class Scattered { none, diffuse, all };

/// What is asked of every ray: nothing of it changes a hit.
struct Effort {
  int warm_ups = 3;
  int repeats = 10;          // >= 1
  bool count_steps = false;  // CPU only
  TriangleLayout layout = TriangleLayout::expanded;
  bool packets = true;  // CPU and the exact test only
  Scattered scattered = Scattered::diffuse;
};

/// What one class of rays came to.
struct RayMeasurement {
  const char* name = "";
  RayMode mode = RayMode::closest;
  bool scattered = false;  // as they were taken
  uint64_t rays = 0;
  uint64_t ray_hash = 0;
  uint64_t hit_count = 0;
  double mean_t = 0;  // of the hits; 0 without any
  render::TraceOutcome outcome;

  double seconds() const { return median(outcome.seconds); }
  double mrays_per_second() const { return static_cast<double>(rays) / seconds() * 1e-6; }
};

/// Errors as those of the device's backend. `diffuse`: the rays are.
Result<RayMeasurement> measure_rays(const render::Device& device, const nkd::ObjectFile& object, const char* name,
                                    std::span<const render::RayRecord> rays, RayMode mode, render::TriangleTest test,
                                    const Effort& effort, bool diffuse = false);

/// The shared rays of one camera, for one mesh in any number of objects: the secondary rays start where the primary
/// rays hit the first of them, so that all objects get the same rays.
class SharedTrace {
 public:
  SharedTrace(const SharedCamera& camera, ImageSize size);

  /// Primary, shadow and diffuse, in this order.
  Result<std::array<RayMeasurement, 3>> measure(const render::Device& device, const nkd::ObjectFile& object,
                                                render::TriangleTest test, const Effort& effort);
  /// Shadow rays whose surface faces the light. After the first `measure`.
  uint64_t facing() const { return secondary_->facing; }

 private:
  SharedCamera camera_;
  PrimaryRays primary_;
  std::optional<SecondaryRays> secondary_;
};

}  // namespace kd::bench
