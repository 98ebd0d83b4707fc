// Which rings are the holes of which exterior.
//
// Rings of one walk belong together. A walk without an exterior runs around holes alone: from its
// first point the region goes on downwards, and the first segment below bounds the same part.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../../../tin/cpp/predicates/predicates.hpp"
#include "ring_tracing.hpp"

namespace tinsmith::isolines {

class RingNesting {
 public:
  // Rings sorted by their first points.
  explicit RingNesting(const std::vector<Ring>& rings) : rings_(rings) {
    std::int32_t walks = 0;
    for (const Ring& ring : rings) walks = std::max(walks, ring.walk + 1);
    exterior_.assign(std::size_t(walks), kNone);
    for (std::size_t i = 0; i < rings.size(); ++i) {
      if (rings[i].is_exterior) exterior_[rings[i].walk] = static_cast<std::int32_t>(i);
    }
    list_queries();
    for (const Ring& ring : rings) look_from(ring);
    for (const Query& query : queries_) settle(query);
  }

  static constexpr std::int32_t kNone = -1;

  // The number of the exterior ring around a ring; kNone for a speck that rounding turned over.
  std::int32_t exterior_of(const Ring& ring) const { return exterior_[ring.walk]; }

 private:
  struct Query {
    Point point;
    std::int32_t walk;
    std::int32_t below = kNone;  // the walk of the segment from left to right
    Point left{};
    Point right{};
  };

  // The first point of each walk of holes, by easting, then northing.
  void list_queries() {
    std::vector<char> is_listed(exterior_.size(), 0);
    for (const Ring& ring : rings_) {
      if (exterior_[ring.walk] != kNone || is_listed[ring.walk]) continue;
      is_listed[ring.walk] = 1;
      queries_.push_back({ring.points.front(), ring.walk});
    }
  }

  // Offer the segments of a ring to the points above them.
  void look_from(const Ring& ring) {
    if (queries_.empty()) return;
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
      Point left = ring.points[i];
      Point right = ring.points[i + 1 < ring.points.size() ? i + 1 : 0];
      if (right.x < left.x) std::swap(left, right);
      // The ray runs a hair to the left of its point: segments end there, and none begins.
      const auto by_easting = [](double x, const Query& q) { return x < q.point.x; };
      const auto begin = std::upper_bound(queries_.begin(), queries_.end(), left.x, by_easting);
      const auto end = std::upper_bound(begin, queries_.end(), right.x, by_easting);
      for (auto query = begin; query != end; ++query) offer(*query, left, right, ring.walk);
    }
  }

  static void offer(Query& query, Point left, Point right, std::int32_t walk) {
    if (orientation(left, right, query.point) <= 0) return;
    if (query.below != kNone && !is_higher(left, right, query.left, query.right)) return;
    query.below = walk;
    query.left = left;
    query.right = right;
  }

  // Whether a segment runs above another that it does not cross; both pass below one point.
  static bool is_higher(Point left, Point right, Point other_left, Point other_right) {
    if (left.x >= other_left.x) {
      const int side = orientation(other_left, other_right, left);
      return side != 0 ? side > 0 : orientation(other_left, other_right, right) > 0;
    }
    const int side = orientation(left, right, other_left);
    return side != 0 ? side < 0 : orientation(left, right, other_right) < 0;
  }

  // The walk below comes further left, so that its own exterior is known.
  void settle(const Query& query) {
    if (query.below != kNone) exterior_[query.walk] = exterior_[query.below];
  }

  const std::vector<Ring>& rings_;
  std::vector<std::int32_t> exterior_;  // the ring, for each walk
  std::vector<Query> queries_;          // by easting, then northing
};

}  // namespace tinsmith::isolines
