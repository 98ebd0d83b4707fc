// Circles on an edge, by the cotangent of the angle under which their points see it.
//
//                  c            For an edge from a to b and a point c left of it, let
//                 / \             e = b - a,  p = c - a,  q = c - b.
//               /     \         The cotangent of the angle at c is (p . q) / (e x p). The smallest
//             a ------- b       cotangent is the largest angle, and the circle through a, b, c
//                               is empty on the left of the edge if and only if c is the winner.
//
// The centre of the circle with cotangent t lies t |e| / 2 left of the edge's middle, so circles
// on one edge are ordered by t and their left caps are nested.
#pragma once

#include <algorithm>
#include <cmath>

#include "../base/box.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// Relative slack on boxes and radii; far above what a dozen roundings add up to.
constexpr double kSlack = 1e-14;

// Farther than the roundings of points in the box, and of the cells that hold them, add up to.
inline double coordinate_slack(const Box& box) {
  return kSlack * 4.0 *
         std::max({std::fabs(box.west), std::fabs(box.east), std::fabs(box.south),
                   std::fabs(box.north)});
}

// The box of the part of a circle through a and b = a + edge that is left of the edge, all
// relative to a.
inline Box box_of_cap(Point edge, Point center, double radius) {
  Box box = Box::of({0.0, 0.0}, edge);
  // The circle's extreme points count where they are left of the edge.
  const double side = edge.x * center.y - edge.y * center.x;
  if (!(side + edge.y * radius <= 0.0)) box.west = std::min(box.west, center.x - radius);
  if (!(side - edge.y * radius <= 0.0)) box.east = std::max(box.east, center.x + radius);
  if (!(side - edge.x * radius <= 0.0)) box.south = std::min(box.south, center.y - radius);
  if (!(side + edge.x * radius <= 0.0)) box.north = std::max(box.north, center.y + radius);
  return box;
}

// Bounds on the rounding of cotangents on an edge, for points whose coordinates differ from a's
// by at most `reach`: of the cross product e x p and of the dot product p . q (q taken as p - e).
class CotangentErrors {
 public:
  CotangentErrors() = default;
  // `edge_sum` is |e.x| + |e.y|.
  CotangentErrors(double edge_sum, double reach)
      : cross_(8.0 * kUnitRoundoff * edge_sum * reach),
        dot_(24.0 * kUnitRoundoff * reach * reach),
        most_cross_(2.0 * edge_sum * reach),
        most_dot_(4.0 * reach * reach) {}

  double cross() const { return cross_; }

  // Bound on the error of dot * best_cross - cross * best_dot.
  double tolerance(double best_dot, double best_cross) const {
    return 2.0 * (dot_ * (best_cross + most_cross_) + cross_ * (std::fabs(best_dot) + most_dot_));
  }

  // The cotangent, or a little more for what rounding may have done: a circle of at least its
  // size. Needs cross > 2 cross().
  double widened(double dot, double cross) const {
    const double per_cross = 1.0 / cross;
    const double rounded = dot * per_cross;
    const double error = 2.0 * (dot_ + std::fabs(rounded) * cross_) * per_cross;
    return rounded + error + 4.0 * kUnitRoundoff * std::fabs(rounded);
  }

 private:
  double cross_ = 0.0, dot_ = 0.0, most_cross_ = 0.0, most_dot_ = 0.0;
};

}  // namespace tinsmith
