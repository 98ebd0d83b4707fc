// Building the index: counting sort into cells, crowded cells into grids of their own.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "grid.hpp"

namespace tinsmith {

class GridBuilder {
 public:
  GridBuilder(PointGrid& grid, const PointRows& rows) : grid_(grid), rows_(rows) {}

  void build() {
    bucket_rows();
    crowded_ = sharing() < kEven ? kCrowdedIfEven : kCrowdedIfUneven;
    nest(0, 0);
    list_spans(0);
    drop_repeated();
  }

 private:
  static constexpr double kPointsPerCell = 2.0;
  // A cell with more points than this gets a grid of its own: hardly any where points are even
  // (about 3 share the cell of a point), every fuller one where they are not.
  static constexpr std::int32_t kCrowdedIfEven = 16;
  static constexpr std::int32_t kCrowdedIfUneven = 6;
  static constexpr double kEven = 4.0;
  // Cells up to here are sorted by insertion.
  static constexpr std::int32_t kShort = 32;
  // Each level divides its box by the number of its points; what is crowded still is at places
  // closer together than any survey's, and is searched as one cell.
  static constexpr int kDeepest = 12;

  struct Entry {
    Point p;
    Row row;
  };

  void bucket_rows() {
    const auto n = static_cast<std::size_t>(rows_.count);
    Box box{rows_[0].x, rows_[0].x, rows_[0].y, rows_[0].y};
    for (std::size_t i = 1; i < n; ++i) extend(box, rows_[static_cast<std::int64_t>(i)]);
    Level level =
        Level::fitted(box, 0, static_cast<std::int32_t>(n), kPointsPerCell);
    level.first_start = 0;
    std::vector<std::int32_t> cell_of(n);
    auto& start = grid_.start_;
    start.assign(level.cell_count() + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
      cell_of[i] = level.cell_at(rows_[static_cast<std::int64_t>(i)]);
      ++start[cell_of[i]];
    }
    ends_from_counts(0);
    grid_.x_.resize(n);
    grid_.y_.resize(n);
    grid_.rows_.resize(n);
    for (std::size_t i = n; i-- > 0;) {
      store(--start[cell_of[i]], {rows_[static_cast<std::int64_t>(i)], static_cast<Row>(i)});
    }
    grid_.levels_.push_back(level);
  }

  // How many points share the cell of a point, on average.
  double sharing() const {
    double squares = 0.0;
    for (std::size_t cell = 0; cell + 1 < grid_.start_.size(); ++cell) {
      const double held = grid_.start_[cell + 1] - grid_.start_[cell];
      squares += held * held;
    }
    return squares / static_cast<double>(rows_.count);
  }

  static void extend(Box& box, Point p) {
    box.west = std::min(box.west, p.x);
    box.east = std::max(box.east, p.x);
    box.south = std::min(box.south, p.y);
    box.north = std::max(box.north, p.y);
  }

  // Turn counts, from `first` on, into ends; filling backwards turns ends into begins.
  void ends_from_counts(std::int64_t first, std::int32_t total = 0) {
    for (std::size_t i = first; i < grid_.start_.size(); ++i) {
      total += grid_.start_[i];
      grid_.start_[i] = total;
    }
  }

  void store(std::int32_t position, const Entry& entry) {
    grid_.x_[position] = entry.p.x;
    grid_.y_[position] = entry.p.y;
    grid_.rows_[position] = entry.row;
  }
  Entry entry(std::int32_t position) const {
    return {{grid_.x_[position], grid_.y_[position]}, grid_.rows_[position]};
  }

  // Sort the small cells of a level and give the crowded ones a level each.
  void nest(std::int32_t index, int depth) {
    const Level level = grid_.levels_[index];
    std::vector<std::pair<std::int64_t, std::int32_t>> inner;  // cell, level
    for (std::int64_t cell = 0; cell < level.cell_count(); ++cell) {
      const std::int32_t begin = grid_.start_[level.first_start + cell];
      const std::int32_t end = grid_.start_[level.first_start + cell + 1];
      if (end - begin > crowded_ && depth < kDeepest && spread(begin, end)) {
        inner.emplace_back(cell, static_cast<std::int32_t>(grid_.levels_.size()) - 1);
      } else {
        sort_cell(begin, end);
      }
    }
    if (inner.empty()) return;
    list_children(index, inner);
    for (const auto& [cell, child] : inner) nest(child, depth + 1);
  }

