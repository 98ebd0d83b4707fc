// Building the index: a counting sort into cells, then crowded cells into grids of their own.
//
// The sort takes two passes, each over memory that fits the cache: rows go to bands of
// neighbouring cells first, then each band is sorted by cell. Both passes are shared by threads
// and keep the order of the caller's rows within a cell, so the index does not depend on how many
// there are.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "../base/parallel.hpp"
#include "grid.hpp"
#include "nested_levels.hpp"

namespace tinsmith {

class GridBuilder {
 public:
  // A cell with more points than this gets a grid of its own: hardly any where points are even
  // (about 3 share the cell of a point), every fuller one where they are not.
  static constexpr std::int32_t kCrowdedIfEven = 16;
  static constexpr std::int32_t kCrowdedIfUneven = 6;
  static constexpr double kEven = 4.0;

  // Cells of a grid with more points than this are given grids of their own, by the sum of the
  // squares of the numbers in its cells.
  static std::int32_t crowd(double squares, std::int64_t count) {
    const double sharing = squares / static_cast<double>(count);
    return sharing < kEven ? kCrowdedIfEven : kCrowdedIfUneven;
  }

  GridBuilder(PointGrid& grid, const PointRows& rows, Team& team)
      : grid_(grid), rows_(rows), team_(team), parts_(team.size()) {}

  // Leaves the index unfinished if the team is stopped.
  void build() {
    const auto n = static_cast<std::int32_t>(rows_.count);
    grid_.count_ = n;
    grid_.x_ = padded(n);
    grid_.y_ = padded(n);
    grid_.rows_ = scratch_array<Row>(n);
    grid_.levels_.push_back(Level::fitted(box_of_rows(), 0, n, kPointsPerCell));
    if (!sort_into_cells() || !nest_top()) return;
    list_spans(0);
    drop_repeated();
  }

 private:
  // Rows between two questions whether to go on.
  static constexpr std::int32_t kPerQuestion = 1 << 20;
  // A band of so many points fits the second-level cache, in so many bands a page each of memory
  // stays at hand.
  static constexpr std::int64_t kPointsPerBand = 4096;
  static constexpr std::int64_t kMostBands = 1024;
  // Cells of the top level that a thread takes at a time.
  static constexpr std::int32_t kCellsPerBlock = 256;

  struct Entry {
    Point p;
    Row row;
    std::int32_t cell;
  };

  // What one thread finds out.
  struct alignas(kCacheLine) Part {
    Box box;
    std::vector<std::int32_t> band_end;    // while filling: where its next entry of a band goes
    std::vector<std::int32_t> full_cells;  // with more points than kCrowdedIfUneven
    double squares = 0.0;                  // of the numbers of points in its cells, summed up
  };

  static ScratchArray<double> padded(std::int32_t n) {
    ScratchArray<double> values = scratch_array<double>(n + std::size_t{PointGrid::kPadding});
    std::fill_n(values.get() + n, PointGrid::kPadding, 0.0);
    return values;
  }

  // ------------------------------------------------------------- the top level

  Box box_of_rows() {
    team_.run([this](int part) {
      const Range range = part_of(rows_.count, part, team_.size());
      Box box;
      for (std::int32_t i = range.begin; i < range.end; ++i) box.include(rows_[i]);
      parts_[part].box = box;
    });
    Box box;
    for (const Part& part : parts_) box.include(part.box);
    return box;
  }

  bool sort_into_cells() {
    const Level& top = grid_.levels_.front();
    const std::int64_t bands =
        std::clamp(rows_.count / kPointsPerBand, std::int64_t{1}, kMostBands);
    while ((top.cell_count() >> band_shift_) >= bands) ++band_shift_;
    bands_ = static_cast<std::int32_t>(((top.cell_count() - 1) >> band_shift_) + 1);
    grid_.start_.assign(top.cell_count() + 1, 0);
    grid_.start_.back() = grid_.count_;
    entries_ = streamed_array<Entry>(rows_.count);  // the output reuses its memory
    team_.run([this](int part) { count_bands(part); });
    const std::vector<std::int32_t> begins = begins_of_bands();
    team_.run([this](int part) { fill_bands(part); });
    if (team_.is_stopped()) return false;
    std::atomic<std::int32_t> next{0};
    team_.run([&](int part) {
      for (std::int32_t band = next++; band < bands_; band = next++) {
        if (!team_.keeps_going(part)) return;
        sort_band(band, {begins[band], begins[band + 1]}, parts_[part]);
      }
    });
    entries_.reset();
    return !team_.is_stopped();
  }

