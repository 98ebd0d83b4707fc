// Index: points bucketed into square cells of about two, stored row of cells by row of cells.
//
// Cells after Bentley, Weide and Yao, "Optimal expected-time algorithms for closest point problems"
// (1980); crowded ones are divided again.
//
// The storage order is the sweep order. A cell that is crowded holds a grid of its own, fitted to
// its points, and so on: the index adapts to clusters, tracks and contour lines, and is a plain
// grid where the points are even. Within a cell points are sorted by easting, then northing, so
// the order is a function of the point set, and rows at one point stand together.
//
//      +----+----+----+----+        a level: columns x rows of square cells
//      | .  |. . |  . | .  |
//      +----+----+----+----+        the points of cell (r, c) are stored from
//      |  . |::::| .  |  . |        start(r, c) to start(r, c + 1); a row is one run
//      +----+----+----+----+
//      | .  | .  | .  |.  .|        ::::  a crowded cell: a level of its own inside
//      +----+----+----+----+
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../base/point.hpp"

namespace tinsmith {

// One grid of the index. The cell of a point is monotone in x and in y, so the cells of a box's
// corners bound the cells of all points in it.
struct Level {
  Box box;  // fits the points
  double cell_size, per_cell;
  std::int32_t columns, rows;
  std::int32_t begin, end;   // positions of its points
  std::int64_t first_start;  // its (rows * columns + 1) starts in the common list
  std::int64_t first_child_row = kNoChildren;

  static constexpr std::int64_t kNoChildren = -1;

  // Square cells, `points_per_cell` on average, never more columns or rows than cells.
  static Level fitted(const Box& box, std::int32_t begin, std::int32_t end,
                      double points_per_cell) {
    Level level{};
    level.box = box;
    level.begin = begin;
    level.end = end;
    const double width = box.width(), height = box.height();
    const double cells = std::max(1.0, (end - begin) / points_per_cell);
    level.cell_size =
        std::max({std::sqrt(width / cells) * std::sqrt(height), width / cells, height / cells});
    if (!(level.cell_size > 0.0)) level.cell_size = 1.0;
    level.per_cell = 1.0 / level.cell_size;
    level.columns = 1 + static_cast<std::int32_t>(width * level.per_cell);
    level.rows = 1 + static_cast<std::int32_t>(height * level.per_cell);
    level.first_child_row = kNoChildren;
    return level;
  }

  std::int32_t column_at(double x) const { return clamped((x - box.west) * per_cell, columns); }
  std::int32_t row_at(double y) const { return clamped((y - box.south) * per_cell, rows); }
  std::int32_t cell_at(Point p) const { return row_at(p.y) * columns + column_at(p.x); }
  std::int64_t cell_count() const { return static_cast<std::int64_t>(columns) * rows; }

 private:
  static std::int32_t clamped(double cell, std::int32_t count) {
    if (!(cell > 0.0)) return 0;
    return cell < count ? static_cast<std::int32_t>(cell) : count - 1;
  }
};

// On average, where a level is fitted to points.
constexpr double kPointsPerCell = 2.0;

class PointGrid {
 public:
  PointGrid(const PointRows& rows, Team& team);

  std::int32_t count() const { return count_; }
  Point point(Vertex v) const { return {x_[number(v)], y_[number(v)]}; }
  const double* x() const { return x_.get(); }  // kPadding more may be read, of any value
  const double* y() const { return y_.get(); }
  // The caller's row of each position; repeated rows are not counted.
  const Row* rows() const { return rows_.get(); }

  // Keep the points, their order and box, and give up the cells: nothing can be searched any more.
  void drop_cells() {
    levels_.resize(1);
    free_memory(start_);
    free_memory(child_row_);
    free_memory(children_);
    free_memory(spans_);
  }

  // For each input row the first row at its point; empty if no two rows share one.
  const std::vector<std::int32_t>& kept_row() const { return kept_row_; }

  // Vector loads may begin at any position, one or two at once: so many doubles.
  static constexpr std::int32_t kPadding = 16;

  const Level& top() const { return levels_.front(); }
  bool is_plain() const { return levels_.size() == 1; }

  // The innermost level that holds each of ascending positions.
  class LevelCursor {
   public:
    LevelCursor(const PointGrid& grid, std::int32_t position) : grid_(&grid) {
      const auto after = std::upper_bound(
          grid.spans_.begin(), grid.spans_.end(), position,
          [](std::int32_t sought, const Span& span) { return sought < span.begin; });
      next_ = static_cast<std::size_t>(after - grid.spans_.begin());
    }

