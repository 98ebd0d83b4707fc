// A TIN and levels: which edges a level crosses, and where.
//
// A level is thought just below its value: a vertex at the level lies above it. Every vertex is
// therefore above or below, a triangle is crossed in two edges or in none, and all decisions are
// comparisons of ranks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/point.hpp"

namespace tinsmith::isolines {

// The arrays of a TIN.
struct SurfaceArrays {
  const double* xyz;
  const std::int32_t* triangles;
  const std::int32_t* neighbors;
  std::int32_t vertex_count;
  std::int32_t triangle_count;
};

// Elevations, strictly ascending.
struct Levels {
  const double* values;
  std::int32_t count;
};

// The edge of a triangle by which a line leaves it; the higher end lies on the line's left.
struct Exit {
  std::uint32_t corner;  // opposite the edge
  Vertex low;
  Vertex high;
};

// A crossing of an edge: where the elevation is the level. The same from both triangles, as it is
// computed from the lower end to the higher one.
inline Point cross_edge(const double* low, const double* high, double level) {
  if (high[2] == level) return {high[0], high[1]};
  const double rise = high[2] - low[2];
  // Halves where the difference of two huge elevations overflows.
  const double share = std::isfinite(rise) ? (level - low[2]) / rise
                                           : (0.5 * level - 0.5 * low[2]) /
                                                 (0.5 * high[2] - 0.5 * low[2]);
  const auto between = [share](double a, double b) {
    const double value = a + share * (b - a);
    return std::min(std::max(value, std::min(a, b)), std::max(a, b));
  };
  return {between(low[0], high[0]), between(low[1], high[1])};
}

class LevelSurface {
 public:
  LevelSurface(const SurfaceArrays& surface, const Levels& levels)
      : surface_(surface), levels_(levels), rank_(surface.vertex_count) {
    const double first = levels.count > 0 ? levels.values[0] : 0.0;
    const double range = levels.count > 1 ? levels.values[levels.count - 1] - first : 0.0;
    const double per_unit = range > 0.0 ? (levels.count - 1) / range : 0.0;
    for (std::int32_t v = 0; v < surface.vertex_count; ++v) {
      rank_[v] = rank_of(surface.xyz[3 * std::size_t(v) + 2], first, per_unit);
    }
  }

  const SurfaceArrays& arrays() const { return surface_; }
  std::int32_t level_count() const { return levels_.count; }
  double level(std::int32_t number) const { return levels_.values[number]; }

  // How many levels are at or below a vertex.
  std::int32_t rank(Vertex v) const { return rank_[number(v)]; }
  bool is_above(Vertex v, std::int32_t level) const { return rank(v) > level; }
  bool is_at(Vertex v, std::int32_t level) const { return xyz(v)[2] == levels_.values[level]; }

  Vertex corner(Triangle t, std::uint32_t corner) const {
    return Vertex{surface_.triangles[entry_of(t, corner)]};
  }
  Triangle neighbor(Triangle t, std::uint32_t corner) const {
    const std::int32_t across = surface_.neighbors[entry_of(t, corner)];
    return across == kNoNeighbor ? kNoTriangle : Triangle{static_cast<std::uint32_t>(across)};
  }
  const double* xyz(Vertex v) const { return surface_.xyz + 3 * std::size_t(number(v)); }
  Point point(Vertex v) const { return {xyz(v)[0], xyz(v)[1]}; }

  // The lowest and the highest rank of a triangle's corners: levels from the first to before the
  // second cross it, and bands from the first to the second have a part of it.
  std::pair<std::int32_t, std::int32_t> ranks(Triangle t) const {
    const std::int32_t a = rank(corner(t, 0));
    const std::int32_t b = rank(corner(t, 1));
    const std::int32_t c = rank(corner(t, 2));
    return {std::min(a, std::min(b, c)), std::max(a, std::max(b, c))};
  }

  // Bit k says whether corner k is above.
  std::uint32_t corners_above(Triangle t, std::int32_t level) const {
    return std::uint32_t{is_above(corner(t, 0), level)} |
           std::uint32_t{is_above(corner(t, 1), level)} << 1 |
           std::uint32_t{is_above(corner(t, 2), level)} << 2;
  }

  Exit exit_of(Triangle t, std::uint32_t above) const {
    // The edge that rises from below to above counter-clockwise, for each set of corners above.
    constexpr std::uint32_t kRising[8] = {3, 1, 2, 1, 0, 0, 2, 3};
    return edge(t, kRising[above]);
  }
  Exit entry_of_line(Triangle t, std::uint32_t above) const {
    constexpr std::uint32_t kFalling[8] = {3, 2, 0, 0, 1, 2, 1, 3};
    const Exit falling = edge(t, kFalling[above]);
    return {falling.corner, falling.high, falling.low};
  }
  Point crossing(const Exit& edge, std::int32_t level) const {
    return cross_edge(xyz(edge.low), xyz(edge.high), levels_.values[level]);
  }

  // The triangle beyond a ridge at the level, kNoTriangle where there is none: an edge at the
  // level from which the surface falls on both sides. A line would run along it forth and back.
  Triangle beyond_ridge(Triangle t, std::uint32_t above, std::int32_t level) const {
    constexpr std::uint32_t kLoneBelow[8] = {3, 3, 3, 2, 3, 1, 0, 3};
    const std::uint32_t lone = kLoneBelow[above];
    if (lone == 3 || !is_at(corner(t, corner_after(lone)), level) ||
        !is_at(corner(t, corner_before(lone)), level)) {
      return kNoTriangle;
    }
    const Triangle beyond = neighbor(t, lone);
    if (beyond == kNoTriangle || corners_above(beyond, level) == 7) return kNoTriangle;
    return beyond;
  }

 private:
  Exit edge(Triangle t, std::uint32_t opposite) const {
    if (opposite > 2) throw std::invalid_argument("the neighbours are not those of the triangles");
    return {opposite, corner(t, corner_after(opposite)), corner(t, corner_before(opposite))};
  }

  // Levels are mostly at even intervals: then the guess is right, or next to it.
  std::int32_t rank_of(double elevation, double first, double per_unit) const {
    const double* const values = levels_.values;
    const double guess = (elevation - first) * per_unit + 1.0;
    if (guess > 0.0 && guess < levels_.count) {
      const auto rank = static_cast<std::int32_t>(guess);
      for (const std::int32_t tried : {rank, rank + 1}) {
        if (tried >= 1 && tried < levels_.count && values[tried - 1] <= elevation &&
            elevation < values[tried]) {
          return tried;
        }
      }
    }
    return static_cast<std::int32_t>(
        std::upper_bound(values, values + levels_.count, elevation) - values);
  }

  SurfaceArrays surface_;
  Levels levels_;
  ScratchVector<std::int32_t> rank_;
};

}  // namespace tinsmith::isolines
