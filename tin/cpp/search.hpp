// Search for the third point: of all points left of an edge, the one that sees it under the
// largest angle.
//
//                  c            For an edge from a to b and a point c left of it, let
//                 / \             e = b - a,  p = c - a,  q = c - b.
//               /     \         The cotangent of the angle at c is (p . q) / (e x p). The smallest
//             a ------- b       cotangent is the largest angle, and the circle through a, b, c
//                               is empty on the left of the edge if and only if c is the winner.
//
// The centre of the circle with cotangent t lies t |e| / 2 left of the edge's middle, so circles
// on one edge are ordered by t and their left caps are nested: once a candidate is known, only
// its cap needs to be searched, and the cap shrinks as candidates improve (the paper's moving
// circle).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "grid.hpp"
#include "ids.hpp"
#include "predicates.hpp"

namespace tinsmith {

// How much work the searches did; exact decisions are those beyond the error bound.
struct SearchCounts {
  std::int64_t searches = 0;
  std::int64_t candidates = 0;
  std::int64_t cell_rows = 0;
  std::int64_t exact_decisions = 0;

  std::int64_t work() const { return candidates + cell_rows; }
};

class ThirdPointSearch {
 public:
  explicit ThirdPointSearch(const PointGrid& grid)
      : grid_(grid), x_(grid.x()), y_(grid.y()), cell_(grid.cell_size()) {
    const double far_west = std::fabs(grid.west()) + cell_ * grid.columns();
    const double far_south = std::fabs(grid.south()) + cell_ * grid.cell_rows();
    coordinate_slack_ = kSlack * (far_west + far_south);
  }

  // The winner among the points after `a` in the sweep. `a` is the vertex being finished, so all
  // points before it have all their triangles. Requires a winner: the edge is not on the hull
  // with its outside to the left. `hint` is a point that may win, or kNoVertex.
  Vertex third_point(Vertex a, Vertex b, Vertex hint) {
    ++counts_.searches;
    set_edge(a, b);
    Circle circle = first_disc();
    if (hint != kNoVertex && is_promising(hint, circle)) offer(number(hint));
    const std::int32_t offered = best_;
    if (has_best()) circle = best_circle();
    Cells searched = cap_cells(circle);
    scan(searched);
    while (!has_best()) {
      if (all_cells().within(searched)) {
        throw std::logic_error("an edge inside the hull found no third point");
      }
      circle = circle_of_radius(2.0 * circle.radius);
      searched = cap_cells(circle);
      scan(searched);
    }
    if (best_ != offered) {
      const Cells needed = cap_cells(best_circle());
      if (!needed.within(searched)) scan(needed);
    }
    return static_cast<Vertex>(best_);
  }

  // The point nearest to a vertex that has no triangle yet: the two are always an edge. All its
  // neighbours come after it in the sweep, so only those are looked at; of equally near ones the
  // first in the sweep is taken.
  Vertex nearest(Vertex v) {
    a_ = number(v);
    ax_ = x_[a_];
    ay_ = y_[a_];
    double radius = cell_;
    while (true) {
      const std::int32_t found = nearest_in(disc_cells(radius));
      const double distance = found < 0 ? HUGE_VAL : distance_to(found);
      if (distance <= radius) return static_cast<Vertex>(found);
      radius = found < 0 ? 2.0 * radius : distance;
    }
  }

  const SearchCounts& counts() const { return counts_; }

 private:
  // Relative slack on boxes and radii; far above what a dozen roundings add up to.
  static constexpr double kSlack = 1e-14;
  // First disc: radius over half the edge, and over the cell.
  static constexpr double kDiscPerHalfEdge = 1.15;
  static constexpr double kDiscPerCell = 0.8;
  static constexpr double kDiscCotangent = 0.56789083458002739;  // sqrt(1.15^2 - 1)
  static constexpr double kUnbounded = 1e300;

  // A circle on the edge, by the cotangent under which its left side sees the edge.
  struct Circle {
    double cotangent;
    double radius;
  };

  struct Cells {
    std::int32_t first_column, last_column, first_row, last_row;

    bool within(const Cells& outer) const {
      return first_column >= outer.first_column && last_column <= outer.last_column &&
             first_row >= outer.first_row && last_row <= outer.last_row;
    }
  };

  bool has_best() const { return best_ >= 0; }

