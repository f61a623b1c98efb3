// A field between two of its keys, by linear or cubic interpolation.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "scene/scene.h"

namespace kd::scene {

template <class T>
struct KeyValue {
  double frame;
  T value;
};

/// The keys around a frame that give a field: the frame is from `from` on and before `to`.
template <class T>
struct KeySegment {
  std::optional<KeyValue<T>> before;
  KeyValue<T> from;
  KeyValue<T> to;
  std::optional<KeyValue<T>> after;
  double frame;

  double duration() const { return to.frame - from.frame; }
  double share() const { return (frame - from.frame) / duration(); }
  /// The same of `convert(value)`.
  template <class Other, class Convert>
  KeySegment<Other> mapped(const Convert& convert) const {
    const auto one = [&](const KeyValue<T>& k) { return KeyValue<Other>{k.frame, convert(k.value)}; };
    const auto maybe = [&](const std::optional<KeyValue<T>>& k) { return k ? std::optional(one(*k)) : std::nullopt; };
    return {maybe(before), one(from), one(to), maybe(after), frame};
  }
};

/// Weights of a cubic Hermite curve at u in [0, 1]: of the second end, and of the velocities at both.
struct HermiteWeights {
  double to, from_velocity, to_velocity;
  explicit HermiteWeights(double u)
      : to(u * u * (3 - 2 * u)), from_velocity(u * (1 - u) * (1 - u)), to_velocity(u * u * (u - 1)) {}
};

/// T adds, subtracts and scales.
template <class T>
T interpolate(const KeySegment<T>& s, Interpolation interpolation) {
  const T way = s.to.value - s.from.value;
  if (interpolation == Interpolation::linear) return s.from.value + way * s.share();
  const HermiteWeights w(s.share());
  T value = s.from.value + way * w.to;
  if (s.before) {
    value = value + (s.to.value - s.before->value) * (w.from_velocity * s.duration() / (s.to.frame - s.before->frame));
  }
  if (s.after) {
    value = value + (s.after->value - s.from.value) * (w.to_velocity * s.duration() / (s.after->frame - s.from.frame));
  }
  return value;
}

/// The value of `field` at a frame; `otherwise` if no key gives it. `between(segment)` interpolates.
template <class Key, class T, class Between>
T value_at(std::span<const Key> keys, std::optional<T> Key::*field, const T& otherwise, double frame,
           const Between& between) {
  const auto middle = static_cast<size_t>(
      std::upper_bound(keys.begin(), keys.end(), frame, [](double f, const Key& k) { return f < k.frame; }) -
      keys.begin());
  const auto earlier = [&](size_t end) {
    while (end > 0 && !(keys[end - 1].*field)) --end;
    return end;  // one past it; 0 if there is none
  };
  const auto later = [&](size_t begin) {
    while (begin < keys.size() && !(keys[begin].*field)) ++begin;
    return begin;
  };
  const size_t from = earlier(middle), to = later(middle);
  if (from == 0 && to == keys.size()) return otherwise;
  if (from == 0) return *(keys[to].*field);
  if (to == keys.size() || keys[from - 1].frame == frame) return *(keys[from - 1].*field);
  const auto key_value = [&](size_t i) { return KeyValue<T>{keys[i].frame, *(keys[i].*field)}; };
  const size_t before = earlier(from - 1), after = later(to + 1);
  KeySegment<T> segment{std::nullopt, key_value(from - 1), key_value(to), std::nullopt, frame};
  if (before > 0) segment.before = key_value(before - 1);
  if (after < keys.size()) segment.after = key_value(after);
  return between(segment);
}

}  // namespace kd::scene
