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
    double disc_cotangent = first_disc();
    if (hint != kNoVertex && is_promising(hint, disc_cotangent)) offer(number(hint));
    Cells searched = cap_cells(has_best() ? ceiling_ : disc_cotangent);
    scan(searched);
    while (!has_best()) {
      if (all_cells().within(searched)) throw std::logic_error("an edge inside the hull found no third point");
      disc_radius_ *= 2.0;
      disc_cotangent = cotangent_of_radius(disc_radius_);
      searched = cap_cells(disc_cotangent);
      scan(searched);
    }
    const Cells needed = cap_cells(ceiling_);
    if (!needed.within(searched)) scan(needed);
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
  static constexpr double kNoCeiling = 1e300;

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
    half_ = 0.5 * std::sqrt(ex_ * ex_ + ey_ * ey_);
    best_ = -1;
    ceiling_ = floor_ = kNoCeiling;
    set_reach(half_ * 4.0 + cell_);
  }

  double first_disc() {
    disc_radius_ = std::max(kDiscPerHalfEdge * half_, kDiscPerCell * cell_);
    return cotangent_of_radius(disc_radius_);
  }

  double cotangent_of_radius(double radius) const {
    const double ratio = radius / half_;
    return ratio > 1.0 ? std::sqrt((ratio - 1.0) * (ratio + 1.0)) : 0.0;
  }

  // Error bounds for candidates whose coordinates differ from a's by at most `reach`: of the
  // cross product e x p, and of the dot product p . q (q is taken as p - e).
  void set_reach(double reach) {
    reach_ = reach;
    cross_error_ = 8.0 * kUnitRoundoff * (std::fabs(ex_) + std::fabs(ey_)) * reach;
    dot_error_ = 24.0 * kUnitRoundoff * reach * reach;
    update_tolerance();
  }

  void update_tolerance() {
    tolerance_ = dot_error_ + std::fabs(ceiling_) * cross_error_;
  }

  bool is_promising(Vertex hint, double disc_cotangent) {
    const double px = x_[number(hint)] - ax_, py = y_[number(hint)] - ay_;
    const double reach = std::max(std::fabs(px), std::fabs(py));
    if (reach > reach_) return false;
    const double cross = ex_ * py - ey_ * px;
    if (!(cross > cross_error_)) return false;
    return px * (px - ex_) + py * (py - ey_) < disc_cotangent * cross;
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
        const bool is_rival = !(dot - cross * ceiling_ > tolerance_);
        if (is_left & is_rival) offer(i);
      }
    });
  }

  // A candidate that may be left of the edge and may beat the best so far.
  void offer(std::int32_t i) {
    if (i == best_ || i == b_ || i == a_) return;
    const double px = x_[i] - ax_, py = y_[i] - ay_;
    const double cross = ex_ * py - ey_ * px;
    const double dot = px * (px - ex_) + py * (py - ey_);
    const bool is_surely_left = cross > cross_error_;
    if (!is_surely_left) {
      ++counts_.exact_decisions;
      if (orientation(here(a_), here(b_), here(i)) <= 0) return;
    }
    if (has_best()) {
      const double certain = dot_error_ + std::fabs(floor_) * cross_error_;
      const bool is_surely_better = is_surely_left && dot - cross * floor_ < -certain;
      if (!is_surely_better) {
        ++counts_.exact_decisions;
        if (!is_in_circle(here(a_), here(b_), here(best_), here(i))) return;
      }
    }
    accept(i, dot, cross);
  }

  // Bracket the best's cotangent by what rounding may have done to it.
  void accept(std::int32_t i, double dot, double cross) {
    best_ = i;
    ceiling_ = kNoCeiling;
    floor_ = -kNoCeiling;
    if (cross > 2.0 * cross_error_) {
      const double cotangent = dot / cross;
      const double error = 2.0 * (dot_error_ + std::fabs(cotangent) * cross_error_) / cross +
                           4.0 * kUnitRoundoff * std::fabs(cotangent);
      ceiling_ = std::min(cotangent + error, kNoCeiling);
      floor_ = std::max(cotangent - error, -kNoCeiling);
    }
    update_tolerance();
  }

  Point here(std::int32_t i) const { return {x_[i], y_[i]}; }

  // ------------------------------------------------------------- boxes

  // Cells that meet the left cap of the circle with this cotangent.
  Cells cap_cells(double cotangent) const {
    const double radius = half_ * std::sqrt(1.0 + cotangent * cotangent);
    if (!(radius < kNoCeiling)) return all_cells();
    const double cx = 0.5 * (ex_ - ey_ * cotangent), cy = 0.5 * (ey_ + ex_ * cotangent);
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
    if (reach > reach_) {
      set_reach(reach);
      if (has_best()) rebracket();
    }
  }

  void rebracket() {
    const double px = x_[best_] - ax_, py = y_[best_] - ay_;
    accept(best_, px * (px - ex_) + py * (py - ey_), ex_ * py - ey_ * px);
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
  double half_ = 0.0, disc_radius_ = 0.0;
  double reach_ = 0.0, cross_error_ = 0.0, dot_error_ = 0.0, tolerance_ = 0.0;

  // The best candidate so far and the bracket of its cotangent.
  std::int32_t best_ = -1;
  double ceiling_ = 0.0, floor_ = 0.0;

  SearchCounts counts_;
};

}  // namespace tinsmith
