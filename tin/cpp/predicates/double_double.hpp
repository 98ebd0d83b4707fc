// Numbers of twice the digits of a double: sums of two doubles.
//
// Sums and products lose a few units of 2^-104 of their terms (Dekker, "A floating-point technique
// for extending the available precision", 1971). They are for values, never for decisions: whoever
// rounds one knows how far off it may be, and leaves to exact arithmetic what is too close to the
// middle between two doubles.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "../base/point.hpp"
#include "expansion.hpp"
#include "predicates.hpp"

namespace tinsmith {

// For |small| <= |large|.
inline TwoDoubles quick_sum(double large, double small) {
  const double sum = large + small;
  return {sum, small - (sum - large)};
}

inline TwoDoubles operator-(TwoDoubles a) { return {-a.high, -a.low}; }

inline TwoDoubles operator+(TwoDoubles a, TwoDoubles b) {
  const TwoDoubles high = exact_sum(a.high, b.high);
  const TwoDoubles low = exact_sum(a.low, b.low);
  const TwoDoubles sum = quick_sum(high.high, high.low + low.high);
  return quick_sum(sum.high, sum.low + low.low);
}

inline TwoDoubles operator-(TwoDoubles a, TwoDoubles b) { return a + -b; }

inline TwoDoubles operator*(TwoDoubles a, TwoDoubles b) {
  const TwoDoubles product = exact_product(a.high, b.high);
  return quick_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

inline TwoDoubles operator*(TwoDoubles a, double b) {
  const TwoDoubles product = exact_product(a.high, b);
  return quick_sum(product.high, product.low + a.low * b);
}

inline TwoDoubles operator/(TwoDoubles a, TwoDoubles b) {
  const double first = a.high / b.high;
  const TwoDoubles rest = a - b * first;
  const double second = rest.high / b.high;
  const TwoDoubles more = rest - b * second;
  const TwoDoubles sum = quick_sum(first, second);
  return quick_sum(sum.high, sum.low + more.high / b.high);
}

namespace detail {

// Twice the signed area of a, b, c, and how large the terms were.
struct AreaEstimate {
  TwoDoubles value;
  double size;

  AreaEstimate(Point a, Point b, Point c) {
    const TwoDoubles left = exact_difference(a.x, c.x) * exact_difference(b.y, c.y);
    const TwoDoubles right = exact_difference(a.y, c.y) * exact_difference(b.x, c.x);
    value = left - right;
    size = std::fabs(left.high) + std::fabs(right.high);
  }
};

// Whether a value that is off by at most `error` rounds to its high part, whatever it is in truth.
inline bool rounds_certainly(TwoDoubles value, double error) {
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  constexpr std::uint64_t kDigits = (std::uint64_t{1} << 52) - 1;
  std::uint64_t bits;
  std::memcpy(&bits, &value.high, sizeof bits);
  if ((bits & kDigits) == 0) return false;  // 0, or a power of two, whose neighbours are uneven
  bits &= ~(kSign | kDigits);               // leaves the power of two below
  double power;
  std::memcpy(&power, &bits, sizeof power);
  const double half = kUnitRoundoff * power;
  return std::fabs(value.low) + error < half;  // false for what is not a number
}

// (s u - t v) / (s - t), whose s and t differ in sign, rounded once into `result`; false if that is
// not certain.
inline bool divide_between(const AreaEstimate& s, const AreaEstimate& t, double u, double v,
                           double& result) {
  constexpr double kError = 0x1p-96;  // far more than all roundings of 2^-104 make
  const TwoDoubles whole = s.value - t.value;
  const TwoDoubles quotient = (s.value * u - t.value * v) / whole;
  const double terms = std::fmax(std::fabs(u), std::fabs(v)) * ((s.size + t.size) / whole.high);
  result = quotient.high;
  return rounds_certainly(quotient, kError * std::fabs(terms));
}

}  // namespace detail

}  // namespace tinsmith
