#include "scene/expansion.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scene/nesting.h"
#include "scene/placement.h"
#include "sys/parallel.h"

namespace kd::scene {

namespace {

/// A parallel loop takes at least about so many instances at once.
constexpr size_t kInstanceGrain = 256;

size_t grain_of(size_t pieces, size_t instances) {
  return std::max<size_t>(1, kInstanceGrain * pieces / std::max<size_t>(1, instances));
}

Box3d placed_box(const Frame& lattice_to_scene, const Lattice& lattice) {
  const Box3u cube = lattice.cube();
  Box3d box;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3u q{corner & 1 ? cube.hi.x : 0, corner & 2 ? cube.hi.y : 0, corner & 4 ? cube.hi.z : 0};
    box.extend(lattice_to_scene.apply_point(vec_cast<double>(q)));
  }
  return box;
}

bool same_bits(const Frame& a, const Frame& b) { return std::memcmp(&a, &b, sizeof(Frame)) == 0; }

template <class... Kinds>
bool has_keys(const std::variant<Kinds...>& placement) {
  const auto* transform = std::get_if<TransformPlacement>(&placement);
  return transform && !transform->keys.empty();
}

std::string called(const Scene& scene, const Part& part) {
  if (!part.name.empty()) return fmt::format("part '{}'", part.name);
  return fmt::format("a part of '{}'",
                     part.character ? scene.characters[*part.character].name : scene.objects[part.object].name);
}

std::string called(const Scene&, const Character& character) {
  return character.name.empty() ? "a character" : fmt::format("character '{}'", character.name);
}

template <class Placed>
Error placement_error(const Scene& scene, const Placed& placed, std::string_view what) {
  return {ErrorClass::scene, fmt::format("{}:{}", scene.path, placed.line),
          fmt::format("{}: {}", called(scene, placed), what)};
}

constexpr std::string_view kSingular =
    "the placement is singular: its axes must be finite, not zero, and not lie in a plane";
constexpr std::string_view kSingularTogether =
    "the placement is singular together with those around it: its axes must not lie in a plane";
constexpr std::string_view kOutOfRange =
    "the placement leaves the range of double precision: bring it nearer or scale it less";

/// Keeps the error of the first instance that has one, whichever thread met it first.
class FirstError {
 public:
  void add(uint32_t instance, Error error) {
    const std::lock_guard lock(mutex_);
    if (error_ && instance >= instance_) return;
    instance_ = instance;
    error_ = std::move(error);
  }
  Result<void> result() const { return error_ ? Result<void>(*error_) : Result<void>(); }

 private:
  std::mutex mutex_;
  uint32_t instance_ = 0;
  std::optional<Error> error_;
};

}  // namespace

/// Walks down from the shown characters, composing frames. With `moved`, only to what moves.
class Placer {
 public:
  Placer(const Expansion& expansion, double frame, std::span<Instance> out, std::span<uint8_t> moved)
      : expansion_(expansion), scene_(*expansion.scene_), frame_(frame), out_(out), moved_(moved) {}

