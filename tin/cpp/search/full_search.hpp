// Full search for the third point: of all points left of an edge, the one that sees it under the
// largest angle, found over the whole index.
//
// Once a candidate is known, only its cap (circle_on_edge.hpp) needs to be searched, and the cap
// shrinks as candidates improve: the paper's moving circle.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../index/grid.hpp"
#include "../predicates/predicates.hpp"
#include "circle_on_edge.hpp"
#include "search_counts.hpp"

namespace tinsmith {

// Thrown by a search that passes the work allowed: a single one may look at every point.
struct SearchTooCostly {};

class ThirdPointSearch {
 public:
  // `own` are the positions whose vertices are finished in turn; all others come later.
  ThirdPointSearch(const PointGrid& grid, Range own)
      : grid_(grid),
        x_(grid.x()),
        y_(grid.y()),
        own_(own),
        cell_(grid.top().cell_size),
        coordinate_slack_(coordinate_slack(grid.top().box)) {}

  // Searches are about `v` from now on: the vertex being finished, among cells of this size.
  void move_to(Vertex v, double cell) {
    a_ = number(v);
    ax_ = x_[a_];
    ay_ = y_[a_];
    cell_ = cell;
  }

  // The winner for the edge from v to b among the points after v in the sweep: all points before
  // have all their triangles. Requires a winner: the edge is not on the hull with its outside to
  // the left. `hint` is a point that may win, or kNoVertex.
  Vertex third_point(Vertex b, Vertex hint) {
    ++counts_.full_searches;
    set_edge(b);
    Circle circle = first_disc();
    hint_ = number(hint);
    if (hint != kNoVertex && is_promising(hint, circle)) offer(hint_);
    const bool is_long = circle.radius > kLongInCells * cell_;
    if (is_long && !has_best()) offer_likely();
    if (has_best()) circle = best_circle();
    Cap searched = cap_of(circle);
    scan(searched);
    while (!has_best()) {
      if (!(circle.radius < kUnbounded)) {
        throw std::logic_error("an edge inside the hull found no third point");
      }
      offer_likely();
      circle = has_best() ? best_circle() : larger(circle, searched);
      searched = cap_of(circle);
      scan(searched);
    }
    // Caps on one edge are nested by their cotangent.
    if (best_circle().radius > kWide * circle.radius) offer_likely();
    const Circle needed = best_circle();
    if (needed.cotangent > circle.cotangent) {
      Cap cap = cap_of(needed);
      if (!is_searched(cap, searched)) scan(cap);
    }
    last_third_ = best_;
    return static_cast<Vertex>(best_);
  }

  // The point nearest to a vertex that has no triangle yet: the two are always an edge. All its
  // neighbours come after it in the sweep, so only those are looked at; of equally near ones the
  // first in the sweep is taken.
  Vertex nearest() {
    for (double radius = cell_; std::isfinite(radius);) {
      const std::int32_t found = nearest_in(Disc{box_around(radius)});
      if (found >= 0 && distance_to(found) <= radius) return static_cast<Vertex>(found);
      radius = found < 0 ? 2.0 * radius : distance_to(found);
    }
    throw std::logic_error("a point has no other one after it in the sweep");
  }

  SearchCounts& counts() { return counts_; }

  // Total work up to which searches go on.
  void allow(std::int64_t work) { allowed_ = work; }

 private:
  // First disc: radius over half the edge, and over the cell.
  static constexpr double kDiscPerHalfEdge = 1.15;
  static constexpr double kDiscPerCell = 0.8;
  static constexpr double kDiscCotangent = 0.56789083458002739;  // sqrt(1.15^2 - 1)
  static constexpr double kUnbounded = 1e300;
  // A first disc of this many cells is long for its surroundings: the data run along lines.
  static constexpr double kLongInCells = 3.0;
  // A best whose circle is this much wider than the disc searched was met by chance.
  static constexpr double kWide = 2.0;

  // A circle on the edge, by the cotangent under which its left side sees the edge.
  struct Circle {
    double cotangent;
    double radius;
  };

