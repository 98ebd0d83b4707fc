// Volumes, areas and moments of a linear function over triangles, in closed form.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

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

// Over the few triangles of a cell, in doubles.
struct CellSums {
  double area = 0.0, fill_area = 0.0, cut_area = 0.0, fill = 0.0, cut = 0.0, squares = 0.0;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  // `doubled_area` of a triangle in the plane, the differences at its corners.
  void add(double doubled_area, double a, double b, double c) {
    const double own = 0.5 * doubled_area;
    const Part above = positive_part(a, b, c), below = positive_part(-a, -b, -c);
    area += own;
    fill_area += own * above.area;
    cut_area += own * below.area;
    fill += own * above.volume;
    cut += own * below.volume;
    squares += own * ((a * a + b * b + c * c + (a * b + b * c + c * a)) / 6.0);
    highest = std::max({highest, a, b, c});
    lowest = std::min({lowest, a, b, c});
  }
};

// Over many cells; whatever their order, the same to the last bit.
class Sums {
 public:
  static constexpr int kColumns = 10;

  // A cell, with areas in space over the same part of the plane.
  void add(const CellSums& cell, double surface, double other_surface) {
    const double values[kSummed] = {cell.area, cell.cut_area, cell.fill_area, cell.cut,
                                    cell.fill, cell.squares,  surface,        other_surface};
    for (std::size_t i = 0; i < kSummed; ++i) sums_[i].add(values[i]);
    highest_ = std::max(highest_, cell.highest);
    lowest_ = std::min(lowest_, cell.lowest);
  }

  void add(const Sums& other) {
    for (std::size_t i = 0; i < kSummed; ++i) sums_[i].add(other.sums_[i]);
    highest_ = std::max(highest_, other.highest_);
    lowest_ = std::min(lowest_, other.lowest_);
  }

  static constexpr std::size_t kSummed = 8;

  // Of each column but the last two, the terms of its sum.
  using Terms = std::array<std::array<double, ExactSum::kTerms>, kSummed>;
  Terms terms() const {
    Terms terms;
    for (std::size_t i = 0; i < kSummed; ++i) terms[i] = sums_[i].terms();
    return terms;
  }
  std::array<double, 2> extremes() const { return {lowest_, highest_}; }

  // In the order in which terrain/_kernel.py names them.
  std::array<double, kColumns> values() const {
    std::array<double, kColumns> values;
    for (std::size_t i = 0; i < kSummed; ++i) values[i] = sums_[i].value();
    values[kSummed] = lowest_;
    values[kSummed + 1] = highest_;
    return values;
  }

 private:
  std::array<ExactSum, kSummed> sums_;
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = -std::numeric_limits<double>::infinity();
};

inline std::vector<std::array<double, Sums::kColumns>> rows_of(const std::vector<Sums>& sums) {
  std::vector<std::array<double, Sums::kColumns>> rows;
  rows.reserve(sums.size());
  for (const Sums& one : sums) rows.push_back(one.values());
  return rows;
}

}  // namespace tinsmith::earthwork
