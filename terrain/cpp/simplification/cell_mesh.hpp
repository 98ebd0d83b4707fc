// A mesh of some of the cells of a raster, which knows how far the others are from it.
//
// The cells of a triangle are found by scan conversion when they are asked for, not kept in lists
// (M. Garland, P. S. Heckbert, "Fast polygonal approximation of terrains and height fields", 1995).
// Planes are reckoned in columns and rows, whose differences are exact. The mesh holds the cells'
// own coordinates: its triangles are those of the triangulation of the vertices.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/mesh/mesh_editor.hpp"
#include "../../../tin/cpp/simplification/star_gap.hpp"
#include "cell_rows.hpp"
#include "row_errors.hpp"

namespace tinsmith {

using CellId = std::int32_t;  // row by row, from the south-west on
constexpr CellId kNoCell = -1;

// Centres of columns from west to east, of rows from south to north; elevations row by row, no
// number where there is none.
struct CellElevations {
  const double* x;
  const double* y;
  const double* z;
  std::int32_t columns, rows;

  std::size_t count() const { return static_cast<std::size_t>(columns) * rows; }
};

// The cell of a triangle that is farthest from it in elevation.
struct WorstCell {
  CellId worst = kNoCell;
  double error = 0.0;
};

class CellMesh {
 public:
  // The cells that are vertices of the mesh; cells that are nearer than `least` are not looked for.
  CellMesh(MeshEditor& editor, const CellElevations& grid, const CellId* vertex_cells, double least,
           VectorPath path = vector_paths().back().path)
      : editor_(editor),
        grid_(grid),
        least_(least),
        open_(grid.z, grid.z + grid.count()),
        find_far_row_(far_row_search(path)) {
    open_.resize(open_.size() + kMostLanes, kNoElevation);
    steps_.resize(static_cast<std::size_t>(grid.columns) + kMostLanes);
    for (std::size_t i = 0; i < steps_.size(); ++i) steps_[i] = static_cast<double>(i);
    for (std::int32_t v = 0; v < editor.slots(); ++v) add(vertex_cells[v]);
    worst_.resize(editor.mesh().triangle_slots());
  }

  const MeshEditor& editor() const { return editor_; }
  const Mesh& mesh() const { return editor_.mesh(); }
  const WorstCell& list(Triangle t) const { return worst_[number(t)]; }
  Point place(CellId c) const { return {grid_.x[c % grid_.columns], grid_.y[c / grid_.columns]}; }
  static bool comes_before(CellId c, CellId d) { return c < d; }
  bool comes_before(Vertex v, Vertex w) const { return row(v) < row(w); }
  std::int32_t row(Vertex v) const { return id(cell_[static_cast<std::size_t>(number(v))].cell); }

  template <typename KeepGoing>
  bool measure_all(KeepGoing&& keep_going) {
    for (const Triangle t : mesh().triangles()) {
      if (!keep_going()) return false;
      measure(t);
    }
    return true;
  }

  // A cell of the triangle is likely to be the next: have the elevations around it at hand.
  void expect(Triangle t) const {
    const CellId c = worst_[number(t)].worst;
    if (c == kNoCell) return;
    const std::int32_t row = c / grid_.columns;
    const std::int32_t first = std::max(row - kNearRows, 0);
    const std::int32_t last = std::min(row + kNearRows, grid_.rows - 1);
    for (std::int32_t near = first; near <= last; ++near) {
      prefetch(open_.data() + c + std::ptrdiff_t{near - row} * grid_.columns);
    }
  }

  // Make a cell of a triangle a vertex; `visit` is called for every triangle that is new. One that
  // rounding has put outside is left to others.
  template <typename Visit>
  void insert(Triangle t, CellId c, Visit&& visit) {
    const Point p = place(c);
    const MeshLocation at = locate(p, t);
    if (at.where == MeshLocation::Where::kOutside) {
      open_[static_cast<std::size_t>(c)] = kNoElevation;
      measure(t);
      return visit(t);
    }
    add(c);
    const Vertex v = editor_.insert_at(at, p, editor_.add_slot());
    worst_.resize(mesh().triangle_slots());
    for (const HalfEdge e : mesh().around(v)) {
      measure(triangle_of(e));
      visit(triangle_of(e));
    }
  }

  // The largest error that a cell would have without the vertex, which has no fixed edge; infinity as
  // soon as one is above the limit.
  double error_without(Vertex v, double limit) {
    find_gap(v);
    double worst = error_in_gap(cell_[static_cast<std::size_t>(number(v))]);
    for (const GapTriangle& t : gap()) {
      if (!(worst <= limit)) return kInfinity;
      worst = largest_error_in(t, worst, limit);
    }
    return worst <= limit ? worst : kInfinity;
  }

  // Make a vertex without fixed edges a cell like others again.
  void remove(Vertex v) {
    editor_.remove(v);
    const auto c = static_cast<std::size_t>(row(v));
    open_[c] = grid_.z[c];
  }

 private:
  static constexpr std::int32_t kNearRows = 6;

  static void prefetch([[maybe_unused]] const double* z) {
#if defined(__GNUC__)
    __builtin_prefetch(z);
#endif
  }

  struct VertexCell {
    Cell cell;
    double z;
  };

  CellId id(Cell cell) const { return cell.row * grid_.columns + cell.column; }

