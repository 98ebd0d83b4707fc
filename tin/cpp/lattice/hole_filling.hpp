// Holes in a lattice, filled with triangles.
//
//      . . . . .        A small hole is filled by growth from an open edge: the third point is
//      . . N . .        sought among the places around the edge, and proven if its circle stays
//      . W   E .        among them. What needs more than a few triangles or places is undone: all
//      . . S . .        such holes are filled at once, from a triangulation of the points around
//      . . . . .        them and within. It has all triangles in the holes, since their circles
//                       hold no point at all; those elsewhere are left out.
//
// Triangles in holes are what fills the lattice's cells that have none: an open edge belongs to one
// cell, which tells the triangle on its left.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../predicates/predicates.hpp"
#include "../search/circle_on_edge.hpp"
#include "lattice_cells.hpp"

namespace tinsmith {

// A triangle in a hole. Beyond the edge opposite to a corner lies another one in the hole, or the
// outside, or what the cell that has the edge says.
struct Filling {
  static constexpr std::int32_t kOutside = -1;
  static constexpr std::int32_t kOfCell = -2;
  static constexpr std::int32_t kOpen = -3;  // while it is made

  std::array<std::int32_t, 3> corner;  // places, counter-clockwise
  std::array<std::int32_t, 3> beyond;

  LatticeCells::Edge edge(std::uint32_t k) const {
    return {corner[corner_after(k)], corner[corner_before(k)]};
  }
};

class HoleFilling {
 public:
  static constexpr std::int32_t kUnfilled = -1;

  explicit HoleFilling(const LatticeCells& cells)
      : cells_(cells),
        lattice_(cells.lattice()),
        slack_(coordinate_slack(lattice_.box())),
        of_cell_(scratch_array<std::int32_t>(lattice_.places())) {
    std::fill_n(of_cell_.get(), lattice_.places(), kUnfilled);
  }

  const std::vector<Filling>& triangles() const { return triangles_; }

  // The triangle left of the cell's open edge; kUnfilled where the outside is.
  std::int32_t left_of_open_edge(std::int32_t cell) const { return of_cell_[cell]; }

  // Edges of the hull, once all holes are filled.
  std::int64_t outside_edges() const {
    std::int64_t count = 0;
    for (std::int32_t cell = 0; cell < lattice_.places(); ++cell) count += is_unfilled(cell);
    for (const Filling& filling : triangles_) {
      count += std::count(filling.beyond.begin(), filling.beyond.end(), Filling::kOutside);
    }
    return count;
  }

  // Fill the small holes at a row of cells.
  void fill_small(std::int32_t row) {
    for (std::int32_t column = 0; column < lattice_.columns(); ++column) {
      const std::int32_t cell = row * lattice_.columns() + column;
      if (!is_unfilled(cell) || of_cell_[cell] == kLeft || cells_.is_outside(column, row)) continue;
      if (is_beside_single_hole(cell)) {
        fill_single(cell);
      } else {
        fill_from(cell);
      }
    }
  }

