// Grids of their own for crowded cells, and the order of points within all others.
//
// Cells of the top level are nested block by block, by any thread: what is in one does not depend
// on the others. The levels of a block are numbered from 0; they are appended to the index in the
// order of the blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/point.hpp"
#include "grid.hpp"

namespace tinsmith {

// The points of the index, where they are stored.
struct StoredPoints {
  struct Entry {
    Point p;
    Row row;
  };

  double* x;
  double* y;
  Row* rows;

  Entry entry(std::int32_t position) const { return {{x[position], y[position]}, rows[position]}; }
  void store(std::int32_t position, const Entry& entry) const {
    x[position] = entry.p.x;
    y[position] = entry.p.y;
    rows[position] = entry.row;
  }

  std::vector<Entry> copy(std::int32_t begin, std::int32_t end) const {
    std::vector<Entry> entries;
    entries.reserve(end - begin);
    for (std::int32_t i = begin; i < end; ++i) entries.push_back(entry(i));
    return entries;
  }

  // Insertion sort for the usual cell; stable, so rows at one point stay in the caller's order.
  void sort_cell(std::int32_t begin, std::int32_t end) const {
    if (end - begin > kShort) return sort_long_cell(begin, end);
    for (std::int32_t i = begin + 1; i < end; ++i) {
      const Entry moving = entry(i);
      std::int32_t j = i;
      for (; j > begin && lexicographically_before(moving.p, entry(j - 1).p); --j) {
        store(j, entry(j - 1));
      }
      if (j < i) store(j, moving);
    }
  }

 private:
  static constexpr std::int32_t kShort = 32;

  void sort_long_cell(std::int32_t begin, std::int32_t end) const {
    std::vector<Entry> entries = copy(begin, end);
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return lexicographically_before(a.p, b.p);
    });
    for (std::int32_t i = begin; i < end; ++i) store(i, entries[i - begin]);
  }
};

class NestedLevels {
 public:
  // A cell with more points than `crowded` gets a level.
  NestedLevels(StoredPoints points, std::int32_t crowded) : points_(points), crowded_(crowded) {}

  struct Inner {
    std::int64_t cell;
    std::int32_t level;
  };

  // Sort the points of cells of the top level, whose `starts` they are, or give them a level.
  // Returns false if `keep_going` did.
  template <typename KeepGoing>
  bool nest_top(const std::int32_t* starts, Range cells, const std::vector<std::int32_t>& listed,
                KeepGoing&& keep_going) {
    for (std::int32_t i = cells.begin; i < cells.end; ++i) {
      const std::int32_t cell = listed[i];
      if (!give_level(starts[cell], starts[cell + 1], 0)) continue;
      top_.push_back({cell, last_level()});
      if (!nest(last_level(), 1, keep_going)) return false;
    }
    return keep_going();
  }

  // The cells of the top level that have one.
  const std::vector<Inner>& top() const { return top_; }

  // The rows of a level's children, ascending by cell, at the end of both lists.
  static void list_children(Level& level, const std::vector<Inner>& inner,
                            std::vector<std::int64_t>& child_row,
                            std::vector<PointGrid::Child>& children) {
    level.first_child_row = static_cast<std::int64_t>(child_row.size());
    std::size_t next = 0;
    for (std::int32_t row = 0; row < level.rows; ++row) {
      child_row.push_back(static_cast<std::int64_t>(children.size()));
      for (; next < inner.size() && inner[next].cell / level.columns == row; ++next) {
        const auto column = static_cast<std::int32_t>(inner[next].cell % level.columns);
        children.push_back({column, inner[next].level});
      }
    }
    child_row.push_back(static_cast<std::int64_t>(children.size()));
  }

  // Returns the number that level 0 has in the index.
  std::int32_t append_to(PointGrid& grid) const {
    const auto first_level = static_cast<std::int32_t>(grid.levels_.size());
    const auto first_start = static_cast<std::int64_t>(grid.start_.size());
    const auto first_row = static_cast<std::int64_t>(grid.child_row_.size());
    const auto first_child = static_cast<std::int64_t>(grid.children_.size());
    for (Level level : levels_) {
      level.first_start += first_start;
      if (level.first_child_row != Level::kNoChildren) level.first_child_row += first_row;
      grid.levels_.push_back(level);
    }
    grid.start_.insert(grid.start_.end(), start_.begin(), start_.end());
    for (const std::int64_t row : child_row_) grid.child_row_.push_back(row + first_child);
    for (const PointGrid::Child child : children_) {
      grid.children_.push_back({child.column, child.level + first_level});
    }
    return first_level;
  }

 private:
  // Each level divides its box by the number of its points; what is crowded still is at points
  // closer together than any survey's, and is searched as one cell.
  static constexpr int kDeepest = 12;
  // Cells between two questions whether to go on.
  static constexpr std::int32_t kPerQuestion = 1 << 16;

  std::int32_t last_level() const { return static_cast<std::int32_t>(levels_.size()) - 1; }

  // The level itself, then those in its cells: so siblings stand together.
  template <typename KeepGoing>
  bool nest(std::int32_t index, int depth, KeepGoing&& keep_going) {
    const Level level = levels_[index];
    std::vector<Inner> inner;
    for (std::int64_t cell = 0; cell < level.cell_count(); ++cell) {
      if (++nested_ % kPerQuestion == 0 && !keep_going()) return false;
      const std::int32_t begin = start_[level.first_start + cell];
      const std::int32_t end = start_[level.first_start + cell + 1];
      if (give_level(begin, end, depth)) inner.push_back({cell, last_level()});
    }
    if (inner.empty()) return true;
    list_children(levels_[index], inner, child_row_, children_);
    for (const Inner& child : inner) {
      if (!nest(child.level, depth + 1, keep_going)) return false;
    }
    return true;
  }

  // False if the points of a cell are few or cannot be spread: then they are sorted.
  bool give_level(std::int32_t begin, std::int32_t end, int depth) {
    if (end - begin > crowded_ && depth < kDeepest && spread(begin, end)) return true;
    points_.sort_cell(begin, end);
    return false;
  }

  // Put the points of a cell into a level of their own; false if they are all at one point.
  bool spread(std::int32_t begin, std::int32_t end) {
    const std::vector<StoredPoints::Entry> entries = points_.copy(begin, end);
    Box box;
    for (const StoredPoints::Entry& e : entries) box.include(e.p);
    if (box.west == box.east && box.south == box.north) return false;
    Level level = Level::fitted(box, begin, end, kPointsPerCell);
    level.first_start = static_cast<std::int64_t>(start_.size());
    start_.resize(start_.size() + level.cell_count() + 1, 0);
    std::int32_t* first = start_.data() + level.first_start;
    for (const StoredPoints::Entry& e : entries) ++first[level.cell_at(e.p)];
    std::int32_t total = begin;
    for (std::int64_t cell = 0; cell <= level.cell_count(); ++cell) {
      total += first[cell];
      first[cell] = total;
    }
    for (std::size_t i = entries.size(); i-- > 0;) {
      points_.store(--first[level.cell_at(entries[i].p)], entries[i]);
    }
    levels_.push_back(level);
    return true;
  }

  StoredPoints points_;
  std::int32_t crowded_;
  std::int32_t nested_ = 0;  // cells looked at
  std::vector<Inner> top_;
  std::vector<Level> levels_;  // as in the index, counted from 0
  std::vector<std::int32_t> start_;
  std::vector<std::int64_t> child_row_;
  std::vector<PointGrid::Child> children_;
};

}  // namespace tinsmith
