// A TIN and levels: which edges a level crosses, and where.
//
// A level is thought just below its value: a vertex at the level lies above it. Every vertex is
// therefore above or below, a triangle is crossed in two edges or in none, and all decisions are
// comparisons of ranks.
//
// A vertex so near to a level that its lines would pass it within some roundings of its coordinates
// is taken to be at the level: lines through such a place could not be told apart.
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
#include "../../../tin/cpp/location/surface.hpp"

namespace tinsmith::isolines {

// Elevations, strictly ascending.
struct Levels {
  const double* values;
  std::int32_t count;
};

// Of triangles by levels, and parts of triangles in bands: numbers of 32 bits are left for marks.
constexpr std::uint64_t kMostCrossings = INT32_MAX;

// The edge of a triangle by which a line leaves it; the higher end lies on the line's left.
struct Exit {
  std::uint32_t corner;  // opposite the edge
  Vertex low;
  Vertex high;
};

// A vertex, half a line of the cache; its elevation perhaps moved to a level.
struct alignas(32) LevelVertex {
  Point point;
  double elevation;
};

// A crossing of an edge: where the elevation is the level. The same from both triangles, as it is
// computed from the lower end to the higher one.
inline Point cross_edge(const LevelVertex& low, const LevelVertex& high, double level) {
  if (high.elevation == level) return high.point;
  const double rise = high.elevation - low.elevation;
  // Halves where the difference of two huge elevations overflows.
  const double share = std::isfinite(rise) ? (level - low.elevation) / rise
                                           : (0.5 * level - 0.5 * low.elevation) /
                                                 (0.5 * high.elevation - 0.5 * low.elevation);
  const auto between = [share](double a, double b) {
    const double value = a + share * (b - a);
    return std::min(std::max(value, std::min(a, b)), std::max(a, b));
  };
  return {between(low.point.x, high.point.x), between(low.point.y, high.point.y)};
}

class LevelSurface {
 public:
  LevelSurface(const Surface& surface, const Levels& levels)
      : surface_(surface),
        levels_(levels),
        vertices_(surface.point_count),
        rank_(surface.point_count) {
    const std::vector<Vertex> near_levels = rank_vertices();
    if (!near_levels.empty()) move_to_levels(near_levels);
  }

  std::uint32_t triangle_count() const { return surface_.triangle_count; }
  Ids<Triangle> triangles() const { return Ids<Triangle>(triangle_count()); }
  std::int32_t level_count() const { return levels_.count; }
  double level(std::int32_t number) const { return levels_.values[number]; }

  // How many levels are at or below a vertex.
  std::int32_t rank(Vertex v) const { return rank_[number(v)]; }
  bool is_above(Vertex v, std::int32_t level) const { return rank(v) > level; }
  bool is_at(Vertex v, std::int32_t level) const {
    return vertices_[number(v)].elevation == levels_.values[level];
  }

  Vertex corner(Triangle t, std::uint32_t corner) const { return surface_.vertex(t, corner); }
  Triangle neighbor(Triangle t, std::uint32_t corner) const { return surface_.neighbor(t, corner); }
  Point point(Vertex v) const { return vertices_[number(v)].point; }

  // Ask for what the corners of a triangle hold, before it is needed: vertices lie anywhere in
  // memory. GCC drops the calls of a function that does nothing else if it is not part of the
  // caller.
  [[gnu::always_inline]] void prefetch_ranks(Triangle t) const {
    prefetch_corners(t, rank_.data());
  }
  [[gnu::always_inline]] void prefetch_vertices(Triangle t) const {
    prefetch_corners(t, vertices_.data());
  }

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
    return cross_edge(vertices_[number(edge.low)], vertices_[number(edge.high)],
                      levels_.values[level]);
  }

  // The triangle beyond a ridge at the level, kNoTriangle where there is none: an edge at the
  // level from which the surface falls on both sides. A line would run along it forth and back.
  Triangle beyond_ridge(Triangle t, std::uint32_t above, std::int32_t level) const {
    constexpr std::uint32_t kLoneBelow[8] = {3, 3, 3, 2, 3, 1, 0, 3};
    const std::uint32_t lone = kLoneBelow[above];
    const bool is_ridge = lone != 3 && is_at(corner(t, corner_after(lone)), level) &&
                          is_at(corner(t, corner_before(lone)), level);
    if (!is_ridge) return kNoTriangle;
    const Triangle beyond = neighbor(t, lone);
    if (beyond == kNoTriangle || corners_above(beyond, level) == 7) return kNoTriangle;
    return beyond;
  }

