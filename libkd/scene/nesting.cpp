#include "scene/nesting.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace kd::scene {

namespace {

constexpr uint32_t kUncounted = 0xffffffffu;

/// Depth first, each character once. What is open is a path, never longer than kMaxNesting.
class Counter {
 public:
  explicit Counter(const Scene& scene)
      : scene_(scene), depth_(scene.characters.size(), 0), open_(scene.characters.size(), false) {
    counts_.of_character.assign(scene.characters.size(), kUncounted);
  }

  InstanceCounts count() {
    uint64_t shown = 0;
    for (uint32_t i = 0; i < scene_.characters.size() && !counts_.fault; ++i) {
      if (!visit(i) || !scene_.characters[i].shown) continue;
      for (uint32_t k = 0; k < scene_.characters[i].parts.size() && !counts_.fault; ++k) {
        shown += below(scene_.characters[i].parts[k]);
        if (shown > kMaxInstances) {
          fail(i, k, fmt::format("the scene has more than {} instances: repeat less", kMaxInstances));
        }
      }
    }
    counts_.shown = static_cast<uint32_t>(std::min<uint64_t>(shown, kMaxInstances));
    return std::move(counts_);
  }

 private:
  uint64_t below(const Part& part) const { return part.character ? counts_.of_character[*part.character] : 1; }

  bool fail(uint32_t character, uint32_t part, std::string what) {
    counts_.fault = NestingFault{character, part, std::move(what)};
    return false;
  }

  bool visit(uint32_t index) {
    if (counts_.of_character[index] != kUncounted) return true;
    const Character& character = scene_.characters[index];
    open_[index] = true;
    ++level_;
    uint64_t sum = 0;
    int deepest = 0;
    for (uint32_t k = 0; k < character.parts.size(); ++k) {
      const Part& part = character.parts[k];
      if (part.character && !enter(index, k, part)) return false;
      if (part.character) deepest = std::max(deepest, depth_[*part.character]);
      sum += below(part);
    }
    --level_;
    open_[index] = false;
    depth_[index] = deepest + 1;
    counts_.of_character[index] = static_cast<uint32_t>(std::min<uint64_t>(sum, kMaxInstances + 1));
    return true;
  }

  /// Visits the character that a part places.
  bool enter(uint32_t character, uint32_t k, const Part& part) {
    const auto name = [&](uint32_t i) { return scene_.characters[i].name; };
    if (std::holds_alternative<BoxPlacement>(part.placement)) {
      return fail(character, k, "a box cannot place a character, which has no unit cube: use 'frame'");
    }
    if (open_[*part.character]) {
      return fail(character, k, fmt::format("character '{}' is placed within itself", name(*part.character)));
    }
    const bool fits = level_ < kMaxNesting && visit(*part.character);
    if (counts_.fault) return false;
    if (fits && level_ + depth_[*part.character] <= kMaxNesting) return true;
    return fail(character, k,
                fmt::format("characters are nested more than {} deep where '{}' places '{}'", kMaxNesting,
                            name(character), name(*part.character)));
  }

  const Scene& scene_;
  InstanceCounts counts_;
  std::vector<int> depth_;  // of the characters within each, itself included; 0 where not visited
  std::vector<bool> open_;
  int level_ = 0;
};

}  // namespace

InstanceCounts count_instances(const Scene& scene) { return Counter(scene).count(); }

std::vector<ObjectUse> object_uses(const Scene& scene) {
  struct Visit {
    uint32_t character;
    bool own_materials;
  };
  std::vector<ObjectUse> uses(scene.objects.size());
  std::vector<std::array<bool, 2>> seen(scene.characters.size());
  std::vector<Visit> open;
  const auto reach = [&](uint32_t character, bool own_materials) {
    if (std::exchange(seen[character][own_materials], true)) return;
    open.push_back({character, own_materials});
  };
  for (uint32_t i = 0; i < scene.characters.size(); ++i) {
    if (scene.characters[i].shown) reach(i, true);
  }
  while (!open.empty()) {
    const Visit at = open.back();
    open.pop_back();
    for (const Part& part : scene.characters[at.character].parts) {
      const bool own = at.own_materials && !part.material;
      if (part.character) {
        reach(*part.character, own);
      } else {
        uses[part.object].placed = true;
        uses[part.object].own_materials |= own;
      }
    }
  }
  return uses;
}

}  // namespace kd::scene