    const Level& at(std::int32_t position) {
      const std::vector<Span>& spans = grid_->spans_;
      while (next_ < spans.size() && spans[next_].begin <= position) ++next_;
      return grid_->levels_[spans[next_ - 1].level];
    }

   private:
    const PointGrid* grid_;
    std::size_t next_;
  };

  // First position of a cell of a level; the cell after the last of a row begins the next row.
  std::int32_t start(const Level& level, std::int32_t row, std::int32_t column) const {
    return start_[level.first_start + static_cast<std::int64_t>(row) * level.columns + column];
  }

  // Visit runs of positions that hold all points of the region among `those`: visit(begin, end).
  // A region has a box, and narrows it for one row: narrow(south, north, west, east). Returns the
  // number of rows of cells looked at.
  template <typename Region, typename Visit>
  std::int64_t for_each_run(const Region& region, Range those, Visit&& visit) const {
    if (those.begin >= those.end) return 0;
    const Box& box = region.box();
    const std::int32_t first = std::max(top().row_at(box.south), row_of(those.begin));
    const std::int32_t last = std::min(top().row_at(box.north), row_of(those.end - 1));
    return visit_level(top(), first, last, region, those, visit);
  }

  // Row of cells of the top level that holds a position; ascends with the positions.
  std::int32_t row_of(std::int32_t position) const { return top().row_at(y_[position]); }

  // Narrowing a row costs more than it saves where a box spans few columns.
  static constexpr std::int32_t kNarrowColumns = 4;

 private:
  struct Span {
    std::int32_t begin;
    std::int32_t level;
  };
  struct Child {
    std::int32_t column;
    std::int32_t level;
  };
  friend class GridBuilder;
  friend class NestedLevels;

  template <typename Region, typename Visit>
  std::int64_t visit_level(const Level& level, std::int32_t first_row, std::int32_t last_row,
                           const Region& region, Range those, Visit& visit) const {
    const Box& box = region.box();
    std::int64_t looked_at = std::max(0, last_row - first_row + 1);
    for (std::int32_t row = first_row; row <= last_row; ++row) {
      double west = box.west, east = box.east;
      std::int32_t first = level.column_at(west), last = level.column_at(east);
      if (last - first >= kNarrowColumns) {
        const double south = level.box.south + row * level.cell_size;
        const double north = std::min(south + level.cell_size, level.box.north);
        if (!region.narrow(south, north, west, east)) continue;
        first = level.column_at(west);
        last = level.column_at(east);
      }
      if (level.first_child_row != Level::kNoChildren) {
        looked_at += visit_row_with_children(level, row, first, last, region, those, visit);
      } else {
        visit_run(start(level, row, first), start(level, row, last + 1), those, visit);
      }
    }
    return looked_at;
  }

  template <typename Region, typename Visit>
  std::int64_t visit_row_with_children(const Level& level, std::int32_t row, std::int32_t first,
                                       std::int32_t last, const Region& region, Range those,
                                       Visit& visit) const {
    std::int64_t looked_at = 0;
    std::int32_t begin = start(level, row, first);
    const Child* child = children_.data() + child_row_[level.first_child_row + row];
    const Child* end = children_.data() + child_row_[level.first_child_row + row + 1];
    child = std::lower_bound(child, end, first,
                             [](const Child& c, std::int32_t column) { return c.column < column; });
    for (; child != end && child->column <= last; ++child) {
      const Level& inner = levels_[child->level];
      visit_run(begin, inner.begin, those, visit);
      begin = inner.end;
      ++looked_at;
      double west = inner.box.west, east = inner.box.east;
      if (inner.end > those.begin && inner.begin < those.end && inner.box.meets(region.box()) &&
          region.narrow(inner.box.south, inner.box.north, west, east)) {
        looked_at += visit_level(inner, inner.row_at(region.box().south),
                                 inner.row_at(region.box().north), region, those, visit);
      }
    }
    visit_run(begin, start(level, row, last + 1), those, visit);
    return looked_at;
  }

  template <typename Visit>
  static void visit_run(std::int32_t begin, std::int32_t end, Range those, Visit& visit) {
    begin = std::max(begin, those.begin);
    end = std::min(end, those.end);
    if (begin < end) visit(begin, end);
  }

  std::int32_t count_ = 0;
  ScratchArray<double> x_, y_;
  ScratchArray<Row> rows_;
  std::vector<Level> levels_;            // the first holds all points
  std::vector<std::int32_t> start_;      // of the cells of every level
  std::vector<std::int64_t> child_row_;  // for each row of a level with children: its first child
  std::vector<Child> children_;          // by column within a row
  std::vector<Span> spans_;              // by position
  std::vector<std::int32_t> kept_row_;
};

}  // namespace tinsmith

#include "grid_builder.hpp"