  void set_edge(Vertex a, Vertex b) {
    a_ = number(a);
    b_ = number(b);
    ax_ = x_[a_];
    ay_ = y_[a_];
    ex_ = x_[b_] - ax_;
    ey_ = y_[b_] - ay_;
    edge_square_ = ex_ * ex_ + ey_ * ey_;
    edge_sum_ = std::fabs(ex_) + std::fabs(ey_);
    best_ = -1;
    is_best_flat_ = true;
    best_dot_ = kUnbounded;
    best_cross_ = 0.0;
    set_reach(2.0 * edge_sum_ + cell_);
  }

  Circle first_disc() const {
    const double least = kDiscPerCell * cell_;
    const double radius_square = kDiscPerHalfEdge * kDiscPerHalfEdge * 0.25 * edge_square_;
    if (radius_square > least * least) return {kDiscCotangent, std::sqrt(radius_square)};
    return circle_of_radius(least);
  }

  // Not smaller than the circle on the edge as its diameter.
  Circle circle_of_radius(double radius) const {
    const double square = 4.0 * radius * radius / edge_square_ - 1.0;
    return {square > 0.0 ? std::sqrt(square) : 0.0, radius};
  }

  // The circle through the best candidate, or one a little larger for what rounding may have done.
  Circle best_circle() const {
    if (is_best_flat_ || !(best_cross_ > 2.0 * cross_error_)) return {kUnbounded, kUnbounded};
    const double per_cross = 1.0 / best_cross_;
    const double rounded = best_dot_ * per_cross;
    const double error = 2.0 * (dot_error_ + std::fabs(rounded) * cross_error_) * per_cross;
    const double cotangent = rounded + error + 4.0 * kUnitRoundoff * std::fabs(rounded);
    return {cotangent, 0.5 * std::sqrt(edge_square_ * (1.0 + cotangent * cotangent))};
  }

  // Error bounds for candidates whose coordinates differ from a's by at most `reach`: of the
  // cross product e x p, and of the dot product p . q (q is taken as p - e).
  void set_reach(double reach) {
    reach_ = reach;
    cross_error_ = 8.0 * kUnitRoundoff * edge_sum_ * reach;
    dot_error_ = 24.0 * kUnitRoundoff * reach * reach;
    update_tolerance();
  }

  // Bound on the error of dot * best_cross - cross * best_dot for candidates within reach.
  void update_tolerance() {
    const double most_cross = best_cross_ + 2.0 * edge_sum_ * reach_;
    const double most_dot = std::fabs(best_dot_) + 4.0 * reach_ * reach_;
    tolerance_ = 2.0 * (dot_error_ * most_cross + cross_error_ * most_dot);
  }

  bool is_promising(Vertex hint, const Circle& disc) const {
    const double px = x_[number(hint)] - ax_, py = y_[number(hint)] - ay_;
    if (std::max(std::fabs(px), std::fabs(py)) > reach_) return false;
    const double cross = ex_ * py - ey_ * px;
    return cross > cross_error_ && px * (px - ex_) + py * (py - ey_) < disc.cotangent * cross;
  }

  // ------------------------------------------------------------- candidates

  void scan(const Cells& cells) {
    extend_reach(cells);
    for_each_run(cells, [this](std::int32_t begin, std::int32_t end) {
      counts_.candidates += end - begin;
      for (std::int32_t i = begin; i < end; ++i) {
        const double px = x_[i] - ax_, py = y_[i] - ay_;
        const double cross = ex_ * py - ey_ * px;
        const double dot = px * (px - ex_) + py * (py - ey_);
        const bool is_left = cross > -cross_error_;
        if (is_left & beats_best(dot, cross, 1.0)) offer(i, dot, cross);
      }
    });
  }

  void offer(std::int32_t i) {
    const double px = x_[i] - ax_, py = y_[i] - ay_;
    offer(i, px * (px - ex_) + py * (py - ey_), ex_ * py - ey_ * px);
  }

  // A candidate that may be left of the edge and may beat the best so far.
  void offer(std::int32_t i, double dot, double cross) {
    const bool is_surely_left = cross > cross_error_;
    const bool is_surely_better = is_best_flat_ ? !has_best() : beats_best(dot, cross, -1.0);
    if (!(is_surely_left && is_surely_better) && !wins_exactly(i, is_surely_left)) return;
    best_ = i;
    is_best_flat_ = !is_surely_left;
    best_dot_ = is_best_flat_ ? kUnbounded : dot;
    best_cross_ = is_best_flat_ ? 0.0 : cross;
    update_tolerance();
  }

  // Whether the candidate's cotangent is below the best's, by a margin of tolerances.
  bool beats_best(double dot, double cross, double margin) const {
    return dot * best_cross_ - cross * best_dot_ < margin * tolerance_;
  }

