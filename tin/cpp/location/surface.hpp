// A surface as arrays, and its elevation in a triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// Triangles by number, as the caller holds them.
struct Surface {
  const double* points;  // x, y, z
  const std::int32_t* corners;
  const std::int32_t* neighbors;
  std::int32_t point_count;
  std::uint32_t triangle_count;

  Point corner(Triangle t, std::uint32_t k) const {
    const double* row = points + 3 * static_cast<std::size_t>(number(vertex(t, k)));
    return {row[0], row[1]};
  }
  double elevation(Triangle t, std::uint32_t k) const {
    return points[3 * static_cast<std::size_t>(number(vertex(t, k))) + 2];
  }
  Vertex vertex(Triangle t, std::uint32_t k) const { return Vertex{corners[entry_of(t, k)]}; }
  Triangle neighbor(Triangle t, std::uint32_t k) const {
    return Triangle{static_cast<std::uint32_t>(neighbors[entry_of(t, k)])};
  }
  bool is_triangle(Triangle t) const { return number(t) < triangle_count; }

  bool has_sound_corners() const {
    bool sound = true;
    for (std::int64_t i = 0; i < std::int64_t{3} * triangle_count; ++i) {
      sound &= corners[i] >= 0 && corners[i] < point_count;
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

// Twice the areas opposite the corners of the parts into which p divides a triangle; their signs
// are exact.
struct CornerWeights {
  double of[3];

  static CornerWeights at(Point p, Point a, Point b, Point c) {
    return {
        {detail::twice_area(b, c, p), detail::twice_area(c, a, p), detail::twice_area(a, b, p)}};
  }

  double total() const { return of[0] + of[1] + of[2]; }
  std::uint32_t heaviest() const {
    const std::uint32_t main = of[1] > of[0];
    return of[2] > of[main] ? 2 : main;
  }

  // The mean of three elevations, one of a corner each. Differences from the corner of largest
  // weight keep the digits that the elevations share, and give a vertex exactly its own elevation;
  // differences of halves cannot overflow.
  double mean_of(const double (&elevations)[3]) const {
    const std::uint32_t main = heaviest(), next = (main + 1) % 3, last = (main + 2) % 3;
    const double sum = total();
    const double z = elevations[main], z_next = elevations[next], z_last = elevations[last];
    const double half_rise =
        of[next] / sum * (0.5 * z_next - 0.5 * z) + of[last] / sum * (0.5 * z_last - 0.5 * z);
    const double lowest = std::min({z, z_next, z_last});
    const double highest = std::max({z, z_next, z_last});
    return std::min(std::max(z + 2.0 * half_rise, lowest), highest);
  }
};

// The elevation of the plane through a triangle's corners at a point that the triangle holds.
inline double elevation_at(const Surface& surface, Point p, Triangle t) {
  const double elevations[3] = {surface.elevation(t, 0), surface.elevation(t, 1),
                                surface.elevation(t, 2)};
  return CornerWeights::at(p, surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2))
      .mean_of(elevations);
}

}  // namespace tinsmith
