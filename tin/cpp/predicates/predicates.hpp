// Exact predicates on plane coordinates: which side of a line, inside which circle.
//
// Adaptive as those of Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates" (1997).
//
// Each decides in stages and stops at the first that is certain: plain doubles with an error
// bound; wide integers where the differences of the coordinates have a common unit that is not too
// small (they have for neighbouring points of any survey or raster); expansions for all else.
//
// Exact while every coordinate is 0 or of a magnitude in [kSmallestCoordinate,
// kLargestCoordinate]: products of four differences then neither overflow nor lose bits below
// the smallest double.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "../base/point.hpp"
#include "expansion.hpp"

namespace tinsmith {

constexpr double kSmallestCoordinate = 0x1p-200;
constexpr double kLargestCoordinate = 0x1p250;
constexpr double kLargestElevation = 1e300;  // sums and differences of some are finite

inline bool is_in_exact_range(double coordinate) {
  const double size = std::fabs(coordinate);
  return size == 0.0 || (size >= kSmallestCoordinate && size <= kLargestCoordinate);
}

inline bool is_elevation(double z) { return std::fabs(z) <= kLargestElevation; }

constexpr double kUnitRoundoff = 0x1p-53;

namespace detail {

inline int sign_of(double value) { return (value > 0.0) - (value < 0.0); }

// Shewchuk's bounds for the first stage of each predicate.
constexpr double kOrientationBound = (3.0 + 16.0 * kUnitRoundoff) * kUnitRoundoff;
constexpr double kInCircleBound = (10.0 + 96.0 * kUnitRoundoff) * kUnitRoundoff;
// Each square carries four roundings, with room for the difference itself.
constexpr double kDistanceBound = 8.0 * kUnitRoundoff;

// Sign of (a1 - a2)(b1 - b2) - (c1 - c2)(d1 - d2), exactly.
inline int sign_of_product_difference(double a1, double a2, double b1, double b2, double c1,
                                      double c2, double d1, double d2) {
  const TwoDoubles a = exact_difference(a1, a2);
  const TwoDoubles b = exact_difference(b1, b2);
  const TwoDoubles c = exact_difference(c1, c2);
  const TwoDoubles d = exact_difference(d1, d2);
  if (a.low == 0.0 && b.low == 0.0 && c.low == 0.0 && d.low == 0.0) {
    // Rounding is monotone, so the rounded products decide unless they are equal.
    const TwoDoubles left = exact_product(a.high, b.high);
    const TwoDoubles right = exact_product(c.high, d.high);
    if (left.high != right.high) return left.high > right.high ? 1 : -1;
    return (left.low > right.low) - (left.low < right.low);
  }
  return (expand(a) * expand(b) - expand(c) * expand(d)).sign();
}

#ifdef __SIZEOF_INT128__
// In-circle determinant of exact differences, as an integer modulo 2^128 or 2^192. The caller
// knows that the true value is small beside the terms (it failed the filter), so the remainder is
// the value: differences of b bits give |terms| < 2^(4b + 4), and a value within twice the
// filter's bound, 2^-48 of them, is below 2^(4b - 44).
class IntegerInCircle {
 public:
  // False if the differences have no common unit in which they are integers of kMostBits.
  bool load(const TwoDoubles (&differences)[6]) {
    double largest = 0.0;
    for (const TwoDoubles& d : differences) largest = std::max(largest, std::fabs(d.high));
    if (largest == 0.0) return false;
    const double scale = power_of_two(kMostBits - 1 - exponent(largest));
    std::uint64_t used = 0;
    for (int i = 0; i < 6; ++i) {
      const double high = differences[i].high * scale, low = differences[i].low * scale;
      const auto high_value = static_cast<std::int64_t>(high);
      const auto low_value = static_cast<std::int64_t>(low);
      if (static_cast<double>(high_value) != high || static_cast<double>(low_value) != low) {
        return false;
      }
      value_[i] = high_value + low_value;
      used |= static_cast<std::uint64_t>(std::abs(value_[i]));
    }
    drop_common_zeros(used);
    return true;
  }

  int sign() const { return bits_ <= kBitsFor128 ? sign_modulo_128() : sign_modulo_192(); }

 private:
  __extension__ using Integer = unsigned __int128;  // wraps around by definition
  __extension__ using SignedInteger = __int128;
  static constexpr int kMostBits = 58;
  static constexpr int kBitsFor128 = 42;

