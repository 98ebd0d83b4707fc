// Cells of a lattice: what each of them says about the triangulation for certain.
//
//      NW ---- NE        The circle of a cell meets its two columns and its two rows in the corners
//      | \      |        alone, and between two columns there is no other one: so no point lies
//      |   \    |        inside, whatever the steps are. With all corners taken a cell is two
//      |     \  |        triangles. The four are cocircular to the last bit, and the rule of ties
//      SW ---- SE        (predicates.hpp) raises the last of them, NE: the diagonal is SE-NW.
//
// With three corners taken a cell is one triangle, and beyond its diagonal lies a hole. Two corners
// side by side are an edge, for the circle on it as diameter is empty too; the cell itself is part
// of a hole. So each cell that is not full has at most one edge with a hole on the left: its open
// edge. Holes are the regions between open edges, within the hull.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "lattice.hpp"

namespace tinsmith {

// Which corners of a cell are taken, as bits.
namespace corner {
constexpr std::uint8_t kSW = 1, kSE = 2, kNW = 4, kNE = 8, kAll = 15;
}

class LatticeCells {
 public:
  // A cell is numbered as the place of its south-west corner.
  LatticeCells(const Lattice& lattice, Team& team)
      : lattice_(lattice),
        corners_(scratch_array<std::uint8_t>(lattice.places())),
        counts_(lattice.rows(), 0),
        points_(lattice.rows(), 0) {
    const std::int32_t columns = lattice.columns();
    offset_ = {0, 1, columns, columns + 1};
    team.run([&](int part) {
      const Range own = part_of(lattice.rows(), part, team.size());
      for (std::int32_t row = own.begin; row < own.end; ++row) look_at_row(row);
    });
    for (const std::int32_t count : counts_) certain_ += count;
    for (const std::int32_t points : points_) taken_ += points;
  }

  const Lattice& lattice() const { return lattice_; }
  std::int64_t points() const { return taken_; }
  std::int64_t certain() const { return certain_; }  // triangles
  std::int32_t certain_in_row(std::int32_t row) const { return counts_[row]; }
  std::int32_t points_in_row(std::int32_t row) const { return points_[row]; }

  std::uint8_t corners(std::int32_t cell) const { return corners_[cell]; }
  bool is_full(std::int32_t cell) const { return corners_[cell] == corner::kAll; }
  bool has_triangle(std::int32_t cell) const { return triangles_in(cell) > 0; }
  int triangles_in(std::int32_t cell) const { return triangles_of(corners_[cell]); }

  // By the corners that are taken: how many triangles, and which corners, counted SW, SE, NW, NE.
  static int triangles_of(int corners) { return kTriangles[corners].count; }
  static const std::int8_t (&corners_of(int corners, int which))[3] {
    return kTriangles[corners].corner[which];
  }

  // Places of the corners of a cell's triangle, counter-clockwise. Of a full cell the triangle 0 is
  // that in the south-west, 1 that in the north-east.
  std::array<std::int32_t, 3> triangle(std::int32_t cell, int which) const {
    const auto& corner = kTriangles[corners_[cell]].corner[which];
    return {cell + offset_[corner[0]], cell + offset_[corner[1]], cell + offset_[corner[2]]};
  }

  struct Edge {
    std::int32_t from, to;  // places
  };
  bool has_open_edge(std::int32_t cell) const { return kOpenEdge[corners_[cell]][0] != kNone; }
  Edge open_edge(std::int32_t cell) const {
    const auto& ends = kOpenEdge[corners_[cell]];
    return {cell + offset_[ends[0]], cell + offset_[ends[1]]};
  }
  // Cells that lie outside of the box around all points, whose open edges are edges of the box.
  bool is_outside(std::int32_t column, std::int32_t row) const {
    return column == 0 || row == 0 || column >= lattice_.columns() - 2 ||
           row >= lattice_.rows() - 2;
  }

  static constexpr std::int32_t kNoCell = -1;