  // The points in and around holes that are not filled; few others may be among them.
  std::vector<std::int32_t> places_left() const {
    std::vector<std::int32_t> places;
    if (!is_any_left_) return places;
    for (std::int32_t row = 0; row < lattice_.rows(); ++row) {
      for (std::int32_t column = 0; column < lattice_.columns(); ++column) {
        const std::int32_t cell = row * lattice_.columns() + column;
        if (is_loose(cell)) places.push_back(cell);
        if (!is_unfilled(cell) || cells_.is_outside(column, row)) continue;
        places.push_back(cells_.open_edge(cell).from);
        places.push_back(cells_.open_edge(cell).to);
      }
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
  }

  // Take the triangles in holes from the triangulation of `places`.
  void fill_rest(const std::vector<std::int32_t>& places, const std::int32_t* corners,
                 const std::int32_t* neighbors, std::int64_t count) {
    const Given given{places, corners, neighbors};
    std::vector<std::int32_t> filling_of(count, kUnfilled);
    std::vector<std::int64_t> pending;
    for (std::int64_t seed = 0; seed < count; ++seed) {
      if (filling_of[seed] != kUnfilled || !is_at_open_edge(given, seed)) continue;
      take(given, seed, filling_of);
      pending.push_back(seed);
      while (!pending.empty()) {
        const std::int64_t taken = pending.back();
        pending.pop_back();
        spread(given, taken, filling_of, pending);
      }
    }
  }

 private:
  // Places on either side of an edge that are searched for a third point, at first and at most.
  static constexpr std::int32_t kFirstReach = 1;
  static constexpr std::int32_t kMostReach = 3;
  static constexpr std::size_t kMostTriangles = 32;  // in a small hole
  static constexpr std::int32_t kLeft = -2;          // for a triangulation of its own
  static constexpr std::int32_t kNoPlace = -1;

  struct OpenEdge {
    LatticeCells::Edge edge;  // without a triangle on its left
    std::int32_t right;       // the filling on its right, or kOfCell
    std::uint32_t corner;     // of that filling, opposite the edge
  };
  struct Window {
    std::int32_t west, east, south, north;  // columns and rows, all included
  };

  Point point(std::int32_t place) const { return lattice_.point(place); }

  // ------------------------------------------------------------- small holes

  // Whether the cell is south-west of an empty place with eight taken ones around it.
  bool is_beside_single_hole(std::int32_t cell) const {
    const std::int32_t columns = lattice_.columns();
    return cells_.corners(cell) == corner::kAll - corner::kNE &&
           cells_.corners(cell + 1) == corner::kAll - corner::kNW &&
           cells_.corners(cell + columns) == corner::kAll - corner::kSE &&
           cells_.corners(cell + columns + 1) == corner::kAll - corner::kSW;
  }

  // Such a hole is a quadrilateral, and two triangles.
  void fill_single(std::int32_t cell) {
    const std::int32_t columns = lattice_.columns();
    const std::int32_t west = cell + columns, south = cell + 1;
    const std::int32_t east = west + 2, north = west + columns + 1;
    const auto made = static_cast<std::int32_t>(triangles_.size()), other = made + 1;
    constexpr std::int32_t kOfCell = Filling::kOfCell;
    const bool is_split_upright =
        is_in_circle(point(west), point(south), point(east), point(north));
    if (is_split_upright) {
      triangles_.push_back({{west, south, north}, {other, kOfCell, kOfCell}});
      triangles_.push_back({{east, north, south}, {made, kOfCell, kOfCell}});
    } else {
      triangles_.push_back({{south, east, west}, {other, kOfCell, kOfCell}});
      triangles_.push_back({{north, west, east}, {made, kOfCell, kOfCell}});
    }
    of_cell_[cell] = made;
    of_cell_[cell + 1] = is_split_upright ? other : made;
    of_cell_[cell + columns] = is_split_upright ? made : other;
    of_cell_[cell + columns + 1] = other;
  }

  void fill_from(std::int32_t cell) {
    const std::size_t first = triangles_.size();
    open_.clear();
    filled_.clear();
    open_.push_back({cells_.open_edge(cell), Filling::kOfCell, 0});
    while (!open_.empty()) {
      const OpenEdge edge = open_.back();
      open_.pop_back();
      const std::int32_t third =
          triangles_.size() - first < kMostTriangles ? third_point(edge.edge) : kNoPlace;
      if (third == kNoPlace || !add(edge, third)) return undo(first, cell);
    }
  }

  void undo(std::size_t first, std::int32_t cell) {
    for (const std::int32_t filled : filled_) of_cell_[filled] = kUnfilled;
    of_cell_[cell] = kLeft;
    triangles_.resize(first);
    is_any_left_ = true;
  }

  // False if the hole is one that is left.
  bool add(const OpenEdge& base, std::int32_t third) {
    const auto made = static_cast<std::int32_t>(triangles_.size());
    triangles_.push_back(
        {{base.edge.from, base.edge.to, third}, {Filling::kOpen, Filling::kOpen, base.right}});
    if (base.right == Filling::kOfCell) {
      if (!fill_cell(cells_.cell_left_of(base.edge), made)) return false;
    } else {
      triangles_[base.right].beyond[base.corner] = made;
    }
    return close(made, 0) && close(made, 1);
  }

  bool fill_cell(std::int32_t cell, std::int32_t made) {
    if (of_cell_[cell] != kUnfilled) return false;
    of_cell_[cell] = made;
    filled_.push_back(cell);
    return true;
  }

  // Join an edge of a new triangle to what is beyond, or let it wait.
  bool close(std::int32_t made, std::uint32_t corner) {
    const LatticeCells::Edge edge = triangles_[made].edge(corner);
    std::int32_t& beyond = triangles_[made].beyond[corner];
    const std::int32_t cell = cells_.cell_left_of(edge);
    if (cell != LatticeCells::kNoCell) {
      beyond = Filling::kOfCell;
      return fill_cell(cell, made);
    }
    for (OpenEdge& waiting : open_) {
      if (waiting.edge.from != edge.from || waiting.edge.to != edge.to) continue;
      beyond = waiting.right;
      triangles_[waiting.right].beyond[waiting.corner] = made;
      waiting = open_.back();
      open_.pop_back();
      return true;
    }
    open_.push_back({{edge.to, edge.from}, made, corner});
    return true;
  }

  // The point that sees the edge under the largest angle from the left; kNoPlace if it is not
  // among the places around the edge for certain.
  std::int32_t third_point(LatticeCells::Edge edge) const {
    for (std::int32_t reach = kFirstReach; reach <= kMostReach; ++reach) {
      const Window window = window_around(edge, reach);
      const std::int32_t best = best_in(window, edge);
      if (best != kNoPlace && is_enclosed(edge, best, window)) return best;
    }
    return kNoPlace;
  }

  Window window_around(LatticeCells::Edge edge, std::int32_t reach) const {
    const std::int32_t c = lattice_.column_of(edge.from), d = lattice_.column_of(edge.to);
    const std::int32_t r = lattice_.row_of(edge.from), s = lattice_.row_of(edge.to);
    return {std::max(std::min(c, d) - reach, 1),
            std::min(std::max(c, d) + reach, lattice_.columns() - 2),
            std::max(std::min(r, s) - reach, 1),
            std::min(std::max(r, s) + reach, lattice_.rows() - 2)};
  }

  std::int32_t best_in(const Window& window, LatticeCells::Edge edge) const {
    const Point a = point(edge.from), b = point(edge.to);
    std::int32_t best = kNoPlace;
    Point at{};
    for (std::int32_t row = window.south; row <= window.north; ++row) {
      for (std::int32_t column = window.west; column <= window.east; ++column) {
        const std::int32_t place = row * lattice_.columns() + column;
        if (!lattice_.is_taken(place) || place == edge.from || place == edge.to) continue;
        const Point p{lattice_.x(column), lattice_.y(row)};
        if (orientation(a, b, p) <= 0) continue;
        if (best != kNoPlace && !is_in_circle(a, b, at, p)) continue;
        best = place;
        at = p;
      }
    }
    return best;
  }

  // Whether the circle through the edge and a point on its left stays, on the left, between the
  // columns and rows next to the window's: all places there were looked at.
  bool is_enclosed(LatticeCells::Edge edge, std::int32_t third, const Window& window) const {
    const Point a = point(edge.from), b = point(edge.to), c = point(third);
    const double ex = b.x - a.x, ey = b.y - a.y, px = c.x - a.x, py = c.y - a.y;
    const double reach = std::max({std::fabs(ex), std::fabs(ey), std::fabs(px), std::fabs(py)});
    const CotangentErrors errors(std::fabs(ex) + std::fabs(ey), reach);
    const double cross = ex * py - ey * px;
    if (!(cross > 2.0 * errors.cross())) return false;
    const double cotangent = errors.widened(px * (px - ex) + py * (py - ey), cross);
    const Point center{0.5 * (ex - ey * cotangent), 0.5 * (ey + ex * cotangent)};
    const double radius = 0.5 * std::sqrt((ex * ex + ey * ey) * (1.0 + cotangent * cotangent));
    const Box cap = box_of_cap({ex, ey}, center, radius);
    const double slack = slack_ + 4.0 * kSlack * radius;
    return a.x + cap.west - slack > lattice_.x(window.west - 1) &&
           a.x + cap.east + slack < lattice_.x(window.east + 1) &&
           a.y + cap.south - slack > lattice_.y(window.south - 1) &&
           a.y + cap.north + slack < lattice_.y(window.north + 1);
  }

  // ------------------------------------------------------------- the other holes

  // The triangulation of some places, numbered by their own.
  struct Given {
    const std::vector<std::int32_t>& places;
    const std::int32_t* corners;
    const std::int32_t* neighbors;

    std::int32_t corner(std::int64_t t, std::uint32_t k) const {
      return places[corners[3 * t + k]];
    }
    LatticeCells::Edge edge(std::int64_t t, std::uint32_t k) const {
      return {corner(t, corner_after(k)), corner(t, corner_before(k))};
    }
  };

  // Whether a place has a point without any edge that is certain.
  bool is_loose(std::int32_t place) const {
    const std::uint8_t corners = cells_.corners(place);
    if (corners != corner::kSW && corners != (corner::kSW | corner::kNE)) return false;
    const std::int32_t columns = lattice_.columns();
    for (const std::int32_t cell : {place - 1, place - columns, place - columns - 1}) {
      if (cells_.is_full(cell) || cells_.has_open_edge(cell)) return false;
    }
    return true;
  }

  bool is_unfilled(std::int32_t cell) const {
    return cells_.has_open_edge(cell) && of_cell_[cell] < 0;
  }

  // The cell whose open edge this is and has no triangle yet.
  std::int32_t unfilled_cell_at(LatticeCells::Edge edge) const {
    const std::int32_t cell = cells_.cell_left_of(edge);
    if (cell == LatticeCells::kNoCell || !is_unfilled(cell)) return LatticeCells::kNoCell;
    const LatticeCells::Edge open = cells_.open_edge(cell);
    return open.from == edge.from && open.to == edge.to ? cell : LatticeCells::kNoCell;
  }

  bool is_at_open_edge(const Given& given, std::int64_t t) const {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (unfilled_cell_at(given.edge(t, k)) != LatticeCells::kNoCell) return true;
    }
    return false;
  }

