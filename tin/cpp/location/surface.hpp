// A surface as arrays: places, turning about its vertices, and its elevation in a triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../base/rare.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// As the caller holds it.
struct Surface {
  const double* points;           // three numbers a vertex: x, y, z
  const std::int32_t* corners;    // three a triangle
  const std::int32_t* neighbors;  // likewise, kNoNeighbor outside; null where nobody asks
  std::int32_t point_count;
  std::uint32_t triangle_count;

  const double* row(Vertex v) const { return points + 3 * static_cast<std::size_t>(number(v)); }
  Point point(Vertex v) const { return {row(v)[0], row(v)[1]}; }
  double elevation(Vertex v) const { return row(v)[2]; }
  SurfacePoint surface_point(Vertex v) const { return {point(v), elevation(v)}; }

  Vertex vertex(Triangle t, std::uint32_t k) const { return Vertex{corners[entry_of(t, k)]}; }
  Point corner(Triangle t, std::uint32_t k) const { return point(vertex(t, k)); }
  double elevation(Triangle t, std::uint32_t k) const { return elevation(vertex(t, k)); }
  Triangle neighbor(Triangle t, std::uint32_t k) const {
    return triangle_numbered(neighbors[entry_of(t, k)]);
  }
  bool is_triangle(Triangle t) const { return number(t) < triangle_count; }

  // The corner that is not on the edge to a neighbour, and the one that is a vertex; the last one
  // if there is none.
  std::uint32_t corner_facing(Triangle t, Triangle beyond) const {
    return neighbor(t, 0) == beyond ? 0 : neighbor(t, 1) == beyond ? 1 : 2;
  }
  std::uint32_t corner_at(Triangle t, Vertex v) const {
    return vertex(t, 0) == v ? 0 : vertex(t, 1) == v ? 1 : 2;
  }

  // Turning about a vertex, which is opposite an edge of its triangle: the same of the next
  // triangle counter-clockwise, or clockwise. kNoHalfEdge where there is none.
  enum class Turn { kCounterClockwise, kClockwise };
  HalfEdge next_about(HalfEdge opposite, Turn turn) const {
    const Triangle t = triangle_of(opposite);
    const std::uint32_t k = corner_of(opposite);
    const Triangle beyond =
        neighbor(t, turn == Turn::kClockwise ? corner_before(k) : corner_after(k));
    return is_triangle(beyond) ? half_edge(beyond, corner_at(beyond, vertex(t, k))) : kNoHalfEdge;
  }

  // Without a way out of the loops, many are compared at once.
  bool has_sound_corners() const {
    bool sound = true;
    for (std::int64_t i = 0; i < std::int64_t{3} * triangle_count; ++i) {
      sound &= static_cast<std::uint32_t>(corners[i]) < static_cast<std::uint32_t>(point_count);
    }
    return sound;
  }
  // Each is a triangle or kNoNeighbor.
  bool has_sound_neighbors() const {
    bool sound = true;
    for (std::int64_t i = 0; i < std::int64_t{3} * triangle_count; ++i) {
      sound &= static_cast<std::uint32_t>(neighbors[i]) + 1 <= triangle_count;
    }
    return sound;
  }

  // The predicates must not be given what they cannot compute with.
  bool has_sound_points() const {
    bool sound = true;
    for (std::int64_t i = 0; i < std::int64_t{3} * point_count; i += 3) {
      sound &= std::fabs(points[i]) <= kLargestCoordinate;
      sound &= std::fabs(points[i + 1]) <= kLargestCoordinate;
    }
    return sound;
  }

  Box box_of(Triangle t) const {
    Box box;
    for (std::uint32_t k = 0; k < 3; ++k) box.include(corner(t, k));
    return box;
  }
};

// +1 for each triangle that is counter-clockwise, -1 for one that is clockwise, 0 for a flat one.
inline void write_turns(const Surface& surface, std::int8_t* turns) {
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    turns[number(t)] = static_cast<std::int8_t>(
        orientation(surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2)));
  }
}

// Barycentric coordinates: twice the areas opposite the corners of the parts into which p divides a
// triangle; their signs are exact.
struct CornerWeights {
  double of[3];

