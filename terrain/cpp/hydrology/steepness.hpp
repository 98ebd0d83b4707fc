// Which of two edges from a vertex falls more steeply, exactly.
#pragma once

#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/point.hpp"
#include "../../../tin/cpp/location/surface.hpp"
#include "../../../tin/cpp/predicates/expansion.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"

namespace tinsmith::hydrology {

namespace detail {

// Of an edge, without rounding.
struct SlopeSquare {
  Expansion<8> fall;
  Expansion<16> run;

  SlopeSquare(const double* p, const double* q) {
    const auto step = [&](int k) { return expand(exact_difference(q[k], p[k])); };
    const auto east = step(0), north = step(1), up = step(2);
    fall = up * up;
    run = east * east + north * north;
  }
};

// Clockwise from north, 0 up to south.
inline bool is_in_first_half(Point from, Point to) {
  return to.x > from.x || (to.x == from.x && to.y > from.y);
}

}  // namespace detail

// +1 if the edge to p is the steeper one, -1 if that to q is, 0 if both are as steep. Products of
// four differences, which the range of the predicates allows.
inline int compare_slopes(const Surface& surface, Vertex from, Vertex p, Vertex q) {
  const detail::SlopeSquare one(surface.row(from), surface.row(p));
  const detail::SlopeSquare other(surface.row(from), surface.row(q));
  return (one.fall * other.run - other.fall * one.run).sign();
}

// Whether the azimuth of p is smaller than that of q.
inline bool is_before(const Surface& surface, Vertex from, Vertex p, Vertex q) {
  const Point center = surface.point(from), one = surface.point(p), other = surface.point(q);
  const bool is_first = detail::is_in_first_half(center, one);
  if (is_first != detail::is_in_first_half(center, other)) return is_first;
  return orientation(center, one, other) < 0;
}

}  // namespace tinsmith::hydrology
