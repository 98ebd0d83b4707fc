// How far points are above or below the plane through a triangle's corners.
#pragma once

#include <cmath>

#include "../base/point.hpp"
#include "../location/surface.hpp"

namespace tinsmith {

// Factors of what points are above a plane, and of what they are below it: a large one keeps the
// surface on one side of the points.
struct SideWeights {
  double above = 1.0, below = 1.0;
};

// The result depends on the three corners, not on which of them is named first.
class ElevationPlane {
 public:
  // Corners counter-clockwise.
  ElevationPlane(const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& c)
      : corner_{a, b, c} {
    while (!is_first_lowest()) turn();
    const double ux = corner_[1].at.x - corner_[0].at.x, uy = corner_[1].at.y - corner_[0].at.y;
    const double vx = corner_[2].at.x - corner_[0].at.x, vy = corner_[2].at.y - corner_[0].at.y;
    const double uz = corner_[1].z - corner_[0].z, vz = corner_[2].z - corner_[0].z;
    const double area = ux * vy - uy * vx;
    is_thin_ = !(area > kThin * (std::fabs(ux * vy) + std::fabs(uy * vx)));
    if (is_thin_) return;
    east_ = (uz * vy - vz * uy) / area;
    north_ = (ux * vz - vx * uz) / area;
  }

  double error(Point p, double z, const SideWeights& weights = {}) const {
    const double height = height_of(p, z);
    return height > 0.0 ? weights.above * height : weights.below * -height;
  }

 private:
  // Below it the rounding of the area would show in the slopes.
  static constexpr double kThin = 1e-6;

  bool is_first_lowest() const {
    return !lexicographically_before(corner_[1].at, corner_[0].at) &&
           !lexicographically_before(corner_[2].at, corner_[0].at);
  }
  void turn() {
    const SurfacePoint first = corner_[0];
    corner_[0] = corner_[1];
    corner_[1] = corner_[2];
    corner_[2] = first;
  }

  double height_of(Point p, double z) const {
    if (is_thin_) return z - weighed(p);
    const double rise = east_ * (p.x - corner_[0].at.x) + north_ * (p.y - corner_[0].at.y);
    return z - corner_[0].z - rise;
  }

  double weighed(Point p) const {
    const double z[3] = {corner_[0].z, corner_[1].z, corner_[2].z};
    return CornerWeights::at(p, corner_[0].at, corner_[1].at, corner_[2].at).mean_of(z);
  }

  SurfacePoint corner_[3];
  bool is_thin_;
  double east_ = 0.0, north_ = 0.0;
};

}  // namespace tinsmith