  static CornerWeights at(Point p, Point a, Point b, Point c) {
    return {
        {detail::twice_area(b, c, p), detail::twice_area(c, a, p), detail::twice_area(a, b, p)}};
  }

  // No two of them are equal, and none is zero: of a point within a triangle, nearly always.
  bool are_distinct() const {
    return of[0] != of[1] && of[1] != of[2] && of[2] != of[0] && of[0] != 0.0 && of[1] != 0.0 &&
           of[2] != 0.0;
  }

  // The same, but of a point on an edge by its two ends alone, as the triangle beyond has it.
  TINSMITH_RARE CornerWeights settled(Point p, Point a, Point b, Point c) const {
    if (of[0] != 0.0 && of[1] != 0.0 && of[2] != 0.0) return *this;
    const Point corners[3] = {a, b, c};
    const std::uint32_t beyond = of[0] == 0.0 ? 0 : of[1] == 0.0 ? 1 : 2;
    const std::uint32_t next = corner_after(beyond), last = corner_before(beyond);
    if (of[next] == 0.0 || of[last] == 0.0) return *this;
    const Point start = corners[next], end = corners[last];
    const bool is_steep = std::fabs(end.y - start.y) > std::fabs(end.x - start.x);
    CornerWeights weights{};
    weights.of[next] = is_steep ? std::fabs(end.y - p.y) : std::fabs(end.x - p.x);
    weights.of[last] = is_steep ? std::fabs(p.y - start.y) : std::fabs(p.x - start.x);
    return weights;
  }

  // Added up by size, so in the same order whichever corner is named first.
  double total() const {
    const double less = std::min(of[0], of[1]), more = std::max(of[0], of[1]);
    return std::max(more, of[2]) + (std::max(less, std::min(more, of[2])) + std::min(less, of[2]));
  }
  std::uint32_t heaviest() const {
    const std::uint32_t main = of[1] > of[0];
    return of[2] > of[main] ? 2 : main;
  }

  // The mean of three elevations, one of a corner each, whichever corner is named first. Differences
  // from the corner of largest weight, of several the lowest one, keep the digits that the elevations
  // share, and give a vertex exactly its own elevation; differences of halves cannot overflow.
  double mean_of(const double (&elevations)[3]) const {
    if (!are_distinct()) return mean_of_equals(elevations);
    return mean_from(heaviest(), elevations);
  }

  // By the corner of largest weight.
  double mean_from(std::uint32_t main, const double (&elevations)[3]) const {
    const std::uint32_t next = corner_after(main), last = corner_before(main);
    const double sum = total();
    const double z = elevations[main], z_next = elevations[next], z_last = elevations[last];
    const double half_rise =
        of[next] / sum * (0.5 * z_next - 0.5 * z) + of[last] / sum * (0.5 * z_last - 0.5 * z);
    const double lowest = std::min({z, z_next, z_last});
    const double highest = std::max({z, z_next, z_last});
    return std::min(std::max(z + 2.0 * half_rise, lowest), highest);
  }

 private:
  // A corner without weight counts nothing.
  TINSMITH_RARE double mean_of_equals(const double (&elevations)[3]) const {
    std::uint32_t main = heaviest();
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (of[k] == of[main] && elevations[k] < elevations[main]) main = k;
    }
    double those[3];
    for (int k = 0; k < 3; ++k) those[k] = of[k] == 0.0 ? elevations[main] : elevations[k];
    return mean_from(main, those);
  }
};

// The elevation of the plane through a triangle's corners at a point that the triangle holds: the
// same however triangles, corners and vertices are numbered, and from both sides of an edge.
inline double elevation_at(const Surface& surface, Point p, Triangle t) {
  const double elevations[3] = {surface.elevation(t, 0), surface.elevation(t, 1),
                                surface.elevation(t, 2)};
  const Point a = surface.corner(t, 0), b = surface.corner(t, 1), c = surface.corner(t, 2);
  const CornerWeights weights = CornerWeights::at(p, a, b, c);
  if (!weights.are_distinct()) return weights.settled(p, a, b, c).mean_of(elevations);
  return weights.mean_from(weights.heaviest(), elevations);
}

}  // namespace tinsmith