  struct Wide {
    Integer low;
    std::uint64_t high;
    Wide operator+(const Wide& other) const {
      const Integer sum = low + other.low;
      return {sum, high + other.high + (sum < low)};
    }
  };

  // The power of two at or below a normal, positive value.
  static int exponent(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return static_cast<int>(bits >> 52) - 1023;
  }
  static double power_of_two(int exponent) {
    const std::uint64_t bits = static_cast<std::uint64_t>(exponent + 1023) << 52;
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  void drop_common_zeros(std::uint64_t used) {
    if (used == 0) return;
    const int zeros = __builtin_ctzll(used);
    for (auto& value : value_) value >>= zeros;
    bits_ = 64 - __builtin_clzll(used) - zeros;
  }

  int sign_modulo_128() const {
    const Integer adx = value_[0], ady = value_[1], bdx = value_[2];
    const Integer bdy = value_[3], cdx = value_[4], cdy = value_[5];
    const Integer determinant = (adx * adx + ady * ady) * (bdx * cdy - cdx * bdy) +
                                (bdx * bdx + bdy * bdy) * (cdx * ady - adx * cdy) +
                                (cdx * cdx + cdy * cdy) * (adx * bdy - bdx * ady);
    const auto value = static_cast<SignedInteger>(determinant);
    return (value > 0) - (value < 0);
  }

  int sign_modulo_192() const {
    const Wide determinant = term(0, 2, 4) + term(2, 4, 0) + term(4, 0, 2);
    if (static_cast<std::int64_t>(determinant.high) < 0) return -1;
    return determinant.high != 0 || determinant.low != 0;
  }

  // |a|^2 (b x c), of the differences that stand from a, b and c on.
  Wide term(int a, int b, int c) const {
    const Integer lift = product(a, a) + product(a + 1, a + 1);
    const Integer cross = product(b, c + 1) - product(c, b + 1);
    const auto lift0 = static_cast<std::uint64_t>(lift);
    const auto lift1 = static_cast<std::uint64_t>(lift >> 64);
    const auto cross0 = static_cast<std::uint64_t>(cross);
    const auto cross1 = static_cast<std::uint64_t>(cross >> 64);
    const std::uint64_t cross2 = cross1 >> 63 != 0 ? ~std::uint64_t{0} : 0;  // its sign
    const Integer bottom = static_cast<Integer>(lift0) * cross0;
    const Integer left = static_cast<Integer>(lift1) * cross0;
    const Integer right = static_cast<Integer>(lift0) * cross1;
    const Wide outer{bottom, lift1 * cross1 + lift0 * cross2};
    return outer + Wide{left << 64, static_cast<std::uint64_t>(left >> 64)} +
           Wide{right << 64, static_cast<std::uint64_t>(right >> 64)};
  }

  Integer product(int i, int j) const {
    return static_cast<Integer>(static_cast<SignedInteger>(value_[i]) * value_[j]);
  }

  std::int64_t value_[6];
  int bits_ = 0;
};
#endif

inline int in_circle_expanded(const TwoDoubles (&d)[6]) {
  const auto adx = expand(d[0]), ady = expand(d[1]), bdx = expand(d[2]);
  const auto bdy = expand(d[3]), cdx = expand(d[4]), cdy = expand(d[5]);
  const auto a_lift = adx * adx + ady * ady;
  const auto b_lift = bdx * bdx + bdy * bdy;
  const auto c_lift = cdx * cdx + cdy * cdy;
  const auto a_term = a_lift * (bdx * cdy - cdx * bdy);
  const auto b_term = b_lift * (cdx * ady - adx * cdy);
  const auto c_term = c_lift * (adx * bdy - bdx * ady);
  return (a_term + b_term + c_term).sign();
}

inline int in_circle_exact(Point a, Point b, Point c, Point d) {
  const TwoDoubles difference[6] = {exact_difference(a.x, d.x), exact_difference(a.y, d.y),
                                    exact_difference(b.x, d.x), exact_difference(b.y, d.y),
                                    exact_difference(c.x, d.x), exact_difference(c.y, d.y)};
#ifdef __SIZEOF_INT128__
  IntegerInCircle integers;
  if (integers.load(difference)) return integers.sign();
#endif
  return in_circle_expanded(difference);
}

// Twice the signed area of a, b, c, exactly.
inline Expansion<16> exact_twice_area(Point a, Point b, Point c) {
  return expand(exact_difference(a.x, c.x)) * expand(exact_difference(b.y, c.y)) -
         expand(exact_difference(a.y, c.y)) * expand(exact_difference(b.x, c.x));
}

// Twice the signed area of a, b, c; the sign is exact and the value good to about 12 digits.
inline double twice_area(Point a, Point b, Point c) {
  constexpr double kCancelled = 0x1p-12;  // fewer than 12 of 53 bits lost is good enough
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double value = left - right;
  if (std::fabs(value) > kCancelled * (std::fabs(left) + std::fabs(right))) return value;
  return exact_twice_area(a, b, c).value();
}

}  // namespace detail

// +1 if c lies left of the line from a to b, -1 right, 0 on it.
inline int orientation(Point a, Point b, Point c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double bound = detail::kOrientationBound * (std::fabs(left) + std::fabs(right));
  if (determinant > bound || -determinant > bound) return detail::sign_of(determinant);
  return detail::sign_of_product_difference(a.x, c.x, b.y, c.y, a.y, c.y, b.x, c.x);
}

// +1 if p is further from v than q is, -1 nearer, 0 equally far.
inline int compare_distances(Point v, Point p, Point q) {
  const double px = p.x - v.x, py = p.y - v.y, qx = q.x - v.x, qy = q.y - v.y;
  const double p_square = px * px + py * py, q_square = qx * qx + qy * qy;
  const double bound = detail::kDistanceBound * (p_square + q_square);
  const double difference = p_square - q_square;
  if (difference > bound || -difference > bound) return detail::sign_of(difference);
  const auto ax = expand(exact_difference(p.x, v.x)), ay = expand(exact_difference(p.y, v.y));
  const auto bx = expand(exact_difference(q.x, v.x)), by = expand(exact_difference(q.y, v.y));
  return ((ax * ax + ay * ay) - (bx * bx + by * by)).sign();
}

// +1 if d lies inside the circle through the counter-clockwise a, b, c, -1 outside, 0 on it.
inline int in_circle(Point a, Point b, Point c, Point d) {
  const double adx = a.x - d.x, ady = a.y - d.y;
  const double bdx = b.x - d.x, bdy = b.y - d.y;
  const double cdx = c.x - d.x, cdy = c.y - d.y;
  const double bdx_cdy = bdx * cdy, cdx_bdy = cdx * bdy;
  const double cdx_ady = cdx * ady, adx_cdy = adx * cdy;
  const double adx_bdy = adx * bdy, bdx_ady = bdx * ady;
  const double a_lift = adx * adx + ady * ady;
  const double b_lift = bdx * bdx + bdy * bdy;
  const double c_lift = cdx * cdx + cdy * cdy;
  const double determinant =
      a_lift * (bdx_cdy - cdx_bdy) + b_lift * (cdx_ady - adx_cdy) + c_lift * (adx_bdy - bdx_ady);
  const double permanent = (std::fabs(bdx_cdy) + std::fabs(cdx_bdy)) * a_lift +
                           (std::fabs(cdx_ady) + std::fabs(adx_cdy)) * b_lift +
                           (std::fabs(adx_bdy) + std::fabs(bdx_ady)) * c_lift;
  const double bound = detail::kInCircleBound * permanent;
  if (determinant > bound || -determinant > bound) return detail::sign_of(determinant);
  return detail::in_circle_exact(a, b, c, d);
}

// As in_circle, but never 0: of four cocircular points the lexicographically last decides.
//
// Each point's lifted height x^2 + y^2 is thought raised by an infinitesimal that grows with its
// rank in lexicographic order, each beyond comparison with all before it: the symbolic perturbation
// of Edelsbrunner and Muecke, "Simulation of simplicity" (1990), as Devillers and Teillaud use it
// ("Perturbations and vertex removal in a 3D Delaunay triangulation", 2003). So the triangulation
// is unique and a function of the point set alone. The signs are the cofactors of the heights in
// the in-circle determinant.
inline bool is_in_circle(Point a, Point b, Point c, Point d) {
  const int side = in_circle(a, b, c, d);
  if (side != 0) return side > 0;
  const bool a_before_b = lexicographically_before(a, b);
  const bool c_before_d = lexicographically_before(c, d);
  const Point last_ab = a_before_b ? b : a;
  const Point last_cd = c_before_d ? d : c;
  if (lexicographically_before(last_ab, last_cd)) {
    return c_before_d ? false : orientation(a, b, d) > 0;
  }
  return a_before_b ? orientation(a, c, d) < 0 : orientation(b, c, d) > 0;
}

}  // namespace tinsmith
