// A cell of the overlay: what two triangles have in common, with the difference of their
// elevations at its corners.
//
// Which corners a cell has is decided by the exact signs of the 18 orientations of the corners of
// each triangle and the edges of the other, by nothing else. Each edge of a triangle gives the cell
// one side or none; the sides link up to the cell's boundary.
//
//      first's corner 2                corner numbers: 0 to 2   corners of the first triangle
//            . .                                       3 to 5   corners of the second
//     ------x---x------ second                         6 + 3i + j   where edge i of the first
//       .  /.....\  .                                               crosses edge j of the second
//        ./.......\.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "../../../tin/cpp/predicates/predicates.hpp"
#include "facet.hpp"
#include "vertical.hpp"

namespace tinsmith::earthwork {

class Cell {
 public:
  static constexpr int kMostCorners = 6;
  static constexpr int kCrossings = 6;  // the first number of a crossing

  // The edge of the first triangle and that of the second that cross there.
  static std::pair<std::uint32_t, std::uint32_t> crossing_of(int number) {
    const auto crossing = static_cast<std::uint32_t>(number - kCrossings);
    return {crossing / 3, crossing % 3};
  }

  // True if the interiors of the triangles meet; then all else can be asked for.
  bool cut(const Facet& first, const Facet& second) {
    facet_[0] = &first;
    facet_[1] = &second;
    if (!load_areas()) return false;
    next_.fill(-1);
    count_ = 0;
    for (int which = 0; which < 2; ++which) {
      for (std::uint32_t edge = 0; edge < 3; ++edge) add_side(which, edge);
    }
    link();
    return true;
  }

  int size() const { return count_; }
  int number(int i) const { return corner_[i]; }
  // Relative to the first corner of the first triangle.
  Point place(int i) const { return place_[i]; }
  // Of the second surface above the first.
  double difference(int i) const { return difference_[i]; }

 private:
  static int number_of_crossing(std::uint32_t edge, std::uint32_t other) {
    return kCrossings + static_cast<int>(3 * edge + other);
  }

  // area_[w][i][j] is twice the area of corner i of triangle w and edge j of the other one.
  // False where an edge of one has the other one on its right or touching.
  bool load_areas() {
    for (int which = 1; which >= 0; --which) {
      const Facet& corners = *facet_[which];
      const Facet& edges = *facet_[1 - which];
      Estimate estimates[3];
      for (std::uint32_t i = 0; i < 3; ++i) {
        estimates[i] = estimate(edges, corners.corner[i], area_[which][i]);
      }
      for (std::uint32_t j = 0; j < 3; ++j) {
        if (!estimates[0].may_be_left[j] && !estimates[1].may_be_left[j] &&
            !estimates[2].may_be_left[j]) {
          return false;
        }
      }
      for (std::uint32_t i = 0; i < 3; ++i) {
        if (estimates[i].are_precise) continue;
        for (std::uint32_t j = 0; j < 3; ++j) {
          area_[which][i][j] = twice_area(edges.start(j), edges.end(j), corners.corner[i]);
        }
      }
      for (std::uint32_t j = 0; j < 3; ++j) {
        bool has_left = false;
        for (std::uint32_t i = 0; i < 3; ++i) has_left |= area_[which][i][j] > 0.0;
        if (!has_left) return false;
      }
    }
    return true;
  }

  // What rounded areas of a point and the three edges tell: of thin triangles beside each other,
  // such as those of a fan, that they are apart.
  struct Estimate {
    bool are_precise = true;
    bool may_be_left[3];
  };

  static Estimate estimate(const Facet& edges, Point p, double (&area)[3]) {
    double x[3], y[3];
    bool is_at[3];  // a corner: the areas of its edges are 0
    for (std::uint32_t k = 0; k < 3; ++k) {
      x[k] = edges.corner[k].x - p.x;
      y[k] = edges.corner[k].y - p.y;
      is_at[k] = edges.corner[k] == p;
    }
    Estimate found;
    for (std::uint32_t j = 0; j < 3; ++j) {
      const double left = x[corner_after(j)] * y[corner_before(j)],
                   right = y[corner_after(j)] * x[corner_before(j)];
      const bool is_zero = is_at[corner_after(j)] || is_at[corner_before(j)];
      const double error =
          tinsmith::detail::kOrientationBound * (std::fabs(left) + std::fabs(right));
      area[j] = left - right;
      found.are_precise &= is_zero || is_precise(left, right);
      found.may_be_left[j] = !is_zero && !(area[j] < -error);
    }
    return found;
  }

  // The part of an edge within the other triangle.
  void add_side(int which, std::uint32_t edge) {
    const double across[3] = {area_[1 - which][0][edge], area_[1 - which][1][edge],
                              area_[1 - which][2][edge]};
    const int right = (across[0] < 0.0) + (across[1] < 0.0) + (across[2] < 0.0);
    if (right > 0) return add_chord(which, edge, across);
    const int on = (across[0] == 0.0) + (across[1] == 0.0) + (across[2] == 0.0);
    if (on == 2 && which == 0) add_shared(edge, across);
  }

