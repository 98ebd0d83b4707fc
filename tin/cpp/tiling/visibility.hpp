// What is seen from a triangle, past edges that are segments?
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../predicates/predicates.hpp"
#include "plane_triangles.hpp"

namespace tinsmith {

struct Disc {
  Point center;
  double radius;  // may be infinite
};

// The triangles that lines of sight from the inside of a triangle reach within a disc that holds
// its circumscribed one. They cross edges that are no segments:
//
//          l1 . . . . l2         a line that crosses e1, e2 ... has their left ends l1, l2 ... on
//         e1          e2         its left, and their right ends on its right. Such lines lie between
//          r1 . . r2             two extreme ones: the one turned most to the left passes a right
//                                end first, and then a left one; the other a left end, then a right
//
// Across an edge lies a triangle with a third corner. To go on beyond it to the right, this corner
// becomes a left end: some line must have it on its left. If it lies right of the line that is
// turned most to the left, it is the end that this line passes from now on. The lines are those of
// the hourglass of Guibas, Hershberger, Leven, Sharir and Tarjan (Algorithmica 2, 1987); here they
// are held by the given points themselves, so that every test is exact.
class Visibility {
 public:
  Visibility(const PlaneTriangles& triangles, const bool* is_fixed, std::size_t most)
      : triangles_(triangles), is_fixed_(is_fixed), most_(most) {}

  // Appends them, ascending, with the triangle itself; false, and nothing, if there are too many
  // sequences of edges.
  bool find(Triangle start, const Disc& disc, std::vector<std::int32_t>& result) {
    ends_.clear();
    waiting_.clear();
    found_.assign(1, index_of(start));
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Point right = triangles_.corner(start, (k + 1) % 3);
      const Point left = triangles_.corner(start, (k + 2) % 3);
      const Sight sight{left, right, left, right, add(left, kNone), add(right, kNone)};
      cross({start, k}, sight, disc);
    }
    while (!waiting_.empty()) {
      if (found_.size() > most_) return false;
      const Waiting next = waiting_.back();
      waiting_.pop_back();
      found_.push_back(index_of(next.edge.triangle));
      go_on(next, disc);
    }
    std::sort(found_.begin(), found_.end());
    result.insert(result.end(), found_.begin(), std::unique(found_.begin(), found_.end()));
    return true;
  }

 private:
  static constexpr std::int32_t kNone = -1;
  static constexpr double kSlack = 0x1p-44;  // of distances: far more than their roundings

  struct Edge {
    Triangle triangle;
    std::uint32_t corner;  // opposite
  };
  struct End {
    Point at;
    std::int32_t before;
  };
  // Lines of sight: the one that is turned most to the left runs from most_left_from to
  // most_left_to, and so on. Of the ends on both sides those are kept that a line may pass.
  struct Sight {
    Point most_left_to, most_left_from, most_right_from, most_right_to;
    std::int32_t lefts, rights;
  };
  struct Waiting {
    Edge edge;  // through which the triangle was entered
    Sight sight;
  };

  std::int32_t add(Point at, std::int32_t before) {
    ends_.push_back({at, before});
    return static_cast<std::int32_t>(ends_.size()) - 1;
  }

  // Goes to the triangle beyond an edge, as seen from a triangle before it.
  void cross(Edge edge, const Sight& sight, const Disc& disc) {
    if (is_fixed_[entry_of(edge.triangle, edge.corner)]) return;
    const Triangle beyond = triangles_.neighbor(edge.triangle, edge.corner);
    if (!triangles_.is_triangle(beyond)) return;
    const Point start = triangles_.corner(edge.triangle, (edge.corner + 1) % 3);
    const Point end = triangles_.corner(edge.triangle, (edge.corner + 2) % 3);
    if (!may_meet(start, end, disc)) return;
    std::uint32_t corner = 0;
    while (corner < 2 && triangles_.neighbor(beyond, corner) != edge.triangle) ++corner;
    waiting_.push_back({{beyond, corner}, sight});
  }

  //                apex            edge k + 1 from the right end to the apex, which is on the left
  //               .    .           of lines that cross it; edge k + 2 likewise, on their right
  //        k + 2 .      . k + 1
  //             .        .
  //         left -- k -- right
  void go_on(const Waiting& here, const Disc& disc) {
    const auto [triangle, k] = here.edge;
    const Point apex = triangles_.corner(triangle, k);
    const Sight& sight = here.sight;
    const int from_most_right = orientation(sight.most_right_from, sight.most_right_to, apex);
    const int from_most_left = orientation(sight.most_left_from, sight.most_left_to, apex);
    if (from_most_right > 0) {
      Sight next = sight;
      if (from_most_left < 0) {
        next.most_left_to = apex;
        next.most_left_from = find_tangent(apex, sight.rights, -1);
        next.lefts = add(apex, sight.lefts);
      }
      cross({triangle, (k + 1) % 3}, next, disc);
    }
    if (from_most_left < 0) {
      Sight next = sight;
      if (from_most_right > 0) {
        next.most_right_to = apex;
        next.most_right_from = find_tangent(apex, sight.lefts, 1);
        next.rights = add(apex, sight.rights);
      }
      cross({triangle, (k + 2) % 3}, next, disc);
    }
  }

  // The end from which a line to `to` has no other end on the other side: 1 left, -1 right.
  Point find_tangent(Point to, std::int32_t ends, int side) const {
    Point best = ends_[static_cast<std::size_t>(ends)].at;
    for (std::int32_t e = ends; e != kNone; e = ends_[static_cast<std::size_t>(e)].before) {
      const Point at = ends_[static_cast<std::size_t>(e)].at;
      if (orientation(best, to, at) * side < 0) best = at;
    }
    return best;
  }

  static bool may_meet(Point a, Point b, const Disc& disc) {
    const double x = b.x - a.x, y = b.y - a.y;
    const double square = x * x + y * y;
    double share =
        square > 0.0 ? ((disc.center.x - a.x) * x + (disc.center.y - a.y) * y) / square : 0.0;
    share = share >= 0.0 ? std::min(share, 1.0) : 0.0;  // 0 if it is not a number
    const double distance =
        std::hypot(a.x + share * x - disc.center.x, a.y + share * y - disc.center.y);
    const double size = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y),
                                  std::fabs(disc.center.x), std::fabs(disc.center.y)});
    return !(distance > disc.radius * (1.0 + kSlack) + kSlack * size);
  }

  PlaneTriangles triangles_;
  const bool* is_fixed_;  // three a triangle
  std::size_t most_;
  std::vector<End> ends_;
  std::vector<Waiting> waiting_;
  std::vector<std::int32_t> found_;
};

// Whether a place lies in any of some closed triangles, counter-clockwise, three corners each.
inline bool is_in_any(Point p, const Point* corners, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Point a = corners[3 * i], b = corners[3 * i + 1], c = corners[3 * i + 2];
    if (p.x < std::min({a.x, b.x, c.x}) || p.x > std::max({a.x, b.x, c.x})) continue;
    if (p.y < std::min({a.y, b.y, c.y}) || p.y > std::max({a.y, b.y, c.y})) continue;
    if (orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0)
      return true;
  }
  return false;
}

}  // namespace tinsmith