 private:
  // A line nearer to a vertex than so many roundings of its coordinates runs through it,
  static constexpr double kRoundings = 16.0;
  // if the surface is no steeper: walls of a kilometre within a millimetre are. So it is known of
  // each vertex alone whether its triangles need to be looked at.
  static constexpr double kSteepest = 0x1p20;

  template <typename Row>
  [[gnu::always_inline]] void prefetch_corners(Triangle t, const Row* rows) const {
#if defined(__GNUC__)
    if (!surface_.is_triangle(t)) return;
    for (std::uint32_t k = 0; k < 3; ++k) __builtin_prefetch(rows + number(corner(t, k)));
#else
    (void)t, (void)rows;
#endif
  }

  // Returns the vertices near to a level, but not at it.
  std::vector<Vertex> rank_vertices() {
    const double first = levels_.count > 0 ? levels_.values[0] : 0.0;
    const double range = levels_.count > 1 ? levels_.values[levels_.count - 1] - first : 0.0;
    const double per_unit = range > 0.0 ? (levels_.count - 1) / range : 0.0;
    std::vector<Vertex> near_levels;
    for (const Vertex v : Ids<Vertex>(surface_.point_count)) {
      const double elevation = surface_.elevation(v);
      vertices_[number(v)] = {surface_.point(v), elevation};
      rank_[number(v)] = rank_of(elevation, first, per_unit);
      const double off = elevation - nearest_level(v);
      if (off != 0.0 && std::fabs(off) <= reach_of(v, kSteepest)) near_levels.push_back(v);
    }
    return near_levels;
  }

  // How far from a level a vertex may be whose surroundings are so steep, to be taken to be there.
  double reach_of(Vertex v, double steepness) const {
    const double largest = std::max(std::fabs(point(v).x), std::fabs(point(v).y));
    return kRoundings * 0x1p-52 * largest * steepness;
  }

  double nearest_level(Vertex v) const {
    const double elevation = vertices_[number(v)].elevation;
    const std::int32_t r = rank(v);
    const double below = r > 0 ? levels_.values[r - 1] : -HUGE_VAL;
    const double above = r < levels_.count ? levels_.values[r] : HUGE_VAL;
    return elevation - below <= above - elevation ? below : above;
  }

  void move_to_levels(const std::vector<Vertex>& near_levels) {
    const std::vector<double> steepest = find_steepest(near_levels);
    for (std::size_t i = 0; i < near_levels.size(); ++i) {
      const Vertex v = near_levels[i];
      const double level = nearest_level(v);
      double& elevation = vertices_[number(v)].elevation;
      const double steepness = std::min(steepest[i], kSteepest);
      if (!(std::fabs(elevation - level) <= reach_of(v, steepness))) continue;
      elevation = level;
      const double* const end = levels_.values + levels_.count;
      rank_[number(v)] =
          static_cast<std::int32_t>(std::upper_bound(levels_.values, end, level) - levels_.values);
    }
  }

  // How steeply the edges of some vertices rise or fall at most.
  std::vector<double> find_steepest(const std::vector<Vertex>& from) const {
    std::vector<double> steepest(from.size(), 0.0);
    constexpr std::int32_t kNone = -1;
    std::vector<std::int32_t> place(std::size_t(surface_.point_count), kNone);
    for (std::size_t i = 0; i < from.size(); ++i) {
      place[number(from[i])] = static_cast<std::int32_t>(i);
    }
    for (const Triangle t : triangles()) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Vertex v = corner(t, k);
        if (place[number(v)] == kNone) continue;
        double& most = steepest[place[number(v)]];
        most = std::max({most, steepness(v, corner(t, corner_after(k))),
                         steepness(v, corner(t, corner_before(k)))});
      }
    }
    return steepest;
  }

  double steepness(Vertex v, Vertex w) const {
    const LevelVertex &p = vertices_[number(v)], &q = vertices_[number(w)];
    return std::fabs(p.elevation - q.elevation) /
           std::hypot(p.point.x - q.point.x, p.point.y - q.point.y);
  }

  Exit edge(Triangle t, std::uint32_t opposite) const {
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
    return static_cast<std::int32_t>(std::upper_bound(values, values + levels_.count, elevation) -
                                     values);
  }

  Surface surface_;
  Levels levels_;
  ScratchVector<LevelVertex> vertices_;
  ScratchVector<std::int32_t> rank_;  // apart: so few bytes stay in the cache
};

}  // namespace tinsmith::isolines
