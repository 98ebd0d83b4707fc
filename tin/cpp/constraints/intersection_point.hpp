// Where two crossing segments meet.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "../base/box.hpp"
#include "../predicates/expansion.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

namespace detail {

inline bool is_even(double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & 1) == 0;
}

// The exact quotient rounded once, halves to even: a floating-point quotient, corrected by the
// exact remainder, then compared with the middle between it and its neighbour. Middles are common:
// the diagonals of a rectangle meet in one.
template <std::size_t N, std::size_t M>
double rounded_quotient(const Expansion<N>& dividend, const Expansion<M>& divisor) {
  constexpr double kClose = 0.999;  // the correction is good to far more digits
  const double estimate = divisor.value();
  double quotient = dividend.value() / estimate;
  quotient += (dividend - divisor * quotient).value() / estimate;
  const auto remainder = dividend - divisor * quotient;
  if (remainder.sign() == 0) return quotient;
  const int direction = remainder.sign() * divisor.sign();
  const double neighbor = std::nextafter(quotient, direction * HUGE_VAL);
  const double half = 0.5 * (neighbor - quotient);
  if (std::fabs(remainder.value() / estimate) < kClose * std::fabs(half)) return quotient;
  const int beyond_half = (remainder - divisor * half).sign() * divisor.sign() * direction;
  if (beyond_half != 0) return beyond_half > 0 ? neighbor : quotient;
  return is_even(quotient) ? quotient : neighbor;
}

// A coordinate that the predicates can compute with, within what two spans have in common.
inline double clamped_coordinate(double value, double low, double high) {
  if (std::fabs(value) < kSmallestCoordinate) value = 0.0;
  return std::clamp(value, low, high);
}

}  // namespace detail

// The meeting point of a-b and c-d, which cross: each coordinate is the true one rounded, so lines
// through one point meet in one point. The same for any order of segments and ends.
inline Point intersection_point(Point a, Point b, Point c, Point d) {
  if (lexicographically_before(b, a)) std::swap(a, b);
  if (lexicographically_before(d, c)) std::swap(c, d);
  if (lexicographically_before(c, a) || (c == a && lexicographically_before(d, b))) {
    std::swap(a, c);
    std::swap(b, d);
  }
  // a and b lie on either side of c-d; their distances from it divide a-b.
  const auto at_a = detail::exact_twice_area(c, d, a);
  const auto at_b = detail::exact_twice_area(c, d, b);
  const auto whole = at_a - at_b;
  const double x = detail::rounded_quotient(at_a * b.x - at_b * a.x, whole);
  const double y = detail::rounded_quotient(at_a * b.y - at_b * a.y, whole);
  const Box first = Box::of(a, b), second = Box::of(c, d);
  return {detail::clamped_coordinate(x, std::max(first.west, second.west),
                                     std::min(first.east, second.east)),
          detail::clamped_coordinate(y, std::max(first.south, second.south),
                                     std::min(first.north, second.north))};
}

}  // namespace tinsmith
