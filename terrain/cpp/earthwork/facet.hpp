// A triangle of a surface as the overlay takes it, and areas in the plane to all digits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../../../tin/cpp/base/box.hpp"
#include "../../../tin/cpp/base/point.hpp"
#include "../../../tin/cpp/location/ordered_surface.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"

namespace tinsmith::earthwork {

// Triangles by number, as the caller holds them. No two need to share an edge: they may be pieces.
struct Triangles {
  const double* points;  // x, y, z
  const std::int32_t* corners;
  std::int32_t count;
  std::int32_t point_count;

  const double* row(std::int32_t vertex) const {
    return points + 3 * static_cast<std::size_t>(vertex);
  }
  std::int32_t vertex(std::int32_t triangle, int corner) const {
    return corners[3 * static_cast<std::size_t>(triangle) + corner];
  }
  Box box_of(std::int32_t triangle) const {
    Box box;
    for (int k = 0; k < 3; ++k) {
      const double* p = row(vertex(triangle, k));
      box.include(Point{p[0], p[1]});
    }
    return box;
  }
};

constexpr int kAfter[3] = {1, 2, 0};
constexpr int kBefore[3] = {2, 0, 1};

// Its lexicographically first corner comes first, so that it does not matter how the caller
// numbers or turns triangles. Edge k lies opposite corner k.
struct Facet {
  Point corner[3];
  double elevation[3];
  std::int32_t vertex[3];
  std::int32_t triangle;

  static Facet of(const Triangles& triangles, std::int32_t triangle) {
    Facet facet;
    facet.triangle = triangle;
    int first = 0;
    for (int k = 1; k < 3; ++k) {
      if (before(triangles, triangle, k, first)) first = k;
    }
    for (int k = 0, from = first; k < 3; ++k, from = kAfter[from]) {
      facet.vertex[k] = triangles.vertex(triangle, from);
      const double* row = triangles.row(facet.vertex[k]);
      facet.corner[k] = {row[0], row[1]};
      facet.elevation[k] = row[2];
    }
    return facet;
  }

  // Of a copy, called as the caller calls it.
  static Facet of(const OrderedSurface& copy, std::int32_t triangle) {
    const Surface surface = copy.surface();
    Facet facet = of({surface.points, surface.corners,
                      static_cast<std::int32_t>(surface.triangle_count), surface.point_count},
                     triangle);
    for (auto& vertex : facet.vertex) vertex = number(copy.given_number(Vertex{vertex}));
    facet.triangle =
        static_cast<std::int32_t>(number(copy.given_number(Triangle{std::uint32_t(triangle)})));
    return facet;
  }

  Point start(int edge) const { return corner[kAfter[edge]]; }
  Point end(int edge) const { return corner[kBefore[edge]]; }

  double size() const {
    const auto [west, east] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
    const auto [south, north] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    return (east - west) + (north - south);
  }

 private:
  static bool before(const Triangles& triangles, std::int32_t triangle, int a, int b) {
    const double* p = triangles.row(triangles.vertex(triangle, a));
    const double* q = triangles.row(triangles.vertex(triangle, b));
    return lexicographically_before({p[0], p[1]}, {q[0], q[1]});
  }
};

// The smaller of two triangles is the one whose edges places are measured along; of two alike one
// is chosen by its coordinates, so that the order in which they were given does not matter.
inline bool is_measured_along(const Facet& one, const Facet& other) {
  const double size = one.size(), other_size = other.size();
  if (size != other_size) return size < other_size;
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
