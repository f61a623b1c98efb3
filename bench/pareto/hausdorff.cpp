#include "pareto/hausdorff.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "sys/parallel.h"

namespace kd::bench {

namespace {

double area(const Corners& c) { return 0.5 * length(cross(c[1] - c[0], c[2] - c[0])); }

/// visit(p) for a triangle's samples.
template <class Visit>
void for_each_sample(const Corners& c, double largest_part, const Visit& visit) {
  for (Vec3d p : c) visit(p);
  const auto n = static_cast<int>(std::ceil(std::sqrt(std::max(1.0, area(c) / largest_part))));
  const Vec3d u = (c[1] - c[0]) * (1.0 / n), v = (c[2] - c[0]) * (1.0 / n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      visit(c[0] + u * (i + 1.0 / 3) + v * (j + 1.0 / 3));
      if (i + j + 1 < n) visit(c[0] + u * (i + 2.0 / 3) + v * (j + 2.0 / 3));
    }
  }
}

/// The largest distance of a sample of `from` to `to`.
double farthest(const SampledSurface& from, const ReferenceTracer& to, uint64_t parts, std::atomic<uint64_t>& samples) {
  const std::vector<Corners>& triangles = from.surface.triangles();
  double whole = 0;
  for (const Corners& c : triangles) whole += area(c);
  const double largest_part = whole / static_cast<double>(parts);
  PerThread<double> far(0.0);
  parallel_ranges(triangles.size(), 256, [&](size_t begin, size_t end) {
    uint64_t count = 0;
    for (size_t i = begin; i < end; ++i) {
      const Corners* near = from.counterpart(static_cast<uint32_t>(i));
      for_each_sample(triangles[i], largest_part, [&](Vec3d p) {
        ++count;
        const double known = near ? length(nearest_point(*near, p) - p) : std::numeric_limits<double>::infinity();
        if (known > far.local()) far.local() = std::max(far.local(), to.distance(p, known));
      });
    }
    samples += count;
  });
  return far.combine([](double a, double b) { return std::max(a, b); });
}

}  // namespace

Hausdorff hausdorff(const SampledSurface& source, const SampledSurface& form, uint64_t parts) {
  std::atomic<uint64_t> samples = 0;
  const double to_form = farthest(source, form.surface, parts, samples);
  const double to_source = farthest(form, source.surface, parts, samples);
  return {to_form, to_source, samples};
}

}  // namespace kd::bench