  // The line of the edge runs through the interior of the other triangle.
  void add_chord(int which, std::uint32_t edge, const double (&across)[3]) {
    const std::uint32_t start = corner_after(edge), end = corner_before(edge);
    int from = number_of(which, start), to = number_of(which, end);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double at_start = area_[which][start][k], at_end = area_[which][end][k];
      const double before = across[corner_after(k)], after = across[corner_before(k)];
      const bool enters = before >= 0.0 && after < 0.0, leaves = before < 0.0 && after >= 0.0;
      if (!enters && !leaves) continue;
      if ((enters && at_start < 0.0 && at_end <= 0.0) ||
          (leaves && at_end < 0.0 && at_start <= 0.0)) {
        return;
      }
      if (enters && at_start < 0.0) from = meeting(which, edge, k, before, corner_after(k));
      if (leaves && at_end < 0.0) to = meeting(which, edge, k, after, corner_before(k));
    }
    next_[from] = to;
  }

  // Where an edge meets edge k of the other triangle: in a corner of that, or between.
  int meeting(int which, std::uint32_t edge, std::uint32_t k, double at_corner,
              std::uint32_t corner) const {
    if (at_corner == 0.0) return number_of(1 - which, corner);
    return which == 0 ? number_of_crossing(edge, k) : number_of_crossing(k, edge);
  }

  // Both triangles lie left of two edges on one line: what those share is a side.
  void add_shared(std::uint32_t edge, const double (&across)[3]) {
    const std::uint32_t other = across[0] != 0.0 ? 0 : across[1] != 0.0 ? 1 : 2;
    const Point start = facet_[0]->start(edge), end = facet_[0]->end(edge);
    const Point other_start = facet_[1]->start(other), other_end = facet_[1]->end(other);
    const bool is_rising = lexicographically_before(start, end);
    const auto precedes = [is_rising](Point a, Point b) {
      return is_rising ? lexicographically_before(a, b) : lexicographically_before(b, a);
    };
    const bool starts_later = precedes(start, other_start), ends_sooner = precedes(other_end, end);
    if (!precedes(starts_later ? other_start : start, ends_sooner ? other_end : end)) return;
    next_[starts_later ? 3 + corner_after(other) : corner_after(edge)] =
        static_cast<int>(ends_sooner ? 3 + corner_before(other) : corner_before(edge));
  }

  // A corner that both triangles have goes by its number in the first.
  int number_of(int which, std::uint32_t corner) const {
    if (which == 0) return static_cast<int>(corner);
    const double* area = area_[1][corner];
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (area[corner_after(k)] == 0.0 && area[corner_before(k)] == 0.0) return static_cast<int>(k);
    }
    return 3 + static_cast<int>(corner);
  }

  void link() {
    int first = 0;
    while (next_[first] < 0) {
      if (++first == kNumbers) throw std::logic_error("a cell of the overlay has no side");
    }
    for (int at = first; count_ < kMostCorners; at = next_[at]) {
      if (at < 0) throw std::logic_error("the sides of a cell of the overlay do not link up");
      if (at == first && count_ > 0) return;
      corner_[count_] = at;
      place_[count_] = place_of(at);
      difference_[count_] = difference_of(at);
      ++count_;
    }
  }

  Point place_of(int number) const {
    const Point origin = facet_[0]->corner[0];
    if (number < kCrossings) {
      const Point p = number < 3 ? facet_[0]->corner[number] : facet_[1]->corner[number - 3];
      return {p.x - origin.x, p.y - origin.y};
    }
    // From the nearer end.
    const auto [edge, other] = crossing_of(number);
    Point a = facet_[0]->start(edge), b = facet_[0]->end(edge);
    double at_a = std::fabs(area_[0][corner_after(edge)][other]);
    double at_b = std::fabs(area_[0][corner_before(edge)][other]);
    if (at_a > at_b) {
      std::swap(a, b);
      std::swap(at_a, at_b);
    }
    const double share = at_a / (at_a + at_b);
    return {(a.x - origin.x) + share * (b.x - a.x), (a.y - origin.y) + share * (b.y - a.y)};
  }

  double difference_of(int number) const {
    if (number < kCrossings) return difference_at_corner(number);
    const auto [edge, other] = crossing_of(number);
    return height_at_crossing(crossing_edge(0, edge, other), crossing_edge(1, other, edge));
  }

  double difference_at_corner(int number) const {
    const int which = number < 3 ? 0 : 1, corner = number < 3 ? number : number - 3;
    const Facet& own = *facet_[which];
    const double height = height_of_plane(*facet_[1 - which], own.corner[corner],
                                          own.elevation[corner], area_[which][corner]);
    return which == 0 ? height : -height;
  }

  CrossingEdge crossing_edge(int which, std::uint32_t edge, std::uint32_t other) const {
    const Facet& facet = *facet_[which];
    const std::uint32_t start = corner_after(edge), end = corner_before(edge);
    return {facet.corner[start],  facet.corner[end],          facet.elevation[start],
            facet.elevation[end], area_[which][start][other], area_[which][end][other]};
  }

  static constexpr int kNumbers = kCrossings + 9;

  const Facet* facet_[2];
  double area_[2][3][3];
  std::array<int, kNumbers> next_;
  int corner_[kMostCorners];
  Point place_[kMostCorners];
  double difference_[kMostCorners];
  int count_ = 0;
};

}  // namespace tinsmith::earthwork
