// The options of the commands that time rays: on what, and how often.
#pragma once

#include <string>

#include "common/console.h"
#include "measure_rays.h"

namespace kd::bench {

struct RayOptions {
  std::string device = "auto";
  unsigned threads = 0;
  Effort effort;
};

inline void add_ray_options(CLI::App& c, RayOptions& o) {
  c.add_option("--device", o.device, "auto, cpu, cuda or cuda:N")->capture_default_str();
  c.add_option("--threads", o.threads, "CPU threads; 0: all cores")
      ->check(tools::whole_number(0, 4096))
      ->capture_default_str();
  c.add_option("--repeat", o.effort.repeats, "Timed runs")
      ->check(tools::whole_number(1, 100000))
      ->capture_default_str();
  c.add_option("--warm-up", o.effort.warm_ups, "Untimed runs before them")
      ->check(tools::whole_number(0, 1000))
      ->capture_default_str();
}

}  // namespace kd::bench
