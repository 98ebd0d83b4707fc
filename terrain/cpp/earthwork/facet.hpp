// A triangle of a surface as the overlay takes it, and areas in the plane to all digits.
#pragma once

#include <cmath>
#include <cstdint>

#include "../../../tin/cpp/base/box.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/point.hpp"
#include "../../../tin/cpp/location/ordered_surface.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"

namespace tinsmith::earthwork {

// Its lexicographically first corner comes first, so that it does not matter how the caller
// numbers or turns triangles. Edge k lies opposite corner k.
struct Facet {
  Point corner[3];
  double elevation[3];
  double size;  // half the way around its box
  Vertex vertex[3];
  Triangle triangle;

  // No two triangles need to share an edge: they may be pieces.
  static Facet of(const Surface& surface, Triangle t) {
    Facet facet;
    facet.triangle = t;
    std::uint32_t first = 0;
    for (std::uint32_t k = 1; k < 3; ++k) {
      if (lexicographically_before(surface.corner(t, k), surface.corner(t, first))) first = k;
    }
    for (std::uint32_t k = 0, from = first; k < 3; ++k, from = corner_after(from)) {
      const Vertex v = surface.vertex(t, from);
      facet.vertex[k] = v;
      facet.corner[k] = surface.point(v);
      facet.elevation[k] = surface.elevation(v);
    }
    const Box box = surface.box_of(t);
    facet.size = box.width() + box.height();
    return facet;
  }

  // Of a copy, called as the caller calls it.
  static Facet of(const OrderedSurface& copy, Triangle t) {
    Facet facet = of(copy.surface(), t);
    for (Vertex& v : facet.vertex) v = copy.given_number(v);
    facet.triangle = copy.given_number(t);
    return facet;
  }

  Point start(std::uint32_t edge) const { return corner[corner_after(edge)]; }
  Point end(std::uint32_t edge) const { return corner[corner_before(edge)]; }
};

// The smaller of two triangles is the one whose edges places are measured along; of two alike one
// is chosen by its coordinates, so that the order in which they were given does not matter.
inline bool is_measured_along(const Facet& one, const Facet& other) {
  if (one.size != other.size) return one.size < other.size;
  for (int k = 0; k < 3; ++k) {
    if (one.corner[k] == other.corner[k]) continue;
    return lexicographically_before(one.corner[k], other.corner[k]);
  }
  for (int k = 0; k < 3; ++k) {
    if (one.elevation[k] != other.elevation[k]) return one.elevation[k] < other.elevation[k];
  }
  return true;
}

// The difference of two products, rounded, is good to about 14 digits: 7 of 53 bits are lost.
inline bool is_precise(double left, double right) {
  return std::fabs(left - right) > 0x1p-7 * (std::fabs(left) + std::fabs(right));
}

// Twice the signed area of a, b, c; the sign is exact and the value good to about 14 digits.
inline double twice_area(Point a, Point b, Point c) {
  constexpr double kKeptTwice = 0x1p-44;  // of the compensated value, which has some 100 bits
  const double ax = a.x - c.x, ay = a.y - c.y, bx = b.x - c.x, by = b.y - c.y;
  const double left = ax * by, right = ay * bx;
  if (is_precise(left, right)) return left - right;
  const double size = std::fabs(left) + std::fabs(right);
  const TwoDoubles first = exact_product(ax, by), second = exact_product(ay, bx);
  const double ax_low = exact_difference(a.x, c.x).low, ay_low = exact_difference(a.y, c.y).low;
  const double bx_low = exact_difference(b.x, c.x).low, by_low = exact_difference(b.y, c.y).low;
  const double low = (ax * by_low + ax_low * by) - (ay * bx_low + ay_low * bx);
  const double value = (first.high - second.high) + ((first.low - second.low) + low);
  if (std::fabs(value) > kKeptTwice * size) return value;
  return detail::exact_twice_area(a, b, c).value();
}

}  // namespace tinsmith::earthwork