  bool wins_exactly(std::int32_t i, bool is_surely_left) {
    if (i == best_ || i == b_ || i == a_) return false;
    ++counts_.exact_decisions;
    if (!is_surely_left && orientation(here(a_), here(b_), here(i)) <= 0) return false;
    return !has_best() || is_in_circle(here(a_), here(b_), here(best_), here(i));
  }

  Point here(std::int32_t i) const { return {x_[i], y_[i]}; }

  // ------------------------------------------------------------- boxes

  // Cells that meet the circle's cap left of the edge.
  Cells cap_cells(const Circle& circle) const {
    const double radius = circle.radius;
    if (!(radius < kUnbounded)) return all_cells();
    const double cx = 0.5 * (ex_ - ey_ * circle.cotangent);
    const double cy = 0.5 * (ey_ + ex_ * circle.cotangent);
    double west = std::min(0.0, ex_), east = std::max(0.0, ex_);
    double south = std::min(0.0, ey_), north = std::max(0.0, ey_);
    // The circle's extreme points count where they are left of the edge.
    const double side = ex_ * cy - ey_ * cx;
    if (!(side + ey_ * radius <= 0.0)) west = std::min(west, cx - radius);
    if (!(side - ey_ * radius <= 0.0)) east = std::max(east, cx + radius);
    if (!(side - ex_ * radius <= 0.0)) south = std::min(south, cy - radius);
    if (!(side + ex_ * radius <= 0.0)) north = std::max(north, cy + radius);
    const double slack = coordinate_slack_ + kSlack * radius;
    return cells_of(west - slack, east + slack, south - slack, north + slack);
  }

  Cells disc_cells(double radius) const {
    const double slack = coordinate_slack_ + kSlack * radius;
    return cells_of(-radius - slack, radius + slack, -radius - slack, radius + slack);
  }

  Cells all_cells() const {
    return {0, grid_.columns() - 1, grid_.cell_row_at(ay_), grid_.cell_rows() - 1};
  }

  Cells cells_of(double west, double east, double south, double north) const {
    return {grid_.column_at(ax_ + west), grid_.column_at(ax_ + east),
            std::max(grid_.cell_row_at(ay_ + south), grid_.cell_row_at(ay_)),
            grid_.cell_row_at(ay_ + north)};
  }

  void extend_reach(const Cells& cells) {
    const double west = grid_.west() + cell_ * cells.first_column - ax_;
    const double east = grid_.west() + cell_ * (cells.last_column + 1) - ax_;
    const double north = grid_.south() + cell_ * (cells.last_row + 1) - ay_;
    const double reach = std::max({std::fabs(west), std::fabs(east), north}) + cell_;
    if (reach > reach_) set_reach(reach);
  }

  // Contiguous runs of stored points in the cells, those after a only.
  template <typename Visit>
  void for_each_run(const Cells& cells, Visit&& visit) {
    counts_.cell_rows += cells.last_row - cells.first_row + 1;
    for (std::int32_t row = cells.first_row; row <= cells.last_row; ++row) {
      const std::int32_t begin = std::max(grid_.begin_of(row, cells.first_column), a_ + 1);
      const std::int32_t end = grid_.begin_of(row, cells.last_column + 1);
      if (begin < end) visit(begin, end);
    }
  }

  // ------------------------------------------------------------- nearest

  std::int32_t nearest_in(const Cells& cells) {
    std::int32_t found = -1;
    for_each_run(cells, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = begin; i < end; ++i) {
        const bool is_nearer =
            found < 0 || compare_distances(here(a_), here(i), here(found)) < 0;
        if (is_nearer) found = i;
      }
    });
    return found;
  }

  double distance_to(std::int32_t i) const { return std::hypot(x_[i] - ax_, y_[i] - ay_); }

  const PointGrid& grid_;
  const double* x_;
  const double* y_;
  const double cell_;
  double coordinate_slack_ = 0.0;

  // The edge at hand, relative to a.
  std::int32_t a_ = 0, b_ = 0;
  double ax_ = 0.0, ay_ = 0.0, ex_ = 0.0, ey_ = 0.0;
  double edge_square_ = 0.0, edge_sum_ = 0.0;
  double reach_ = 0.0, cross_error_ = 0.0, dot_error_ = 0.0, tolerance_ = 0.0;

  // The best candidate so far; its cotangent is best_dot_ / best_cross_. Flat: there is none yet,
  // or it is so nearly on the edge's line that its cotangent says nothing; then every point that
  // may be left of the edge is a rival.
  std::int32_t best_ = -1;
  bool is_best_flat_ = true;
  double best_dot_ = 0.0, best_cross_ = 0.0;

  SearchCounts counts_;
};

}  // namespace tinsmith
