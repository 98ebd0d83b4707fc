// Point location: which triangle holds a point, and which is the surface's elevation there?
//
// A short walk over neighbours, from the triangle of the query before, guesses; a tree of boxes
// proves. The walk is believed only where floating point is certain that the query lies strictly
// inside a triangle. All else - on an edge or a vertex, outside, across a gap, too far away - is
// decided by testing every triangle whose box holds the query, exactly. So the answer needs no
// convex boundary, no Delaunay triangles and no sound neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "../base/ids.hpp"
#include "../index/box_tree.hpp"
#include "../index/hilbert_order.hpp"
#include "../predicates/expansion.hpp"
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

class Locator {
 public:
  // The surface's arrays must outlive the locator, and its points and corners be sound.
  explicit Locator(const Surface& surface)
      : surface_(surface),
        triangles_(in_spatial_order(surface)),
        tree_(static_cast<std::int32_t>(surface.triangle_count),
              [&](std::int32_t i) { return surface.box_of(triangles_[i]); }) {}

  // Triangle of each query, -1 outside. False if asked to stop.
  template <typename KeepGoing>
  bool locate(const Point* queries, std::int64_t count, std::int32_t* result,
              KeepGoing&& keep_going) const {
    return visit_queries(queries, count, keep_going, [&](std::int64_t i, Point, Triangle triangle) {
      result[i] = static_cast<std::int32_t>(number(triangle));
    });
  }

  // Elevation at each query, NaN outside. False if asked to stop.
  template <typename KeepGoing>
  bool interpolate(const Point* queries, std::int64_t count, double* result,
                   KeepGoing&& keep_going) const {
    return visit_queries(
        queries, count, keep_going, [&](std::int64_t i, Point p, Triangle triangle) {
          result[i] = triangle == kNoTriangle ? std::numeric_limits<double>::quiet_NaN()
                                              : tinsmith::elevation_at(surface_, p, triangle);
        });
  }

  // Every triangle whose box a band may meet, and some more, in no order.
  template <typename Near, typename Visit>
  void visit_near(const Near& band, Visit&& visit) const {
    const auto wanted = [&](const Box& box, std::int64_t) { return band.meets(box); };
    tree_.visit_leaves_if(wanted, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = begin; i < end; ++i) visit(triangles_[i]);
      return false;
    });
  }

  double elevation_at(Point p, Triangle triangle) const {
    return tinsmith::elevation_at(surface_, p, triangle);
  }

  // visit(i, point, triangle) of each query, kNoTriangle outside: in an order in which neighbours in
  // the plane follow each other. False if asked to stop.
  template <typename KeepGoing, typename Visit>
  bool visit_queries(const Point* all_queries, std::int64_t count, KeepGoing&& keep_going,
                     Visit&& visit) const {
    Triangle last = kNoTriangle;
    for (std::int64_t begin = 0; begin < count; begin += kQueriesAtATime) {
      const auto size = static_cast<std::int32_t>(std::min(kQueriesAtATime, count - begin));
      const Point* queries = all_queries + begin;
      const HilbertOrder order(queries, size);
      for (std::int32_t first = 0; first < size; first += kBlock) {
        if (!keep_going()) return false;
        const std::int32_t end = std::min(first + kBlock, size);
        std::array<Point, kBlock> block;
        for (std::int32_t i = first; i < end; ++i) block[i - first] = queries[order[i]];
        for (std::int32_t i = first; i < end; ++i) {
          const Point p = block[i - first];
          const Triangle triangle = find(p, last);
          if (triangle != kNoTriangle) last = triangle;
          visit(begin + order[i], p, triangle);
        }
      }
    }
    return true;
  }

  const Surface& surface() const { return surface_; }

 private:
  static constexpr std::int64_t kQueriesAtATime = std::int64_t{1} << 22;  // bounds the memory
  static constexpr std::int32_t kBlock = 4096;  // fits the first-level cache
  static constexpr int kLongestWalk = 24;       // as costly as a search

  static std::vector<Triangle> in_spatial_order(const Surface& surface) {
    std::vector<Point> centers(surface.triangle_count);
    for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
      centers[number(t)] = surface.box_of(t).center();
    }
    const auto count = static_cast<std::int32_t>(surface.triangle_count);
    const HilbertOrder order(centers.data(), count);
    std::vector<Triangle> triangles(surface.triangle_count);
    for (std::int32_t i = 0; i < count; ++i) {
      triangles[i] = Triangle{static_cast<std::uint32_t>(order[i])};
    }
    return triangles;
  }

  Triangle find(Point p, Triangle start) const {
    const Triangle guess = start == kNoTriangle ? kNoTriangle : walk(p, start);
    return guess == kNoTriangle ? search(p) : guess;
  }

  // The triangle that certainly holds p strictly inside, or kNoTriangle for "cannot say".
  Triangle walk(Point p, Triangle triangle) const {
    for (int step = 0; step < kLongestWalk && surface_.is_triangle(triangle); ++step) {
      const Point a = surface_.corner(triangle, 0);
      const Point b = surface_.corner(triangle, 1);
      const Point c = surface_.corner(triangle, 2);
      const double ax = a.x - p.x, ay = a.y - p.y;
      const double bx = b.x - p.x, by = b.y - p.y;
      const double cx = c.x - p.x, cy = c.y - p.y;
      const double bxcy = bx * cy, bycx = by * cx;
      const double cxay = cx * ay, cyax = cy * ax;
      const double axby = ax * by, aybx = ay * bx;
      const double side[3] = {bxcy - bycx, cxay - cyax, axby - aybx};
      const double bound =
          detail::kOrientationBound * (std::fabs(bxcy) + std::fabs(bycx) + std::fabs(cxay) +
                                       std::fabs(cyax) + std::fabs(axby) + std::fabs(aybx));
      std::uint32_t outermost = side[1] < side[0];
      outermost = side[2] < side[outermost] ? 2 : outermost;
      if (side[outermost] > bound) return triangle;
      if (!(side[outermost] < -bound)) return kNoTriangle;
      triangle = surface_.neighbor(triangle, outermost);
    }
    return kNoTriangle;
  }

  // The smallest triangle that holds p, boundary included; exact and complete.
  Triangle search(Point p) const {
    Triangle best = kNoTriangle;
    tree_.visit_leaves(p, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = begin; i < end; ++i) {
        const Triangle triangle = triangles_[i];
        if (triangle > best) continue;  // kNoTriangle is the largest
        const Within within = position(p, triangle);
        if (within == Within::kOutside) continue;
        best = triangle;
        if (within == Within::kInside) return true;  // then no other triangle holds p
      }
      return false;
    });
    return best;
  }

  enum class Within { kOutside, kBoundary, kInside };

  Within position(Point p, Triangle triangle) const {
    const Point a = surface_.corner(triangle, 0);
    const Point b = surface_.corner(triangle, 1);
    const int side_ab = orientation(a, b, p);
    if (side_ab < 0) return Within::kOutside;
    const Point c = surface_.corner(triangle, 2);
    const int side_bc = orientation(b, c, p);
    if (side_bc < 0) return Within::kOutside;
    const int side_ca = orientation(c, a, p);
    if (side_ca < 0) return Within::kOutside;
    const int positive = side_ab + side_bc + side_ca;
    if (positive == 0) return Within::kOutside;  // a triangle without area holds nothing
    return positive == 3 ? Within::kInside : Within::kBoundary;
  }

  Surface surface_;
  std::vector<Triangle> triangles_;  // in spatial order
  BoxTree tree_;
};

}  // namespace tinsmith
