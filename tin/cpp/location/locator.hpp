// Point location: which triangle holds a point, and which is the surface's elevation there?
//
// A short walk over neighbours, from the triangle of the query before, guesses; a tree of boxes
// proves. The walk, across edges with the query furthest beyond them, is believed only where
// floating point is certain that the query lies strictly inside a triangle. All else - on an edge
// or a vertex, outside, across a gap, too far away - is decided by testing every triangle whose box
// holds the query, exactly. So the answer needs no convex boundary, no Delaunay triangles and no
// sound neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "../base/ids.hpp"
#include "../index/box_tree.hpp"
#include "../index/hilbert_order.hpp"
#include "../predicates/predicates.hpp"
#include "ordered_surface.hpp"
#include "surface.hpp"
#include "visibility_walk.hpp"

namespace tinsmith {

class Locator {
 public:
  // The surface's arrays must outlive the locator, and its points and corners be sound.
  explicit Locator(const Surface& surface)
      : given_(surface),
        copy_(surface),
        surface_(copy_.surface()),
        tree_(static_cast<std::int32_t>(surface.triangle_count),
              [&](std::int32_t i) { return surface_.box_of(triangle_numbered(i)); }) {}

  // Triangle of each query, -1 outside. False if asked to stop.
  template <typename KeepGoing>
  bool locate(const Point* queries, std::int64_t count, std::int32_t* result,
              KeepGoing&& keep_going) const {
    return visit_queries(queries, count, keep_going, [&](std::int64_t i, Point, Triangle triangle) {
      result[i] = index_of(triangle == kNoTriangle ? triangle : copy_.given_number(triangle));
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

  // Every triangle whose box a band may meet, and some more, in no order, as the caller calls them.
  template <typename Near, typename Visit>
  void visit_near(const Near& band, Visit&& visit) const {
    const auto wanted = [&](const Box& box, std::int64_t) { return band.meets(box); };
    tree_.visit_leaves_if(wanted, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = begin; i < end; ++i) visit(copy_.given_number(triangle_numbered(i)));
      return false;
    });
  }

  double elevation_at(Point p, Triangle triangle) const {
    return tinsmith::elevation_at(given_, p, triangle);
  }

  // visit(i, point, triangle of ordered()) of each query, kNoTriangle outside: in an order in which
  // neighbours in the plane follow each other. False if asked to stop.
  template <typename KeepGoing, typename Visit>
  bool visit_queries(const Point* all_queries, std::int64_t count, KeepGoing&& keep_going,
                     Visit&& visit) const {
    Triangle last = kNoTriangle;
    int longest_walk = kLongestWalk;
    for (std::int64_t begin = 0; begin < count; begin += kQueriesAtATime) {
      const auto size = static_cast<std::int32_t>(std::min(kQueriesAtATime, count - begin));
      const Point* queries = all_queries + begin;
      const HilbertOrder order(queries, size, kCellsPerQuery);
      for (std::int32_t first = 0; first < size; first += kBlock) {
        if (!keep_going()) return false;
        const std::int32_t end = std::min(first + kBlock, size);
        std::array<Point, kBlock> block;
        for (std::int32_t i = first; i < end; ++i) block[i - first] = queries[order[i]];
        for (std::int32_t i = first; i < end; ++i) {
          const Point p = block[i - first];
          const Triangle triangle = find(p, last, longest_walk);
          if (triangle != kNoTriangle) last = triangle;
          visit(begin + order[i], p, triangle);
        }
      }
    }
    return true;
  }

  // As the caller numbers triangles and vertices,
  const Surface& surface() const { return given_; }
  // and as they lie in the plane.
  const OrderedSurface& ordered() const { return copy_; }

 private:
  static constexpr std::int64_t kQueriesAtATime = std::int64_t{1} << 22;  // bounds the memory
  static constexpr int kCellsPerQuery = 1;      // within one the order matters little
  static constexpr std::int32_t kBlock = 4096;  // fits the first-level cache
  static constexpr int kLongestWalk = 24;       // as costly as a search among even triangles

  // A walk may be as long as the last search was: among long triangles aslant, most of whose boxes
  // overlap, that is many steps.
  Triangle find(Point p, Triangle start, int& longest_walk) const {
    const Triangle guess = start == kNoTriangle ? kNoTriangle : walk(p, start, longest_walk);
    if (guess != kNoTriangle) return guess;
    std::int32_t tested = 0;
    const Triangle found = search(p, tested);
    longest_walk = std::max(kLongestWalk, tested);
    return found;
  }

  // The triangle that certainly holds p strictly inside, or kNoTriangle for "cannot say".
  Triangle walk(Point p, Triangle start, int longest) const {
    const auto next = [this, p](HalfEdge entry) {
      const Triangle triangle = triangle_of(entry);
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
      if (side[outermost] > bound) return entry;
      if (!(side[outermost] < -bound)) return kNoHalfEdge;
      const Triangle beyond = surface_.neighbor(triangle, outermost);
      const bool leads_on = surface_.is_triangle(beyond) && beyond != triangle;
      return leads_on ? unentered(beyond) : kNoHalfEdge;
    };
    const HalfEdge end = walk_towards(unentered(start), static_cast<std::uint32_t>(longest), next);
    return end == kNoHalfEdge ? kNoTriangle : triangle_of(end);
  }

  // The triangle that holds p, boundary included, and of several the one that the caller calls by
  // the smallest number; exact and complete. Counts the triangles that are tested.
  Triangle search(Point p, std::int32_t& tested) const {
    Triangle best = kNoTriangle, smallest = kNoTriangle;  // the largest number of all
    tree_.visit_leaves(p, [&](std::int32_t begin, std::int32_t end) {
      tested += end - begin;
      for (std::int32_t i = begin; i < end; ++i) {
        const Triangle triangle = triangle_numbered(i), given = copy_.given_number(triangle);
        if (given > smallest) continue;
        const Within within = position(p, triangle);
        if (within == Within::kOutside) continue;
        best = triangle;
        smallest = given;
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

  Surface given_;
  OrderedSurface copy_;
  Surface surface_;  // of the copy
  BoxTree tree_;
};

}  // namespace tinsmith
