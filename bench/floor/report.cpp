#include "floor/report.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "table.h"

namespace kd::bench::floors {

namespace {

using tools::Json;

std::string stem_of(const ObjectResult& object) { return std::filesystem::path(object.object).stem().string(); }

double giga(double count) { return 1e-9 * count; }
std::string mrays(const ClassResult& rays, double seconds) {
  return fmt::format("{:.1f}", 1e-6 * static_cast<double>(rays.rays) / seconds);
}

/// Means a ray.
struct Means {
  explicit Means(const ClassResult& c) : count(static_cast<double>(std::max<uint64_t>(c.rays, 1))) {}
  double operator()(uint64_t n) const { return static_cast<double>(n) / count; }
  double operator()(double n) const { return n / count; }
  double count;
};

Json loads_json(const LoadRates& loads) { return {{"of_8_bytes", loads.of_8}, {"of_16_bytes", loads.of_16}}; }

Json chip_json(const ChipRates& chip) {
  const InstructionRates& i = chip.instructions;
  return {{"instructions_per_second",
           {{"issue", i.issue},
            {"fma", i.fma},
            {"logic", i.logic},
            {"min_max", i.min_max},
            {"fp64", i.fp64},
            {"convert", i.convert}}},
          {"loads_per_second", {{"l1", loads_json(chip.l1)}, {"dram", loads_json(chip.dram)}}},
          {"streamed_bytes_per_second", chip.streamed}};
}

Json class_json(const ObjectResult& object, const ClassResult& c, const std::optional<ChipRates>& chip) {
  const Means a_ray(c);
  const Work& w = c.work.rays;
  const Cost cost = w.cost(costs_of(c.mode));
  const Loads loads = loads_of(w);
  Json j{{"class", c.name},
         {"rays", c.rays},
         {"hits", w.hits},
         {"per_ray",
          {{"nodes", a_ray(w.steps)},
           {"leaves", a_ray(w.leaves)},
           {"triangles", a_ray(w.triangles)},
           {"in_double", a_ray(w.in_double)},
           {"instructions", a_ray(cost.issued)},
           {"alu_instructions", a_ray(cost.alu)},
           {"fp64_instructions", a_ray(cost.fp64)},
           {"conversions", a_ray(cost.convert)},
           {"bytes_loaded", a_ray(loads.bytes)},
           {"bytes_streamed", a_ray(loads.streamed)}}},
         {"lanes", lanes_of(c)},
         {"measured_seconds", c.seconds}};
  if (!chip) return j;
  const Floors f = floors_of(object, c, *chip);
  j["floor_seconds"] = {{"instructions_full_lanes", f.full.seconds},
                        {"instructions_lockstep", f.lockstep.seconds},
                        {"loads_l1", f.l1},
                        {"loads_object", f.object},
                        {"streamed", f.streamed}};
  j["pipe"] = f.lockstep.pipe;
  return j;
}

}  // namespace

Floors floors_of(const ObjectResult& object, const ClassResult& rays, const ChipRates& chip) {
  const KernelCosts& costs = costs_of(rays.mode);
  const Loads loads = loads_of(rays.work.rays);
  const auto seconds = [&](const LoadRates& rates) {
    return static_cast<double>(loads.of_8) / rates.of_8 + static_cast<double>(loads.of_16) / rates.of_16;
  };
  return {bound_of(rays.work.rays.cost(costs), chip.instructions),
          bound_of(rays.work.warps.cost(costs) * 32, chip.instructions), seconds(chip.l1), seconds(*object.loads),
          static_cast<double>(loads.streamed) / chip.streamed};
}

double lanes_of(const ClassResult& rays) {
  const KernelCosts& costs = costs_of(rays.mode);
  const double by_warps = rays.work.warps.cost(costs).issued;
  return by_warps > 0 ? rays.work.rays.cost(costs).issued / by_warps : 0;
}

std::string chip_table(const ChipRates& chip) {
  Table table({"the chip, measured", "10^9 a second"});
  const auto add = [&](const char* name, double rate) { table.add({name, fmt::format("{:.0f}", giga(rate))}); };
  const InstructionRates& i = chip.instructions;
  add("instructions issued", i.issue);
  add("FP32 multiply-adds", i.fma);
  add("logic", i.logic);
  add("minima and maxima", i.min_max);
  add("FP64 multiply-adds", i.fp64);
  add("conversions", i.convert);
  add("8-byte loads, L1", chip.l1.of_8);
  add("16-byte loads, L1", chip.l1.of_16);
  add("8-byte loads, DRAM", chip.dram.of_8);
  add("16-byte loads, DRAM", chip.dram.of_16);
  add("bytes streamed", chip.streamed);
  return table.markdown();
}

std::string work_table(const std::vector<ObjectResult>& objects) {
  Table table({"object", "rays", "nodes", "leaves", "triangles", "in double", "instructions", "ALU", "FP64",
               "conversions", "bytes", "lanes"});
  for (const ObjectResult& object : objects) {
    for (const ClassResult& c : object.classes) {
      const Means a_ray(c);
      const Work& w = c.work.rays;
      const Cost cost = w.cost(costs_of(c.mode));
      const Loads loads = loads_of(w);
      const auto one = [&](auto count) { return fmt::format("{:.1f}", a_ray(count)); };
      const auto none = [&](auto count) { return fmt::format("{:.0f}", a_ray(count)); };
      table.add({stem_of(object), c.name, one(w.steps), one(w.leaves), one(w.triangles), one(w.in_double),
                 none(cost.issued), none(cost.alu), none(cost.fp64), none(cost.convert),
                 none(loads.bytes + loads.streamed), fmt::format("{:.1f}", lanes_of(c))});
    }
  }
  return table.markdown();
}

std::string floor_table(const std::vector<ObjectResult>& objects, const ChipRates& chip) {
  Table table({"object", "rays", "full lanes", "lockstep", "waits for", "loads, L1", "loads, object", "streamed",
               "measured", "of full lanes", "of lockstep"});
  for (const ObjectResult& object : objects) {
    for (const ClassResult& c : object.classes) {
      if (c.rays == 0) continue;
      const Floors f = floors_of(object, c, chip);
      const auto share = [&](const Bound& bound) { return fmt::format("{:.0f} %", 100 * bound.seconds / c.seconds); };
      table.add({stem_of(object), c.name, mrays(c, f.full.seconds), mrays(c, f.lockstep.seconds), f.lockstep.pipe,
                 mrays(c, f.l1), mrays(c, f.object), mrays(c, f.streamed), mrays(c, c.seconds), share(f.full),
                 share(f.lockstep)});
    }
  }
  return table.markdown();
}

void add_results(Json& report, const std::vector<ObjectResult>& objects, const std::optional<ChipRates>& chip) {
  if (chip) report["chip"] = chip_json(*chip);
  for (const ObjectResult& object : objects) {
    Json j{{"object", object.object}, {"triangles", object.triangles}, {"device_bytes", object.device_bytes}};
    if (object.loads) j["loads_per_second"] = loads_json(*object.loads);
    for (const ClassResult& c : object.classes) j["classes"].push_back(class_json(object, c, chip));
    report["objects"].push_back(std::move(j));
  }
}

}  // namespace kd::bench::floors
