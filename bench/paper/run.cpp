#include "paper/run.h"

#include <fmt/format.h>

namespace kd::bench::paper {

Result<Division> divide(const FrameView& frame, uint32_t lights, const Job& job, Run& run) {
  const uint32_t rows = rows_that_fit(job.form, frame, lights, job.most_bytes);
  const auto buffers = [&](uint64_t count) {
    return buffers_of(job.form, count * frame.width, frame.scene.instance_count, lights);
  };
  if (rows == 0) {
    return Error{ErrorClass::resource, "",
                 fmt::format("one row of the film takes {} MiB of buffers, {} instances and {} lights for each of its "
                             "pixels: allow more with --buffers",
                             (buffers(1).bytes() >> 20) + 1, frame.scene.instance_count, lights)};
  }
  const uint64_t kept = uint64_t{frame.width} * frame.height * (sizeof(SurfaceHit) + sizeof(render::Pixel));
  run.strips = (frame.height + rows - 1) / rows;
  run.frame_bytes = buffers(rows).bytes() + kept;
  run.undivided_bytes = buffers(frame.height).bytes() + kept;
  return Division{rows, buffers(rows)};
}

}  // namespace kd::bench::paper
