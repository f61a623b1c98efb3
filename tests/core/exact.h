// The ray and triangle test again, in integers: the oracle. One unit of length is a grid step, 2^(B-24) lattice steps,
// and a direction's unit is 2^-24, so that a snapped ray and a lattice point are integers.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/lattice_ray.h"

namespace kd::test {

__extension__ using Wide = __int128;

/// c[0] + c[1] e + c[2] e^2 + ..., e infinitesimal and positive.
struct Polynomial {
  std::array<Wide, 5> c{};

  friend Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    Polynomial p;
    for (size_t i = 0; i < 5; ++i) {
      for (size_t j = 0; i + j < 5; ++j) p.c[i + j] += a.c[i] * b.c[j];
    }
    return p;
  }
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b) {
    Polynomial p;
    for (size_t i = 0; i < 5; ++i) p.c[i] = a.c[i] - b.c[i];
    return p;
  }
  int sign() const {
    for (Wide value : c) {
      if (value != 0) return value > 0 ? 1 : -1;
    }
    return 0;
  }
};

struct ExactHit {
  bool met = false;
  bool touches = false;  // some edge function was zero, so the rule decided
  long double s = 0;     // lattice steps
  long double u = 0, v = 0;
  double largest = 0;  // distance of the farthest vertex along the ray, lattice steps
};

inline int64_t whole(float value, int shift) { return static_cast<int64_t>(std::ldexp(double{value}, shift)); }

inline ExactHit exact_hit(const LatticeRay& ray, const std::array<Vec3u, 3>& triangle, int bits) {
  const int shift = kMaxLatticeBits - bits;
  const int k = ray.axis, first = k == 0 ? 2 : 0, second = k == 1 ? 2 : 1;
  std::array<Polynomial, 3> x, y;
  std::array<Wide, 3> s;
  ExactHit hit;
  for (size_t i = 0; i < 3; ++i) {
    std::array<int64_t, 3> r;
    for (int axis = 0; axis < 3; ++axis) {
      r[static_cast<size_t>(axis)] = (int64_t{triangle[i][axis]} << shift) - whole(ray.origin[axis], shift);
    }
    const int64_t along = r[static_cast<size_t>(k)] * (ray.direction[k] > 0 ? 1 : -1);
    // Relative to the ray where it passes the vertex's plane; the ray itself is moved by (e, e^2).
    x[i].c[0] = Wide{r[static_cast<size_t>(first)]} * (1 << 24) - Wide{whole(ray.direction[first], 24)} * along;
    y[i].c[0] = Wide{r[static_cast<size_t>(second)]} * (1 << 24) - Wide{whole(ray.direction[second], 24)} * along;
    x[i].c[1] = -1;
    y[i].c[2] = -1;
    s[i] = along;
    hit.largest = std::fmax(hit.largest, std::fabs(std::ldexp(static_cast<double>(along), -shift)));
  }
  const auto edge = [&](size_t p, size_t q) { return x[p] * y[q] - y[p] * x[q]; };
  const Polynomial u = edge(1, 2), v = edge(2, 0), w = edge(0, 1);
  hit.touches = u.c[0] == 0 || v.c[0] == 0 || w.c[0] == 0;
  hit.met = u.sign() != 0 && u.sign() == v.sign() && u.sign() == w.sign();
  if (!hit.met) return hit;
  const Wide sum = u.c[0] + v.c[0] + w.c[0];
  const auto ratio = [&](Wide a) { return static_cast<long double>(a) / static_cast<long double>(sum); };
  hit.s = std::ldexp(ratio(u.c[0] * s[0] + v.c[0] * s[1] + w.c[0] * s[2]), -shift);
  hit.u = ratio(v.c[0]);
  hit.v = ratio(w.c[0]);
  return hit;
}

}  // namespace kd::test
