// Volumes, areas and moments of a linear function over triangles, in closed form.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "exact_sum.hpp"

namespace tinsmith::earthwork {

// The part of a triangle where a linear function is positive, by its values at the corners: the
// share of the area, and the integral over it by that area.
struct Part {
  double area;
  double volume;
};

// One corner above 0, the others not above: a triangle is cut off.
inline Part part_at_one(double above, double below, double other_below) {
  const double area = above / (above - below) * (above / (above - other_below));
  return {area, area * (above / 3.0)};
}

// Two corners above 0, the third below: a quadrilateral, in two triangles. Nothing is subtracted
// but what has opposite signs, so nothing cancels.
inline Part part_at_two(double above, double other_above, double below) {
  const double first = above / (above - below);  // shares of the sides that lie above
  const double second = other_above / (other_above - below);
  const double rest = below / (below - above);
  return {first + second * rest,
          first * ((above + other_above) / 3.0) + second * rest * (other_above / 3.0)};
}

inline Part positive_part(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  if (a <= 0.0) return {0.0, 0.0};
  if (c >= 0.0) return {1.0, (a + b + c) / 3.0};
  return b > 0.0 ? part_at_two(a, b, c) : part_at_one(a, b, c);
}

// Over many triangles; whatever their order, the same to the last bit.
class Sums {
 public:
  static constexpr int kColumns = 10;

  // `doubled_area` of a triangle in the plane, `difference` at its corners.
  void add(double doubled_area, double a, double b, double c) {
    const double area = 0.5 * doubled_area;
    const Part fill = positive_part(a, b, c), cut = positive_part(-a, -b, -c);
    area_.add(area);
    fill_area_.add(area * fill.area);
    cut_area_.add(area * cut.area);
    fill_.add(area * fill.volume);
    cut_.add(area * cut.volume);
    squares_.add(area * ((a * a + b * b + c * c + (a * b + b * c + c * a)) / 6.0));
    highest_ = std::max({highest_, a, b, c});
    lowest_ = std::min({lowest_, a, b, c});
  }

  // Areas in space over the same part of the plane.
  void add_surfaces(double area, double other_area) {
    surface_.add(area);
    other_surface_.add(other_area);
  }

  void add(const Sums& other) {
    area_.add(other.area_);
    fill_area_.add(other.fill_area_);
    cut_area_.add(other.cut_area_);
    fill_.add(other.fill_);
    cut_.add(other.cut_);
    squares_.add(other.squares_);
    surface_.add(other.surface_);
    other_surface_.add(other.other_surface_);
    highest_ = std::max(highest_, other.highest_);
    lowest_ = std::min(lowest_, other.lowest_);
  }

  // In the order in which terrain/_kernel.py names them.
  std::array<double, kColumns> values() const {
    return {area_.value(),    cut_area_.value(), fill_area_.value(), cut_.value(),
            fill_.value(),    squares_.value(),  surface_.value(),   other_surface_.value(),
            lowest_,          highest_};
  }

 private:
  ExactSum area_, cut_area_, fill_area_, cut_, fill_, squares_, surface_, other_surface_;
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace tinsmith::earthwork