  void add(CellId c) {
    cell_.push_back({{c % grid_.columns, c / grid_.columns}, grid_.z[c]});
    open_[static_cast<std::size_t>(c)] = kNoElevation;
  }

  CellTriangle triangle(const Vertex (&vertex)[3]) const {
    CellTriangle found;
    for (int k = 0; k < 3; ++k) {
      const VertexCell& at = cell_[static_cast<std::size_t>(number(vertex[k]))];
      found.cell[k] = at.cell;
      found.z[k] = at.z;
    }
    found.turn();
    return found;
  }

  PlaneOverRows plane(const CellTriangle& t) const {
    return {CellPlane(t), open_.data(), grid_.columns, steps_.data()};
  }

  static bool has_no_other_cell(const CellTriangle& t) { return t.twice_area() <= 1; }

  void measure(Triangle t) {
    WorstCell& found = worst_[number(t)];
    found = {};
    if (mesh().is_free(t) || mesh().is_ghost(t)) return;
    const CellTriangle cells = triangle(mesh()[t].corner);
    if (has_no_other_cell(cells)) return;
    const PlaneOverRows over = plane(cells);
    rows_.list(cells.cell[0], cells.cell[1], cells.cell[2]);
    const CellRow* const end = rows_.end();
    FarRow far{nullptr, least_};
    std::int32_t column = 0;
    for (const CellRow* row = rows_.begin(); row != end; ++row) {
      const FarRow next = find_far_row_(over, row, end, far.error);
      row = next.row;
      if (row == end) break;
      const std::int32_t there = find_column(over, next);
      if (next.error == far.error && far.row != nullptr && there >= column) continue;
      far = next;
      column = there;
    }
    if (far.row != nullptr) found = {id({column, far.row->row}), far.error};
  }

  // Where a cell of a triangle is: in it but where its coordinates are rounded.
  MeshLocation locate(Point p, Triangle t) {
    HalfEdge edge = kNoHalfEdge;
    for (const HalfEdge e : half_edges(t)) {
      const int side = orientation(editor_.point(mesh().from(e)), editor_.point(mesh().to(e)), p);
      if (side < 0 || (side == 0 && edge != kNoHalfEdge)) return editor_.locate(p, e);
      if (side == 0) edge = e;
    }
    if (edge == kNoHalfEdge) return {MeshLocation::Where::kInside, half_edge(t, 0)};
    return {MeshLocation::Where::kOnEdge, edge};
  }

  // The first column of a row with an error.
  static std::int32_t find_column(const PlaneOverRows& over, const FarRow& far) {
    const double* const z = over.z_of(*far.row);
    const double base = over.at(*far.row), slope = over.plane.east();
    std::int32_t i = 0;
    while (std::fabs(z[i] - (base + slope * over.steps[i])) != far.error) ++i;
    return far.row->first + i;
  }

  // ------------------------------------------------------------------- removal

  // The triangles in the place of a vertex's star; where they cannot be told, it goes and comes back.
  void find_gap(Vertex v) {
    is_tried_ = !star_.find(editor_, v);
    if (!is_tried_) return;
    const Point p = editor_.point(v);
    editor_.watch();
    editor_.take_touched(touched_);
    editor_.remove(v);
    editor_.take_touched(touched_);
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    tried_.clear();
    for (const Triangle t : touched_) {
      if (mesh().is_free(t) || mesh().is_ghost(t)) continue;
      const auto& corner = mesh()[t].corner;
      tried_.push_back({{corner[0], corner[1], corner[2]}});
    }
    editor_.insert_at(editor_.locate(p, kNoHalfEdge), p, v);
  }
  const std::vector<GapTriangle>& gap() const { return is_tried_ ? tried_ : star_.triangles(); }

  // Of the vertex that is gone.
  double error_in_gap(const VertexCell& gone) const {
    for (const GapTriangle& t : gap()) {
      const CellTriangle cells = triangle(t.corner);
      if (!cells.holds(gone.cell)) continue;
      return std::fabs(gone.z - CellPlane(cells).at(gone.cell.column, gone.cell.row));
    }
    return 0.0;
  }

  // The largest error in a triangle if it is above `known` and within the limit; one above the limit
  // if there is any.
  double largest_error_in(const GapTriangle& t, double known, double limit) {
    const CellTriangle cells = triangle(t.corner);
    if (has_no_other_cell(cells)) return known;
    const PlaneOverRows over = plane(cells);
    rows_.list(cells.cell[0], cells.cell[1], cells.cell[2]);
    const CellRow* const end = rows_.end();
    for (const CellRow* row = rows_.begin(); row != end && known <= limit; ++row) {
      const FarRow next = find_far_row_(over, row, end, known);
      row = next.row;
      if (row == end) break;
      known = next.error;
    }
    return known;
  }

  MeshEditor& editor_;
  CellElevations grid_;
  double least_;
  ScratchVector<double> open_;  // elevations of the cells that are no vertices; no number elsewhere
  std::vector<double> steps_;   // 0, 1, 2, ...
  std::vector<VertexCell> cell_;  // of each vertex
  std::vector<WorstCell> worst_;  // by triangle
  FindFarRow find_far_row_;
  CellRows rows_;  // of the triangle at hand

  StarGap star_;
  bool is_tried_ = false;
  std::vector<GapTriangle> tried_;
  std::vector<Triangle> touched_;
};

}  // namespace tinsmith
