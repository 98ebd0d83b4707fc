// When an edge blocks a ray: on a plane exactly, over a curved earth in doubles or not for certain.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "edge_tree.hpp"
#include "eye.hpp"

namespace tinsmith::sight {

enum class Sight : std::uint8_t { kHidden = 0, kSeen = 1, kUnknown = 2 };

// How far along both axes an edge stays from the eye at least, and at most.
struct Nearness {
  double least, most;
  bool is_in_quadrant;

  Nearness(const Offset& a, const Offset& b)
      : most(std::max(a.norm(), b.norm())),
        is_in_quadrant(is_one_sided(a.x, b.x) && is_one_sided(a.y, b.y)) {
    const double x = is_one_sided(a.x, b.x) ? std::min(std::fabs(a.x), std::fabs(b.x)) : 0.0;
    const double y = is_one_sided(a.y, b.y) ? std::min(std::fabs(a.y), std::fabs(b.y)) : 0.0;
    least = std::max(x, y);
  }

 private:
  static bool is_one_sided(double a, double b) {
    return (a >= 0.0 && b >= 0.0) || (a <= 0.0 && b <= 0.0);
  }
};

constexpr double kSlack = 0x1p-46;  // of a steepness in doubles: far more than it loses

// The steepest ray to an edge whose ends have such heights above the eye, or steeper.
inline double bound_steepness(const Offset& a, const Offset& b, double a_height, double b_height) {
  const Nearness near(a, b);
  double steepest;
  if (near.is_in_quadrant) {
    steepest = std::max(a_height / a.norm(), b_height / b.norm());
  } else {
    const double top = std::max(a_height, b_height);
    steepest = top <= 0.0 ? top / near.most : top / near.least;
  }
  return steepest + kSlack * std::fabs(steepest);
}

inline double least_steepness(double height, double norm) {
  const double steepness = height / norm;
  return steepness - kSlack * std::fabs(steepness);
}

// On a plane. Everything is decided exactly.
class PlaneRule {
 public:
  static constexpr bool kIsExact = true;

  explicit PlaneRule(const SurfacePoint& eye) : eye_(eye) {}

  double bound(const SightEdge& edge) const {
    const Offset a(eye_, edge.from), b(eye_, edge.to);
    return bound_steepness(a, b, a.z, b.z);
  }
  // What only edges above that bound may block.
  double steepness(const SurfacePoint& target) const {
    const Offset to(eye_, target);
    return least_steepness(to.z, to.norm());
  }
  Sight judge(const SightEdge& edge, const SurfacePoint& target) const {
    return sign_of_height(eye_, edge.from, edge.to, target) > 0 ? Sight::kHidden : Sight::kSeen;
  }
  // Of a nearer vertex in the same direction.
  Sight judge(const SurfacePoint& vertex, double, const SurfacePoint& target) const {
    return compare_steepness(eye_, vertex, target) > 0 ? Sight::kHidden : Sight::kSeen;
  }

 private:
  SurfacePoint eye_;
};

// Over an earth that falls away as the square of the distance. Between edges the ground bulges by
// at most the fall over the way across a triangle: what is within that is not known, nor what is
// within rounding.
class CurvedRule {
 public:
  static constexpr bool kIsExact = false;

  CurvedRule(const SurfacePoint& eye, double fall) : eye_(eye), fall_(fall) {}

  double bound(const SightEdge& edge) const {
    const Offset a(eye_, edge.from), b(eye_, edge.to);
    const double rise = 2.0 * fall_ * edge.reach * edge.reach + rounding(a) + rounding(b);
    return bound_steepness(a, b, height(a) + rise, height(b) + rise);
  }
  double steepness(const SurfacePoint& target) const {
    const Offset to(eye_, target);
    return least_steepness(height(to) - rounding(to), to.norm());
  }
  Sight judge(const SightEdge& edge, const SurfacePoint& target) const {
    const Offset a(eye_, edge.from), b(eye_, edge.to), to(eye_, target);
    const double left = a.x * b.y, right = a.y * b.x;
    const double to_a = to.x * a.y - to.y * a.x, to_b = to.x * b.y - to.y * b.x;
    const double along = to_a / (to_a - to_b), share = (left - right) / (to_b - to_a);
    const double doubt = kDoubt * ((std::fabs(left) + std::fabs(right)) / std::fabs(to_b - to_a) +
                                   (std::fabs(to.x * a.y) + std::fabs(to.y * a.x) +
                                    std::fabs(to.x * b.y) + std::fabs(to.y * b.x)) /
                                       std::fabs(to_a - to_b));
    const double above =
        a.z + along * (b.z - a.z) - share * to.z + fall_ * to.square() * share * (1.0 - share);
    const double error = doubt * (std::fabs(b.z - a.z) + std::fabs(to.z) + fall_ * to.square()) +
                         rounding(a) + rounding(b) + rounding(to);
    return decide(above, error, edge.reach);
  }
  Sight judge(const SurfacePoint& vertex, double reach, const SurfacePoint& target) const {
    const Offset a(eye_, vertex), to(eye_, target);
    const double share = a.norm() / to.norm();
    const double above = a.z - share * to.z + fall_ * to.square() * share * (1.0 - share);
    return decide(above, rounding(a) + rounding(to), reach);
  }

 private:
  static constexpr double kDoubt = 0x1p-48;

  double height(const Offset& to) const { return to.z - fall_ * to.square(); }
  double rounding(const Offset& to) const {
    return kDoubt * (std::fabs(eye_.z) + std::fabs(to.z) + fall_ * to.square());
  }
  Sight decide(double above, double error, double reach) const {
    if (above > error) return Sight::kHidden;
    const bool is_below = above < -error - fall_ * reach * reach;
    return is_below ? Sight::kSeen : Sight::kUnknown;  // not a number: unknown
  }

  SurfacePoint eye_;
  double fall_;
};

}  // namespace tinsmith::sight