  void take(const Given& given, std::int64_t t, std::vector<std::int32_t>& filling_of) {
    filling_of[t] = static_cast<std::int32_t>(triangles_.size());
    triangles_.push_back({{given.corner(t, 0), given.corner(t, 1), given.corner(t, 2)},
                          {Filling::kOpen, Filling::kOpen, Filling::kOpen}});
  }

  // Join a triangle that was taken to what is beyond its edges, and take those in the hole.
  void spread(const Given& given, std::int64_t t, std::vector<std::int32_t>& filling_of,
              std::vector<std::int64_t>& pending) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::int32_t cell = unfilled_cell_at(given.edge(t, k));
      std::int32_t beyond = Filling::kOutside;
      if (cell != LatticeCells::kNoCell) {
        of_cell_[cell] = filling_of[t];
        beyond = Filling::kOfCell;
      } else if (const std::int32_t next = given.neighbors[3 * t + k]; next >= 0) {
        if (filling_of[next] == kUnfilled) {
          take(given, next, filling_of);
          pending.push_back(next);
        }
        beyond = filling_of[next];
      }
      triangles_[filling_of[t]].beyond[k] = beyond;
    }
  }

  const LatticeCells& cells_;
  const Lattice& lattice_;
  double slack_;
  std::vector<Filling> triangles_;
  ScratchArray<std::int32_t> of_cell_;
  bool is_any_left_ = false;
  std::vector<OpenEdge> open_;        // of the hole at hand
  std::vector<std::int32_t> filled_;  // cells
};

}  // namespace tinsmith
