// How far from a level the surface is along a straight segment: a walk through its triangles.
//
// A straight walk (Devillers, Pion and Teillaud, "Walking in a triangulation", 2002), careful and
// not complete: where the segment runs through a vertex or along an edge, and
// where rounding leaves too much open, it says that it does not know.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "../../../tin/cpp/predicates/predicates.hpp"
#include "level_surface.hpp"

namespace tinsmith::isolines {

// A place of a line: a point and a triangle that holds it, or kNoTriangle.
struct Place {
  Point point;
  Triangle triangle;
};

// A cross product and how far from it the rounded one may be.
struct Turn {
  double value;
  double error;
};

inline Turn measure_turn(Point a, Point b, Point c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  return {left - right, detail::kOrientationBound * (std::fabs(left) + std::fabs(right))};
}

class ElevationWalk {
 public:
  explicit ElevationWalk(const Surface& surface) : surface_(surface) {}

  // Whether the surface is within the tolerance of the level all along a segment but for its ends.
  // `to.triangle` may be kNoTriangle: then the triangle is found.
  bool stays_within(const Place& from, Place& to, double level, double tolerance) const {
    if (from.triangle == kNoTriangle) return false;
    Triangle t = first_triangle(from, to.point);
    std::uint32_t entry = kNoCorner;
    for (std::int32_t steps = 0; t != kNoTriangle && steps < kMostSteps; ++steps) {
      if (t == to.triangle || holds(t, to.point)) {
        to.triangle = t;
        return true;
      }
      const std::uint32_t exit = exit_of(t, entry, from.point, to.point);
      if (exit == kNoCorner) return false;
      const Vertex low = surface_.vertex(t, corner_after(exit));
      const Vertex high = surface_.vertex(t, corner_before(exit));
      if (!is_near(from.point, to.point, low, high, level, tolerance)) return false;
      const Triangle next = surface_.neighbor(t, exit);
      entry = next == kNoTriangle ? kNoCorner : surface_.corner_facing(next, t);
      t = next;
    }
    return false;
  }

  // Whether the surface at a place is within the tolerance of the level.
  bool is_within(const Place& place, double level, double tolerance) const {
    double weight = 0.0, height = 0.0, error = 0.0, largest = 0.0;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const Turn part =
          measure_turn(surface_.corner(place.triangle, corner_after(corner)),
                       surface_.corner(place.triangle, corner_before(corner)), place.point);
      const double rise = surface_.elevation(place.triangle, corner) - level;
      weight += part.value;
      height += part.value * rise;
      error += part.error;
      largest = std::max(largest, std::fabs(rise));
    }
    if (!(weight > 2.0 * error)) return false;
    const double off = std::fabs(height / weight) + 2.0 * largest * error / (weight - error);
    return off * kRoundings <= tolerance;
  }

 private:
  static constexpr std::int32_t kMostSteps = 100'000;
  static constexpr double kRoundings = 1.0 + 16.0 * kUnitRoundoff;  // of the last few operations

  bool holds(Triangle t, Point p) const {
    const Point a = surface_.corner(t, 0), b = surface_.corner(t, 1), c = surface_.corner(t, 2);
    return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
  }

  // Where the walk starts in a vertex, the triangle about it that the segment runs into.
  Triangle first_triangle(const Place& from, Point to) const {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      if (surface_.corner(from.triangle, corner) == from.point) {
        return turn_towards(half_edge(from.triangle, corner), to);
      }
    }
    return from.triangle;
  }

  // Turning about the vertex opposite an edge.
  Triangle turn_towards(HalfEdge start, Point to) const {
    for (const auto turn : {Surface::Turn::kCounterClockwise, Surface::Turn::kClockwise}) {
      HalfEdge e = start;
      std::uint32_t most = surface_.triangle_count;
      do {
        if (leads_to(e, to)) return triangle_of(e);
        if (most-- == 0) throw std::logic_error("a turn about a vertex does not come round");
        e = surface_.next_about(e, turn);
      } while (e != kNoHalfEdge && e != start);
    }
    return kNoTriangle;
  }

  // Whether the way from the vertex opposite an edge to a point begins in the edge's triangle.
  bool leads_to(HalfEdge e, Point to) const {
    const Triangle t = triangle_of(e);
    const Point about = surface_.corner(t, corner_of(e));
    const Point right = surface_.corner(t, corner_after(corner_of(e)));
    const Point left = surface_.corner(t, corner_before(corner_of(e)));
    return orientation(about, right, to) >= 0 && orientation(about, left, to) <= 0 &&
           orientation(right, left, about) > 0;
  }

  // The edge by which the segment leaves a triangle, kNoCorner where no edge is it for certain.
  std::uint32_t exit_of(Triangle t, std::uint32_t entry, Point from, Point to) const {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      if (corner == entry) continue;
      const Point right = surface_.corner(t, corner_after(corner));
      const Point left = surface_.corner(t, corner_before(corner));
      if (orientation(from, to, right) < 0 && orientation(from, to, left) > 0 &&
          orientation(right, left, to) < 0) {
        return corner;
      }
    }
    return kNoCorner;
  }

  // Whether the edge p-q is near the level where the segment crosses it.
  bool is_near(Point from, Point to, Vertex p, Vertex q, double level, double tolerance) const {
    const Turn right = measure_turn(from, to, surface_.point(p));
    const Turn left = measure_turn(from, to, surface_.point(q));
    const double total = std::fabs(right.value) + std::fabs(left.value);
    const double error = right.error + left.error;
    if (!(total > 2.0 * error)) return false;
    const double share = std::fabs(right.value) / total;
    const double slack = 2.0 * error / (total - error) + 4.0 * kUnitRoundoff;
    const double start = surface_.elevation(p), rise = surface_.elevation(q) - start;
    const double off = std::fabs(start - level + share * rise) + slack * std::fabs(rise);
    const double rounding = 4.0 * kUnitRoundoff * (std::fabs(start) + std::fabs(level));
    return (off + rounding) * kRoundings <= tolerance;
  }

  Surface surface_;
};

}  // namespace tinsmith::isolines