  Result<void> place() {
    const auto& roots = only_moving() ? expansion_.moving_roots_ : expansion_.roots_;
    parallel_ranges(roots.size(), grain_of(roots.size(), expansion_.count_), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) place_character(roots[i].character, {}, roots[i].first);
    });
    return errors_.result();
  }

 private:
  bool only_moving() const { return !moved_.empty(); }

  /// A part or a character on the way down to an instance.
  struct Level {
    const Level* outer = nullptr;
    Frame to_scene;
    uint32_t material = kOwnMaterials;  // of the outermost part that has one
    bool moves = false;                 // by keys of its own or further out
    const Part* part = nullptr;
    const Character* character = nullptr;
  };

  void place_character(uint32_t index, const Level& outer, uint32_t first) {
    const Character& character = scene_.characters[index];
    const Expansion::CharacterPlan& plan = expansion_.plans_[index];
    const Level level{&outer,         compose(outer.to_scene, placement_frame(character.placement, frame_)),
                      outer.material, outer.moves || plan.has_keys,
                      nullptr,        &character};
    const bool all = !only_moving() || level.moves;
    const size_t count = all ? character.parts.size() : plan.moving.size();
    parallel_ranges(count, grain_of(count, plan.count), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const size_t k = all ? i : plan.moving[i];
        place_part(character.parts[k], level, first + plan.first[k], plan.material[k]);
      }
    });
  }

  void place_part(const Part& part, const Level& outer, uint32_t first, uint32_t material) {
    const Level level{&outer,
                      compose(outer.to_scene, placement_frame(part.placement, frame_)),
                      outer.material == kOwnMaterials ? material : outer.material,
                      outer.moves || has_keys(part.placement),
                      &part,
                      nullptr};
    if (part.character) {
      place_character(*part.character, level, first);
    } else {
      place_instance(part, level, first);
    }
  }

  void place_instance(const Part& part, const Level& level, uint32_t index) {
    if (!expansion_.slots_.empty()) index = expansion_.slots_[index];
    if (index == Expansion::kForgotten) return;
    if (is_singular(level.to_scene)) return errors_.add(index, singular_error(level));
    const Expansion::ObjectFrames& object = expansion_.objects_[part.object];
    const bool box = std::holds_alternative<BoxPlacement>(part.placement);
    Instance instance;
    instance.object = part.object;
    instance.material = level.material;
    instance.lattice_to_scene = compose(level.to_scene, box ? object.unit_cube : object.model);
    if (only_moving()) {
      if (same_bits(instance.lattice_to_scene, out_[index].lattice_to_scene)) return;
      moved_[index] = 1;
    }
    instance.scene_to_lattice = invert(instance.lattice_to_scene);
    instance.box_scene = placed_box(instance.lattice_to_scene, object.lattice);
    const InverseFrame& back = instance.scene_to_lattice;
    if (!is_finite(instance.box_scene.lo) || !is_finite(instance.box_scene.hi) || !is_finite(back.x_row) ||
        !is_finite(back.y_row) || !is_finite(back.z_row)) {
      return errors_.add(index, placement_error(scene_, part, kOutOfRange));
    }
    out_[index] = instance;
  }

  /// Blames the outermost placement that is singular by itself, or else the part.
  Error singular_error(const Level& level) const {
    std::optional<Error> error;
    for (const Level* at = &level; at->outer; at = at->outer) {
      if (at->part && is_singular(placement_frame(at->part->placement, frame_))) {
        error = placement_error(scene_, *at->part, kSingular);
      } else if (at->character && is_singular(placement_frame(at->character->placement, frame_))) {
        error = placement_error(scene_, *at->character, kSingular);
      }
    }
    return error ? *error : placement_error(scene_, *level.part, kSingularTogether);
  }

  const Expansion& expansion_;
  const Scene& scene_;
  double frame_;
  std::span<Instance> out_;
  std::span<uint8_t> moved_;
  FirstError errors_;
};

Result<Expansion> Expansion::of(const Scene& scene, std::span<const Lattice> lattices) {
  const InstanceCounts counts = count_instances(scene);
  if (counts.fault) {
    const Part& part = scene.characters[counts.fault->character].parts[counts.fault->part];
    return placement_error(scene, part, counts.fault->what);
  }
  Expansion out(scene);
  uint32_t materials = 0;
  for (uint32_t i = 0; i < scene.characters.size(); ++i) {
    const Character& character = scene.characters[i];
    CharacterPlan& plan = out.plans_[i];
    plan.count = counts.of_character[i];
    plan.first.reserve(character.parts.size());
    plan.material.reserve(character.parts.size());
    uint32_t first = 0;
    for (const Part& part : character.parts) {
      plan.first.push_back(first);
      plan.material.push_back(part.material ? materials++ : kOwnMaterials);
      first += part.character ? counts.of_character[*part.character] : 1;
    }
    if (!character.shown) continue;
    out.roots_.push_back({i, out.count_});
    out.count_ += counts.of_character[i];
  }
  for (const Root& root : out.roots_) {
    out.find_moving(root.character);
    if (!out.plans_[root.character].moves()) continue;
    out.moving_roots_.push_back(root);
    out.list_moving(root.character, root.first);
  }
  for (const Lattice& lattice : lattices) out.objects_.push_back({lattice.frame(), unit_cube_frame(lattice), lattice});
  return out;
}