  // The part of a circle left of the edge, as a region of the index.
  class Cap {
   public:
    Cap(const Box& box, Point center, const Circle& circle, const ThirdPointSearch& search)
        : box_(box),
          center_(center),
          circle_(circle),
          radius_(circle.radius),
          slack_(search.slack_of(radius_ < kUnbounded ? radius_ : 0.0)),
          search_(&search) {}

    const Box& box() const { return box_; }
    const Circle& circle() const { return circle_; }

    // Cut the row of cells from south to north down to where it meets the cap.
    bool narrow(double south, double north, double& west, double& east) const {
      if (!(radius_ < kUnbounded)) {
        search_->cut_by_edge(south - slack_, north + slack_, west, east);
        return west <= east;
      }
      const double off = std::max({0.0, south - center_.y, center_.y - north}) - slack_;
      const double reach = radius_ + slack_;
      if (off > reach) return false;
      const double half_chord = off > 0.0 ? std::sqrt((reach - off) * (reach + off)) : reach;
      west = std::max(west, center_.x - half_chord - slack_);
      east = std::min(east, center_.x + half_chord + slack_);
      search_->cut_by_edge(south - slack_, north + slack_, west, east);
      return west <= east;
    }

   private:
    Box box_;
    Point center_;
    Circle circle_;
    double radius_, slack_;
    const ThirdPointSearch* search_;
  };

  // A whole disc, as its box.
  struct Disc {
    Box bounds;
    const Box& box() const { return bounds; }
    bool narrow(double, double, double&, double&) const { return true; }
  };

  bool has_best() const { return best_ >= 0; }

  void set_edge(Vertex b) {
    b_ = number(b);
    ex_ = x_[b_] - ax_;
    ey_ = y_[b_] - ay_;
    edge_square_ = ex_ * ex_ + ey_ * ey_;
    edge_sum_ = std::fabs(ex_) + std::fabs(ey_);
    best_ = -1;
    is_best_flat_ = true;
    best_dot_ = best_cross_ = 0.0;
    set_reach(2.0 * edge_sum_ + cell_);
  }

  Circle first_disc() const {
    const double least = kDiscPerCell * cell_;
    const double radius_square = kDiscPerHalfEdge * kDiscPerHalfEdge * 0.25 * edge_square_;
    if (radius_square > least * least) return {kDiscCotangent, std::sqrt(radius_square)};
    return circle_of_radius(least);
  }

  // Twice the radius, or everything once the cap's box holds everything.
  Circle larger(const Circle& circle, const Cap& searched) const {
    if (grid_.top().box.within(searched.box())) return {kUnbounded, kUnbounded};
    return circle_of_radius(2.0 * circle.radius);
  }

  // Not smaller than the circle on the edge as its diameter.
  Circle circle_of_radius(double radius) const {
    const double square = 4.0 * radius * radius / edge_square_ - 1.0;
    return {square > 0.0 ? std::sqrt(square) : 0.0, radius};
  }

  // The circle through the best candidate, or one a little larger for what rounding may have done.
  Circle best_circle() const {
    if (is_best_flat_ || !(best_cross_ > 2.0 * errors_.cross())) return {kUnbounded, kUnbounded};
    const double cotangent = errors_.widened(best_dot_, best_cross_);
    return {cotangent, 0.5 * std::sqrt(edge_square_ * (1.0 + cotangent * cotangent))};
  }

  // Coordinates of candidates differ from a's by at most `reach`.
  void set_reach(double reach) {
    reach_ = reach;
    errors_ = CotangentErrors(edge_sum_, reach);
    update_tolerance();
  }

  void update_tolerance() {
    // Without a best worth its cotangent any number is above 0 - 0: everything may win.
    tolerance_ = is_best_flat_ ? 1.0 : errors_.tolerance(best_dot_, best_cross_);
  }

  bool is_promising(Vertex hint, const Circle& disc) const {
    const double px = x_[number(hint)] - ax_, py = y_[number(hint)] - ay_;
    if (std::max(std::fabs(px), std::fabs(py)) > reach_) return false;
    const double cross = ex_ * py - ey_ * px;
    return cross > errors_.cross() && px * (px - ex_) + py * (py - ey_) < disc.cotangent * cross;
  }