  // Put the points of a cell into a level of their own; false if they are all at one place.
  bool spread(std::int32_t begin, std::int32_t end) {
    const std::vector<Entry> entries = copy(begin, end);
    Box box{entries[0].p.x, entries[0].p.x, entries[0].p.y, entries[0].p.y};
    for (const Entry& e : entries) extend(box, e.p);
    if (box.west == box.east && box.south == box.north) return false;
    Level level = Level::fitted(box, begin, end, kPointsPerCell);
    auto& start = grid_.start_;
    level.first_start = static_cast<std::int64_t>(start.size());
    start.resize(start.size() + level.cell_count() + 1, 0);
    std::int32_t* first = start.data() + level.first_start;
    for (const Entry& e : entries) ++first[level.cell_at(e.p)];
    ends_from_counts(level.first_start, begin);
    for (std::size_t i = entries.size(); i-- > 0;) {
      store(--first[level.cell_at(entries[i].p)], entries[i]);
    }
    grid_.levels_.push_back(level);
    return true;
  }

  std::vector<Entry> copy(std::int32_t begin, std::int32_t end) const {
    std::vector<Entry> entries;
    entries.reserve(end - begin);
    for (std::int32_t i = begin; i < end; ++i) entries.push_back(entry(i));
    return entries;
  }

  void list_children(std::int32_t index,
                     const std::vector<std::pair<std::int64_t, std::int32_t>>& inner) {
    Level& level = grid_.levels_[index];
    level.first_child_row = static_cast<std::int64_t>(grid_.child_row_.size());
    std::size_t next = 0;
    for (std::int32_t row = 0; row < level.rows; ++row) {
      grid_.child_row_.push_back(static_cast<std::int64_t>(grid_.children_.size()));
      for (; next < inner.size() && inner[next].first / level.columns == row; ++next) {
        const auto column = static_cast<std::int32_t>(inner[next].first % level.columns);
        grid_.children_.push_back({column, inner[next].second});
      }
    }
    grid_.child_row_.push_back(static_cast<std::int64_t>(grid_.children_.size()));
  }

  // Insertion sort for the usual cell; stable, so rows at one place stay in the caller's order.
  void sort_cell(std::int32_t begin, std::int32_t end) {
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

  void sort_long_cell(std::int32_t begin, std::int32_t end) {
    std::vector<Entry> entries = copy(begin, end);
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return lexicographically_before(a.p, b.p);
    });
    for (std::int32_t i = begin; i < end; ++i) store(i, entries[i - begin]);
  }

  // Where the size of the cells changes along the order.
  void list_spans(std::int32_t index) {
    const Level& level = grid_.levels_[index];
    grid_.spans_.push_back({level.begin, level.cell_size});
    if (level.first_child_row == Level::kNoChildren) return;
    const std::int64_t first = grid_.child_row_[level.first_child_row];
    const std::int64_t last = grid_.child_row_[level.first_child_row + level.rows];
    for (std::int64_t i = first; i < last; ++i) {
      list_spans(grid_.children_[i].level);
      grid_.spans_.push_back({grid_.levels_[grid_.children_[i].level].end, level.cell_size});
    }
  }

  // ------------------------------------------------------------- rows at one place

  bool repeats_previous(std::size_t i) const {
    return grid_.x_[i] == grid_.x_[i - 1] && grid_.y_[i] == grid_.y_[i - 1];
  }

  void drop_repeated() {
    const std::size_t n = grid_.x_.size();
    std::size_t repeated = 0;
    for (std::size_t i = 1; i < n; ++i) repeated += repeats_previous(i);
    if (repeated == 0) return;
    grid_.kept_row_.resize(n);
    std::vector<std::int32_t> position(n + 1);  // of the kept point at or after an old position
    std::int32_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const bool repeats = i > 0 && repeats_previous_kept(i, kept);
      position[i] = kept;
      if (!repeats) store(kept++, entry(static_cast<std::int32_t>(i)));
      grid_.kept_row_[number(grid_.rows_[i])] = number(grid_.rows_[kept - 1]);
    }
    position[n] = kept;
    for (auto& start : grid_.start_) start = position[start];
    for (auto& span : grid_.spans_) span.begin = position[span.begin];
    for (auto& level : grid_.levels_) {
      level.begin = position[level.begin];
      level.end = position[level.end];
    }
    grid_.x_.resize(kept);
    grid_.y_.resize(kept);
    grid_.rows_.resize(kept);
  }

  // The kept point before place `kept` is compared: places below i may be overwritten already.
  bool repeats_previous_kept(std::size_t i, std::int32_t kept) const {
    return grid_.x_[i] == grid_.x_[kept - 1] && grid_.y_[i] == grid_.y_[kept - 1];
  }

  PointGrid& grid_;
  const PointRows& rows_;
  std::int32_t crowded_ = kCrowdedIfEven;
};

inline PointGrid::PointGrid(const PointRows& rows) { GridBuilder(*this, rows).build(); }

}  // namespace tinsmith