  void count_bands(int part) {
    const Level top = grid_.levels_.front();
    std::vector<std::int32_t> count(bands_, 0);
    const Range range = part_of(rows_.count, part, team_.size());
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      ++count[top.cell_at(rows_[i]) >> band_shift_];
    }
    parts_[part].band_end = std::move(count);
  }

  // Turns the counts of the parts into the places where each begins to fill each band.
  std::vector<std::int32_t> begins_of_bands() {
    std::vector<std::int32_t> begins;
    std::int32_t total = 0;
    for (std::int32_t band = 0; band < bands_; ++band) {
      begins.push_back(total);
      for (Part& part : parts_) {
        const std::int32_t count = part.band_end[band];
        part.band_end[band] = total;
        total += count;
      }
    }
    begins.push_back(total);
    return begins;
  }

  void fill_bands(int part) {
    const Level top = grid_.levels_.front();
    std::vector<std::int32_t>& end = parts_[part].band_end;
    const Range range = part_of(rows_.count, part, team_.size());
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      if (i % kPerQuestion == 0 && !team_.keeps_going(part)) return;
      const Point p = rows_[i];
      const std::int32_t cell = top.cell_at(p);
      entries_[end[cell >> band_shift_]++] = {p, static_cast<Row>(i), cell};
    }
  }

  void sort_band(std::int32_t band, Range held, Part& part) {
    const std::int64_t first = static_cast<std::int64_t>(band) << band_shift_;
    const std::int64_t last =
        std::min(first + (std::int64_t{1} << band_shift_), grid_.levels_.front().cell_count());
    std::int32_t* start = grid_.start_.data();
    const StoredPoints points = stored();
    for (std::int32_t i = held.begin; i < held.end; ++i) ++start[entries_[i].cell];
    std::int32_t total = held.begin;
    for (std::int64_t cell = first; cell < last; ++cell) {
      part.squares += static_cast<double>(start[cell]) * start[cell];
      total += start[cell];
      start[cell] = total;
    }
    for (std::int32_t i = held.end; i-- > held.begin;) {
      points.store(--start[entries_[i].cell], {entries_[i].p, entries_[i].row});
    }
    for (std::int64_t cell = first; cell < last; ++cell) {
      const std::int32_t begin = start[cell];
      const std::int32_t end = cell + 1 < last ? start[cell + 1] : held.end;
      if (end - begin > kCrowdedIfUneven) {
        part.full_cells.push_back(static_cast<std::int32_t>(cell));
      } else {
        points.sort_cell(begin, end);
      }
    }
  }

  StoredPoints stored() const { return {grid_.x_.get(), grid_.y_.get(), grid_.rows_.get()}; }

  // ------------------------------------------------------------- nested levels

  bool nest_top() {
    double squares = 0.0;
    std::vector<std::int32_t> cells;
    for (const Part& part : parts_) {
      squares += part.squares;
      cells.insert(cells.end(), part.full_cells.begin(), part.full_cells.end());
    }
    std::sort(cells.begin(), cells.end());
    const auto count = static_cast<std::int32_t>(cells.size());
    const std::int32_t block_count = (count + kCellsPerBlock - 1) / kCellsPerBlock;
    std::vector<NestedLevels> blocks(block_count,
                                     NestedLevels(stored(), crowd(squares, rows_.count)));
    std::atomic<std::int32_t> next{0};
    team_.run([&](int member) {
      for (std::int32_t block = next++; block < block_count; block = next++) {
        const Range own = part_of(count, block, block_count);
        const auto keep_going = [&] { return team_.keeps_going(member); };
        if (!blocks[block].nest_top(grid_.start_.data(), own, cells, keep_going)) return;
      }
    });
    if (team_.is_stopped()) return false;
    append(blocks);
    return true;
  }

  void append(const std::vector<NestedLevels>& blocks) {
    std::vector<NestedLevels::Inner> inner;
    for (const NestedLevels& block : blocks) {
      const std::int32_t first = block.append_to(grid_);
      for (const auto& [cell, level] : block.top()) inner.push_back({cell, first + level});
    }
    if (inner.empty()) return;
    Level& top = grid_.levels_.front();
    NestedLevels::list_children(top, inner, grid_.child_row_, grid_.children_);
  }

  // Which level the positions belong to, where that changes along the order.
  void list_spans(std::int32_t index) {
    const Level& level = grid_.levels_[index];
    grid_.spans_.push_back({level.begin, index});
    if (level.first_child_row == Level::kNoChildren) return;
    const std::int64_t first = grid_.child_row_[level.first_child_row];
    const std::int64_t last = grid_.child_row_[level.first_child_row + level.rows];
    for (std::int64_t i = first; i < last; ++i) {
      list_spans(grid_.children_[i].level);
      grid_.spans_.push_back({grid_.levels_[grid_.children_[i].level].end, index});
    }
  }

  // ------------------------------------------------------------- rows at one point

  bool repeats(std::int32_t i, std::int32_t earlier) const {
    return grid_.x_[i] == grid_.x_[earlier] && grid_.y_[i] == grid_.y_[earlier];
  }

  bool is_any_repeated() {
    std::vector<char> found(team_.size(), 0);
    team_.run([&](int part) {
      const Range range = part_of(grid_.count_, part, team_.size());
      std::int32_t repeated = 0;
      for (std::int32_t i = std::max(range.begin, 1); i < range.end; ++i) {
        repeated += repeats(i, i - 1);
      }
      found[part] = repeated > 0;
    });
    return std::find(found.begin(), found.end(), 1) != found.end();
  }

  void drop_repeated() {
    if (!is_any_repeated()) return;
    const std::int32_t n = grid_.count_;
    grid_.kept_row_.resize(n);
    std::vector<std::int32_t> position(n + 1);  // of the kept point at or after an old position
    std::int32_t kept = 0;
    const StoredPoints points = stored();
    for (std::int32_t i = 0; i < n; ++i) {
      // Compared with the last kept: places below i may be overwritten already.
      const bool is_repeated = i > 0 && repeats(i, kept - 1);
      position[i] = kept;
      if (!is_repeated) points.store(kept++, points.entry(i));
      grid_.kept_row_[number(grid_.rows_[i])] = number(grid_.rows_[kept - 1]);
    }
    position[n] = kept;
    for (auto& start : grid_.start_) start = position[start];
    for (auto& span : grid_.spans_) span.begin = position[span.begin];
    for (auto& level : grid_.levels_) {
      level.begin = position[level.begin];
      level.end = position[level.end];
    }
    grid_.count_ = kept;
    count_kept_rows_only();
  }

  void count_kept_rows_only() {
    const std::int32_t n = static_cast<std::int32_t>(rows_.count);
    std::vector<std::int32_t> number_of(n);
    std::int32_t next = 0;
    for (std::int32_t row = 0; row < n; ++row) {
      number_of[row] = next;
      if (grid_.kept_row_[row] == row) ++next;
    }
    for (std::int32_t i = 0; i < grid_.count_; ++i) {
      grid_.rows_[i] = static_cast<Row>(number_of[number(grid_.rows_[i])]);
    }
  }

  PointGrid& grid_;
  const PointRows& rows_;
  Team& team_;
  std::vector<Part> parts_;
  StreamedArray<Entry> entries_;  // by band
  int band_shift_ = 0;            // cell >> band_shift_ is the band
  std::int32_t bands_ = 1;
};

// Rows at the point of another must not show in the order of the sweep: where there are any, the
// index is built of the distinct points alone.
inline PointGrid::PointGrid(const PointRows& rows, Team& team) {
  GridBuilder(*this, rows, team).build();
  if (kept_row_.empty() || team.is_stopped()) return;
  std::vector<Point> points(count_);
  for (std::int32_t i = 0; i < count_; ++i) {
    points[number(rows_[i])] = point(static_cast<Vertex>(i));
  }
  std::vector<std::int32_t> kept_row = std::move(kept_row_);
  drop_cells();
  x_.reset();
  y_.reset();
  rows_.reset();
  *this = PointGrid({&points[0].x, count_, 2}, team);
  kept_row_ = std::move(kept_row);
}

}  // namespace tinsmith