  // ------------------------------------------------------------- candidates

  void scan(Cap& cap) {
    extend_reach(cap.box());
    const bool shrinks = cap.circle().radius > kLongInCells * cell_;
    for_each_run(cap, [&](std::int32_t begin, std::int32_t end) {
      if (counts_.work() > allowed_) throw SearchTooCostly();
      const std::int32_t best_before = best_;
      counts_.candidates += end - begin;
      counts_.full_candidates += end - begin;
      for (std::int32_t i = begin; i < end; ++i) {
        const double px = x_[i] - ax_, py = y_[i] - ay_;
        const double cross = ex_ * py - ey_ * px;
        const double dot = px * (px - ex_) + py * (py - ey_);
        const bool is_left = cross > -errors_.cross();
        if (is_left & beats_best(dot, cross, 1.0)) {
          // The error bounds hold within reach; beyond it lies no point of the cap.
          if (std::max(std::fabs(px), std::fabs(py)) <= reach_) offer(i, dot, cross);
        }
      }
      if (shrinks && best_ != best_before) shrink(cap);
    });
  }

  // The paper's moving circle: go on within the better circle, which lies inside the old one.
  void shrink(Cap& cap) const {
    const Circle circle = best_circle();
    if (circle.cotangent < cap.circle().cotangent) cap = cap_of(circle);
  }

  // Points that often win where data run along lines: those next to the edge's ends and to the
  // last winner, in the order of the sweep.
  void offer_likely() {
    for (const std::int32_t i : {b_ - 1, b_ + 1, a_ + 1, hint_ - 1, hint_, hint_ + 1,
                                 last_third_ - 1, last_third_, last_third_ + 1, last_third_ + 2}) {
      if (!is_later(i) || i == b_) continue;
      const double px = x_[i] - ax_, py = y_[i] - ay_;
      const double reach = std::max(std::fabs(px), std::fabs(py));
      if (reach > reach_) set_reach(reach);
      const double cross = ex_ * py - ey_ * px;
      const double dot = px * (px - ex_) + py * (py - ey_);
      if (!(cross > errors_.cross())) continue;
      if (!has_best() || beats_best(dot, cross, 1.0)) offer(i, dot, cross);
    }
  }

  bool is_later(std::int32_t i) const {
    return (i > a_ && i < grid_.count()) || (i >= 0 && i < own_.begin);
  }

  void offer(std::int32_t i) {
    const double px = x_[i] - ax_, py = y_[i] - ay_;
    offer(i, px * (px - ex_) + py * (py - ey_), ex_ * py - ey_ * px);
  }

