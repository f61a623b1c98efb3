// The AOV `visits`: what the pixel's ray costs, by tracing it once more and counting.
#pragma once

#include "render/stages/object_intersection.h"
#include "render/stages/ray_generation.h"
#include "render/view.h"

namespace kd::render {

template <class Instances>
struct CountVisits {
  static constexpr const char* kName = "aov";
  FrameView frame;
  uint32_t* words = nullptr;  // two a pixel: inner nodes, triangles

  struct Visits {
    uint32_t nodes = 0, triangles = 0;
    KD_HD void node() { ++nodes; }
    KD_HD void leaf() {}
    KD_HD void triangle() { ++triangles; }
    KD_HD void evaluated_in_double() {}
  };

  KD_HD uint32_t operator()(uint32_t pixel) const {
    Visits visits;
    closest_hit<Instances>(frame.scene, primary_ray(frame, pixel), visits);
    words[2 * static_cast<uint64_t>(pixel)] = visits.nodes;
    words[2 * static_cast<uint64_t>(pixel) + 1] = visits.triangles;
    return 0;
  }
};

}  // namespace kd::render
