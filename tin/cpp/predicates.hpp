// Exact predicates on plane coordinates: which side of a line, inside which circle.
//
// Each decides in stages and stops at the first that is certain: plain doubles with an error
// bound; 128-bit integers where the differences of the coordinates are exact (they are for
// neighbouring points of any survey or raster); expansions for everything else.
//
// Exact while every coordinate is 0 or of a magnitude in [kSmallestCoordinate,
// kLargestCoordinate]: products of four differences then neither overflow nor lose bits below
// the smallest double.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "expansion.hpp"

namespace tinsmith {

constexpr double kSmallestCoordinate = 0x1p-200;
constexpr double kLargestCoordinate = 0x1p250;

constexpr double kUnitRoundoff = 0x1p-53;

struct Point {
  double x;
  double y;
};

inline bool operator==(Point a, Point b) { return a.x == b.x && a.y == b.y; }

// Order by easting, then northing: the order that breaks ties between cocircular points.
inline bool lexicographically_before(Point a, Point b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

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
// In-circle determinant of exact differences as integers modulo 2^128. The caller knows that the
// true value is small beside the terms (it failed the filter), so the remainder is the value:
// differences of 42 bits give |terms| < 2^172, and a value within the filter's 2^-49 of them is
// below 2^123.
class IntegerInCircle {
 public:
  static constexpr int kBits = 42;

  bool load(const double (&differences)[6]) {
    double largest = 0.0;
    for (double d : differences) largest = std::max(largest, std::fabs(d));
    int exponent = 0;
    std::frexp(largest, &exponent);
    const double scale = std::ldexp(1.0, kBits - exponent);
    for (int i = 0; i < 6; ++i) {
      const double scaled = differences[i] * scale;
      value_[i] = static_cast<std::int64_t>(scaled);
      if (static_cast<double>(value_[i]) != scaled) return false;
    }
    return true;
  }

  int sign() const {
    const Integer adx = value_[0], ady = value_[1], bdx = value_[2];
    const Integer bdy = value_[3], cdx = value_[4], cdy = value_[5];
    const Integer determinant = lift(adx, ady) * (bdx * cdy - cdx * bdy) +
                                lift(bdx, bdy) * (cdx * ady - adx * cdy) +
                                lift(cdx, cdy) * (adx * bdy - bdx * ady);
    const auto value = static_cast<__int128>(determinant);
    return (value > 0) - (value < 0);
  }

 private:
  using Integer = unsigned __int128;  // wraps around by definition
  static Integer lift(Integer x, Integer y) { return x * x + y * y; }
  std::int64_t value_[6];
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
  const TwoDoubles difference[6] = {
      exact_difference(a.x, d.x), exact_difference(a.y, d.y), exact_difference(b.x, d.x),
      exact_difference(b.y, d.y), exact_difference(c.x, d.x), exact_difference(c.y, d.y)};
#ifdef __SIZEOF_INT128__
  double high[6];
  bool is_exact = true;
  for (int i = 0; i < 6; ++i) {
    high[i] = difference[i].high;
    is_exact &= difference[i].low == 0.0;
  }
  IntegerInCircle integers;
  if (is_exact && integers.load(high)) return integers.sign();
#endif
  return in_circle_expanded(difference);
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
  const double determinant = a_lift * (bdx_cdy - cdx_bdy) + b_lift * (cdx_ady - adx_cdy) +
                             c_lift * (adx_bdy - bdx_ady);
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
// rank in lexicographic order, each beyond comparison with all before it. So the triangulation is
// unique and a function of the point set alone. The signs are the cofactors of the heights in
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
