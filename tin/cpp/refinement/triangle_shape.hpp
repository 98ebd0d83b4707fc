// Measures of triangles that refinement goes by. None of them needs to be exact: they only choose
// where to put points.
#pragma once

#include <algorithm>
#include <cmath>

#include "../predicates/predicates.hpp"

namespace tinsmith {

struct RefinementGoal {
  double least_angle;   // radians; 0 for none
  double largest_area;  // infinity for none
  double longest_edge;  // infinity for none
};

inline double squared_distance(Point p, Point q) {
  const double dx = q.x - p.x, dy = q.y - p.y;
  return dx * dx + dy * dy;
}

// Of the vectors from c to a and to b.
inline double dot_product(Point c, Point a, Point b) {
  return (a.x - c.x) * (b.x - c.x) + (a.y - c.y) * (b.y - c.y);
}

// Of c above the line through a and b.
inline double squared_height(Point c, Point a, Point b) {
  const double cross = (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
  return cross * cross / squared_distance(a, b);
}

inline Point midpoint(Point a, Point b) {
  return {a.x + 0.5 * (b.x - a.x), a.y + 0.5 * (b.y - a.y)};
}

// A counter-clockwise triangle turned so that its shortest edge runs from `p` to `q`; of equally
// short ones that with the first apex in lexicographic order, whatever the order of the corners.
struct TurnedTriangle {
  Point p, q, apex;
  int corner_of_apex;  // among the corners as given

  static TurnedTriangle of(const Point (&corner)[3]) {
    int best = 0;
    for (int k = 1; k < 3; ++k) {
      const double size = opposite(corner, k), least = opposite(corner, best);
      if (size < least || (size == least && lexicographically_before(corner[k], corner[best]))) {
        best = k;
      }
    }
    return {corner[(best + 1) % 3], corner[(best + 2) % 3], corner[best], best};
  }

 private:
  static double opposite(const Point (&corner)[3], int k) {
    return squared_distance(corner[(k + 1) % 3], corner[(k + 2) % 3]);
  }
};

class ShapeTest {
 public:
  explicit ShapeTest(const RefinementGoal& goal)
      : goal_(goal),
        squared_cosine_(std::cos(goal.least_angle) * std::cos(goal.least_angle)),
        cosine_of_twice_(std::cos(2.0 * goal.least_angle)),
        off_center_(goal.least_angle > 0.0 ? kOffCenter / std::tan(0.5 * goal.least_angle)
                                           : INFINITY) {}

  bool has_small_angle(const TurnedTriangle& t) const {
    const double dot = dot_product(t.apex, t.p, t.q);
    return dot > 0.0 && dot * dot > squared_cosine_ * squared_distance(t.apex, t.p) *
                                        squared_distance(t.apex, t.q);
  }

  bool is_large(const TurnedTriangle& t) const {
    const double longest = std::max(squared_distance(t.apex, t.p), squared_distance(t.apex, t.q));
    return longest > goal_.longest_edge * goal_.longest_edge ||
           0.5 * std::abs(cross(t)) > goal_.largest_area;
  }

  bool is_long(Point a, Point b) const {
    return squared_distance(a, b) > goal_.longest_edge * goal_.longest_edge;
  }

  // Of triangles in a mesh that has just become small enough; infinite if any size will do.
  double usual_area() const {
    return std::min(kUsualArea * goal_.largest_area,
                    kUsualOfSquare * goal_.longest_edge * goal_.longest_edge);
  }

  // Whether a point sees a segment under so large an angle that the triangle there cannot be mended
  // but by splitting the segment: 180 degrees less twice the least angle [Chew 1993].
  bool encroaches(Point c, Point a, Point b) const {
    const double dot = dot_product(c, a, b);
    return dot < 0.0 && dot * dot >= cosine_of_twice_ * cosine_of_twice_ * squared_distance(c, a) *
                                         squared_distance(c, b);
  }

  // Where a point mends the triangle: the centre of its circle, or nearer to the shortest edge the
  // place that sees it under just the least angle [Uengoer 2004]. Not finite for a triangle so thin
  // that its area is rounded away, if there is no least angle.
  Point remedy(const TurnedTriangle& t) const {
    const double px = t.p.x - t.apex.x, py = t.p.y - t.apex.y;
    const double qx = t.q.x - t.apex.x, qy = t.q.y - t.apex.y;
    const double pp = px * px + py * py, qq = qx * qx + qy * qy;
    const double half = 0.5 / cross(t);
    const double dx = half * (qy * pp - py * qq), dy = half * (px * qq - qx * pp);
    if (!std::isfinite(off_center_)) return {t.apex.x + dx, t.apex.y + dy};
    const double ox = 0.5 * (px + qx) - off_center_ * (qy - py);
    const double oy = 0.5 * (py + qy) + off_center_ * (qx - px);
    const bool is_center = square(dx - px, dy - py) <= square(ox - px, oy - py);  // not if NaN
    return is_center ? Point{t.apex.x + dx, t.apex.y + dy} : Point{t.apex.x + ox, t.apex.y + oy};
  }

 private:
  // Half of the cotangent of half the angle puts the third corner under just that angle; a little
  // less keeps rounding from making the new triangle a bad one again.
  static constexpr double kOffCenter = 0.475;

  // Measured on refined squares.
  static constexpr double kUsualArea = 0.55, kUsualOfSquare = 0.2;

  static double square(double x, double y) { return x * x + y * y; }

  // Twice the area.
  static double cross(const TurnedTriangle& t) {
    return (t.p.x - t.apex.x) * (t.q.y - t.apex.y) - (t.p.y - t.apex.y) * (t.q.x - t.apex.x);
  }

  RefinementGoal goal_;
  double squared_cosine_, cosine_of_twice_, off_center_;
};

}  // namespace tinsmith
