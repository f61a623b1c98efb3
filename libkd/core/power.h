// x^y with the same bits on every machine. The C libraries' pow differ in the last places from host to host and from
// host to device; Phong's highlight and the gamma stage must not.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/arithmetic.h"
#include "core/platform.h"

namespace kd {

/// log2(x) for a normal x > 0; error below 4 ulp or 1e-16, whichever is larger.
KD_HD inline double exact_log2(double x) {
  uint64_t bits = std::bit_cast<uint64_t>(x);
  auto exponent = static_cast<int>(bits >> 52) - 1023;
  bits = (bits & 0xfffffffffffffull) | 0x3ff0000000000000ull;
  double m = std::bit_cast<double>(bits);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    ++exponent;
  }
  // log(m) = 2 artanh(z), |z| <= 0.172: the first term left out is below 1e-17 of the sum.
  const double z = (m - 1) * reciprocal(m + 1), z2 = z * z;
  double series = 0;
  for (int k = 21; k >= 1; k -= 2) series = std::fma(series, z2, 1.0 / k);
  return exponent + 2 * z * series * 1.4426950408889634;
}

/// 2^x; 0 below -1022, infinity above 1023.
KD_HD inline double exact_exp2(double x) {
  if (x < -1022) return 0;
  if (x >= 1024) return HUGE_VAL;
  const double whole = std::floor(x + 0.5);
  const double y = (x - whole) * 0.6931471805599453;  // |y| <= 0.347
  // 1/k!; the first term left out is below 2e-16.
  constexpr double kTerms[] = {
      1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040, 1.0 / 720,
      1.0 / 120,       1.0 / 24,       1.0 / 6,       1.0 / 2,      1.0,         1.0};
  double mantissa = 0;
  for (double term : kTerms) mantissa = std::fma(mantissa, y, term);
  const auto exponent = static_cast<int>(whole);
  // In two factors, since 2^1024 is no double.
  return mantissa * power_of_two(exponent / 2) * power_of_two(exponent - exponent / 2);
}

/// x^y for x >= 0 and finite y, to about 1e-13 of the result; 0^0 is 1. Denormal x counts as 0.
KD_HD inline double exact_pow(double x, double y) {
  if (y == 0) return 1;
  if (!(x >= 0x1p-1022)) return y > 0 ? 0 : HUGE_VAL;
  return exact_exp2(y * exact_log2(x));
}

}  // namespace kd
