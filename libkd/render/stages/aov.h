// AOVs: what is known of a pixel's hit, as words of a buffer of its own (image/channels.h says what each holds).
#pragma once

#include <bit>
#include <limits>

#include "image/channels.h"
#include "render/stages/ray_generation.h"
#include "render/stages/surface.h"
#include "render/view.h"

namespace kd::render {

struct WriteAov {
  static constexpr const char* kName = "aov";
  FrameView frame;
  image::Aov aov = image::Aov::depth;
  uint32_t* words = nullptr;

  KD_HD uint32_t operator()(uint32_t pixel) const {
    const SurfaceHit& hit = frame.hits[pixel];
    const bool met = hit.instance != kNone;
    const auto scalar = [&](uint32_t word) { words[pixel] = word; };
    const auto vector = [&](Vec3d v) {
      uint32_t* out = words + 3 * static_cast<uint64_t>(pixel);
      out[0] = bits(v.x);
      out[1] = bits(v.y);
      out[2] = bits(v.z);
    };
    switch (aov) {
      case image::Aov::depth:
        scalar(bits(met ? hit.t : std::numeric_limits<double>::infinity()));
        break;
      case image::Aov::normal:
        vector(met ? surface_at(frame.scene, hit, primary_direction(frame, pixel)).shading : Vec3d{0, 0, 0});
        break;
      case image::Aov::position:
        vector(met ? surface_at(frame.scene, hit, primary_direction(frame, pixel)).position : Vec3d{0, 0, 0});
        break;
      case image::Aov::object:
        scalar(met ? frame.scene.object_numbers[frame.scene.instances[hit.instance].object] : kNone);
        break;
      case image::Aov::instance:
        scalar(met && frame.scene.instance_numbers ? frame.scene.instance_numbers[hit.instance] : hit.instance);
        break;
      case image::Aov::primitive:
        scalar(met ? source_primitive(hit) : kNone);
        break;
      case image::Aov::bary:
        words[2 * static_cast<uint64_t>(pixel)] = bits(hit.u);
        words[2 * static_cast<uint64_t>(pixel) + 1] = bits(hit.v);
        break;
      case image::Aov::visits:  // CountVisits
        break;
    }
    return 0;
  }

 private:
  KD_HD static uint32_t bits(double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); }
  KD_HD uint32_t source_primitive(const SurfaceHit& hit) const {
    const uint32_t* sources = frame.scene.objects[frame.scene.instances[hit.instance].object].source_primitives;
    return sources ? sources[hit.triangle] : hit.triangle;
  }
};

}  // namespace kd::render