/// Fills in what moves in a character's plan and in those below it, once each.
void Expansion::find_moving(uint32_t index) {
  CharacterPlan& plan = plans_[index];
  if (std::exchange(plan.searched, true)) return;
  const Character& character = scene_->characters[index];
  plan.has_keys = has_keys(character.placement);
  for (uint32_t k = 0; k < character.parts.size(); ++k) {
    const Part& part = character.parts[k];
    if (part.character) find_moving(*part.character);
    if (has_keys(part.placement) || (part.character && plans_[*part.character].moves())) plan.moving.push_back(k);
  }
}

void Expansion::list_moving(uint32_t index, uint32_t first) {
  const CharacterPlan& plan = plans_[index];
  if (plan.has_keys) return list_moving({first, plan.count});
  for (const uint32_t k : plan.moving) {
    const Part& part = scene_->characters[index].parts[k];
    if (part.character && !has_keys(part.placement)) {
      list_moving(*part.character, first + plan.first[k]);
    } else {
      list_moving({first + plan.first[k], part.character ? plans_[*part.character].count : 1});
    }
  }
}

void Expansion::list_moving(Range range) {
  if (!moving_.empty() && moving_.back().first + moving_.back().count == range.first) {
    moving_.back().count += range.count;
  } else {
    moving_.push_back(range);
  }
}

std::vector<uint8_t> Expansion::front_only() const {
  const auto asks = [](const Part& part) { return part.sides == Sides::front; };
  const auto& characters = scene_->characters;
  if (std::none_of(characters.begin(), characters.end(),
                   [&](const Character& c) { return std::any_of(c.parts.begin(), c.parts.end(), asks); }))
    return {};
  std::vector<uint8_t> marks(count_, 0);
  for (const Root& root : roots_) mark_sides(root.character, root.first, std::nullopt, marks);
  if (std::find(marks.begin(), marks.end(), 1) == marks.end()) marks.clear();
  return marks;
}

void Expansion::mark_sides(uint32_t character, uint32_t first, std::optional<Sides> outer,
                           std::span<uint8_t> marks) const {
  const std::vector<Part>& parts = scene_->characters[character].parts;
  for (uint32_t k = 0; k < parts.size(); ++k) {
    const std::optional<Sides> sides = outer ? outer : parts[k].sides;
    const uint32_t instance = first + plans_[character].first[k];
    if (parts[k].character) {
      mark_sides(*parts[k].character, instance, sides, marks);
    } else if (const uint32_t slot = slots_.empty() ? instance : slots_[instance]; slot != kForgotten) {
      marks[slot] = sides == Sides::front;
    }
  }
}

void Expansion::keep(std::span<const uint8_t> kept) {
  slots_.assign(count_, kForgotten);
  count_ = 0;
  for (size_t i = 0; i < slots_.size(); ++i) {
    if (kept[i]) slots_[i] = count_++;
  }
  for (const Range& range : std::exchange(moving_, {})) {
    for (uint32_t i = range.first; i < range.first + range.count; ++i) {
      if (kept[i]) list_moving({slots_[i], 1});
    }
  }
}

Result<void> Expansion::place_all(double frame, std::span<Instance> out) const {
  return Placer(*this, frame, out, {}).place();
}

Result<void> Expansion::place_moving(double frame, std::span<Instance> out, std::span<uint8_t> moved) const {
  return moving_.empty() ? Result<void>() : Placer(*this, frame, out, moved).place();
}

}  // namespace kd::scene