  // A candidate that may be left of the edge and may beat the best so far.
  void offer(std::int32_t i, double dot, double cross) {
    const bool is_surely_left = cross > errors_.cross();
    const bool is_surely_better = is_best_flat_ ? !has_best() : beats_best(dot, cross, -1.0);
    if (!(is_surely_left && is_surely_better) && !wins_exactly(i, is_surely_left)) return;
    best_ = i;
    is_best_flat_ = !is_surely_left;
    best_dot_ = is_best_flat_ ? 0.0 : dot;
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

  // Farther than what a dozen roundings add up to, for points on a circle of this radius.
  double slack_of(double radius) const { return coordinate_slack_ + kSlack * radius; }

  Cap cap_of(const Circle& circle) const {
    const double radius = circle.radius;
    if (!(radius < kUnbounded)) return Cap(grid_.top().box, here(a_), circle, *this);
    const Point center{0.5 * (ex_ - ey_ * circle.cotangent), 0.5 * (ey_ + ex_ * circle.cotangent)};
    const Box cap = box_of_cap({ex_, ey_}, center, radius);
    const double slack = slack_of(radius);
    const Box box{ax_ + cap.west - slack, ay_ + cap.south - slack, ax_ + cap.east + slack,
                  ay_ + cap.north + slack};
    return Cap(box, {ax_ + center.x, ay_ + center.y}, circle, *this);
  }

  // On a plain grid whole cells were looked at, which may hold the new cap too.
  bool is_searched(const Cap& cap, const Cap& searched) const {
    const Level& top = grid_.top();
    const Box& in = cap.box();
    const Box& out = searched.box();
    const std::int32_t first = top.column_at(out.west), last = top.column_at(out.east);
    return grid_.is_plain() && last - first < PointGrid::kNarrowColumns &&
           top.column_at(in.west) >= first && top.column_at(in.east) <= last &&
           top.row_at(in.north) <= top.row_at(out.north) &&
           std::max(top.row_at(in.south), own_.begin > 0 ? 0 : top.row_at(ay_)) >=
               top.row_at(out.south);
  }

  // Keep the side left of the edge, within rows from south to north.
  void cut_by_edge(double south, double north, double& west, double& east) const {
    if (ey_ == 0.0) return;
    const double slope = ex_ / ey_;
    const double at_south = ax_ + slope * (south - ay_), at_north = ax_ + slope * (north - ay_);
    const double slack =
        coordinate_slack_ + kSlack * (std::fabs(slope) * (north - south) +
                                      std::fabs(at_south - ax_) + std::fabs(at_north - ax_));
    if (ey_ > 0.0) {
      east = std::min(east, std::max(at_south, at_north) + slack);
    } else {
      west = std::max(west, std::min(at_south, at_north) - slack);
    }
  }

  Box box_around(double radius) const {
    const double reach = radius + slack_of(radius);
    return Box::of({ax_, ay_}, {ax_, ay_}).grown_by(reach);
  }

  // The box, and on a plain grid all of every cell that meets it (is_searched relies on it).
  void extend_reach(const Box& box) {
    const Box& all = grid_.top().box;
    const double west = std::max(box.west, all.west) - ax_;
    const double east = std::min(box.east, all.east) - ax_;
    const double south = std::max(box.south, all.south) - ay_;
    const double north = std::min(box.north, all.north) - ay_;
    const double reach =
        std::max({std::fabs(west), std::fabs(east), std::fabs(south), std::fabs(north)}) +
        2.0 * cell_;
    if (reach > reach_) set_reach(reach);
  }

  template <typename Region, typename Visit>
  void for_each_run(const Region& region, Visit&& visit) {
    counts_.cell_rows += grid_.for_each_run(region, {a_ + 1, grid_.count()}, visit);
    if (own_.begin > 0) counts_.cell_rows += grid_.for_each_run(region, {0, own_.begin}, visit);
  }

  // ------------------------------------------------------------- nearest

  std::int32_t nearest_in(const Disc& disc) {
    std::int32_t found = -1;
    for_each_run(disc, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = begin; i < end; ++i) {
        const bool is_nearer = found < 0 || compare_distances(here(a_), here(i), here(found)) < 0;
        if (is_nearer) found = i;
      }
    });
    return found;
  }

  double distance_to(std::int32_t i) const { return std::hypot(x_[i] - ax_, y_[i] - ay_); }

  const PointGrid& grid_;
  const double* x_;
  const double* y_;
  Range own_;
  double cell_;  // size of the cells around a
  double coordinate_slack_;

  // The edge at hand, relative to a.
  std::int32_t a_ = 0, b_ = 0;
  double ax_ = 0.0, ay_ = 0.0, ex_ = 0.0, ey_ = 0.0;
  double edge_square_ = 0.0, edge_sum_ = 0.0;
  double reach_ = 0.0, tolerance_ = 0.0;
  CotangentErrors errors_;

  // The best candidate so far; its cotangent is best_dot_ / best_cross_. Flat: there is none yet,
  // or it is so nearly on the edge's line that its cotangent says nothing; then every point that
  // may be left of the edge is a rival.
  std::int32_t best_ = -1;
  std::int32_t hint_ = 0, last_third_ = 0;  // likely winners: the caller's, and the one before
  bool is_best_flat_ = true;
  double best_dot_ = 0.0, best_cross_ = 0.0;

  SearchCounts counts_;
  std::int64_t allowed_ = INT64_MAX;
};

}  // namespace tinsmith