  // The cell on whose sides or diagonal the edge lies, to the left of it; kNoCell if it lies
  // neither so, or on the diagonal of a cell with two corners.
  std::int32_t cell_left_of(Edge edge) const {
    const std::int32_t step = edge.to - edge.from, columns = lattice_.columns();
    if (step == 1) return edge.from;
    if (step == -1) return edge.to - columns;
    if (step == columns) return edge.from - 1;
    if (step == -columns) return edge.to;
    std::int32_t cell = kNoCell;
    if (step == columns + 1) cell = edge.from;
    if (step == -columns - 1) cell = edge.to;
    if (step == columns - 1) cell = edge.from - 1;
    if (step == 1 - columns) cell = edge.to - 1;
    return cell != kNoCell && has_triangle(cell) ? cell : kNoCell;
  }

  // The triangle of the cell that lies left of an edge of the cell; kNone if a hole does.
  int triangle_left_of(Edge edge, std::int32_t cell) const {
    if (!has_triangle(cell)) return kNone;
    if (!is_full(cell)) {
      const Edge open = open_edge(cell);
      return open.from == edge.from && open.to == edge.to ? kNone : 0;
    }
    const std::int32_t step = edge.to - edge.from, columns = lattice_.columns();
    return step == 1 || step == -columns || step == columns - 1 ? 0 : 1;
  }
  static constexpr int kNone = -1;

 private:
  static constexpr std::int8_t kSW = 0, kSE = 1, kNW = 2, kNE = 3;

  struct CornerTriangles {
    int count;
    std::int8_t corner[2][3];
  };
  // By the corners that are taken.
  static constexpr CornerTriangles kTriangles[16] = {{0, {}},
                                                     {0, {}},
                                                     {0, {}},
                                                     {0, {}},
                                                     {0, {}},
                                                     {0, {}},
                                                     {0, {}},
                                                     {1, {{kSW, kSE, kNW}}},
                                                     {0, {}},
                                                     {0, {}},
                                                     {0, {}},
                                                     {1, {{kSW, kSE, kNE}}},
                                                     {0, {}},
                                                     {1, {{kSW, kNE, kNW}}},
                                                     {1, {{kSE, kNE, kNW}}},
                                                     {2, {{kSW, kSE, kNW}, {kSE, kNE, kNW}}}};
  static constexpr std::int8_t kOpenEdge[16][2] = {
      {kNone, kNone}, {kNone, kNone}, {kNone, kNone}, {kSW, kSE},     // south
      {kNone, kNone}, {kNW, kSW},     {kNone, kNone}, {kNW, kSE},     // west; all but NE
      {kNone, kNone}, {kNone, kNone}, {kSE, kNE},     {kSW, kNE},     // east; all but NW
      {kNE, kNW},     {kNE, kSW},     {kSE, kNW},     {kNone, kNone}  // north; all but SE; but SW
  };

  void look_at_row(std::int32_t row) {
    const std::int32_t columns = lattice_.columns(), first = row * columns;
    if (row + 1 == lattice_.rows()) {
      std::fill_n(corners_.get() + first, columns, std::uint8_t{0});
      return;
    }
    std::int32_t count = 0, points = 0;
    unsigned west = 0;
    for (std::int32_t column = columns; column-- > 0;) {
      const std::int32_t place = first + column;
      const unsigned here =
          lattice_.is_taken(place) * corner::kSW | lattice_.is_taken(place + columns) * corner::kNW;
      const unsigned corners = here | west << 1;
      west = here;
      corners_[place] = static_cast<std::uint8_t>(corners);
      count += kTriangles[corners].count;
      points += corners & corner::kSW;
    }
    counts_[row] = count;
    points_[row] = points;
  }

  const Lattice& lattice_;
  ScratchArray<std::uint8_t> corners_;
  std::array<std::int32_t, 4> offset_;
  std::vector<std::int32_t> counts_;  // of certain triangles in a row of cells
  std::vector<std::int32_t> points_;  // of the places in a row that are taken
  std::int64_t certain_ = 0, taken_ = 0;
};

}  // namespace tinsmith
