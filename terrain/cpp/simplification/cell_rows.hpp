// The cells of a raster that a triangle between cells holds, row by row: scan conversion in whole
// numbers, so that each cell is found exactly; those on edges belong to the triangles on both sides.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace tinsmith {

// A cell, by its column and row.
struct Cell {
  std::int32_t column, row;
};

// Twice the area of three cells; positive if they run counter-clockwise where rows run north.
inline std::int64_t twice_area_of(Cell a, Cell b, Cell c) {
  return std::int64_t{b.column - a.column} * (c.row - a.row) -
         std::int64_t{c.column - a.column} * (b.row - a.row);
}

// Where a line through two cells crosses each row, rounded down to a column: by adding up
// (J. E. Bresenham, "Algorithm for computer control of a digital plotter", 1965).
class RowCrossings {
 public:
  // From the first row of the two on; `sign` is 1, or -1 for minus the columns.
  RowCrossings(Cell from, Cell to, std::int32_t sign)
      : rows_(to.row - from.row), column_(sign * from.column) {
    const std::int32_t run = sign * (to.column - from.column);
    step_ = run / rows_;
    rest_ = run % rows_;
    if (rest_ < 0) {
      rest_ += rows_;
      --step_;
    }
  }

  std::int32_t column() const { return column_; }
  void advance() {
    sum_ += rest_;
    const bool is_over = sum_ >= rows_;
    sum_ -= is_over ? rows_ : 0;
    column_ += step_ + is_over;
  }

 private:
  std::int32_t rows_, column_, step_ = 0, rest_ = 0, sum_ = 0;
};

// Neighbouring cells of a row, both columns included.
struct CellRow {
  std::int32_t row, first, last;
};

// The cells of a triangle, from its southern corner on.
class CellRows {
 public:
  void list(Cell a, Cell b, Cell c) {
    end_ = rows_.data();
    if (b.row < a.row) std::swap(a, b);
    if (c.row < b.row) std::swap(b, c);
    if (b.row < a.row) std::swap(a, b);
    if (a.row == c.row) return;
    const auto most = static_cast<std::size_t>(c.row - a.row + 1);
    if (rows_.size() < most) rows_.resize(2 * most);
    end_ = rows_.data();
    const bool is_middle_east = twice_area_of(a, c, b) < 0;
    RowCrossings along(a, c, is_middle_east ? -1 : 1);  // rounded up where it is the western side
    if (a.row < b.row) add(a, b, b.row < c.row ? b.row : c.row + 1, is_middle_east, along);
    if (b.row < c.row) add(b, c, c.row + 1, is_middle_east, along);
  }

  const CellRow* begin() const { return rows_.data(); }
  const CellRow* end() const { return end_; }

 private:
  void add(Cell from, Cell to, std::int32_t end, bool is_east, RowCrossings& along) {
    RowCrossings beside(from, to, is_east ? 1 : -1);
    for (std::int32_t row = from.row; row < end; ++row) {
      const std::int32_t first = is_east ? -along.column() : -beside.column();
      const std::int32_t last = is_east ? beside.column() : along.column();
      *end_ = {row, first, last};
      end_ += first <= last;
      along.advance();
      beside.advance();
    }
  }

  std::vector<CellRow> rows_;
  CellRow* end_ = nullptr;
};

}  // namespace tinsmith
