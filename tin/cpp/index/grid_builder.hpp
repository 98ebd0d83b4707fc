// Building the index: a counting sort into cells, then crowded cells into grids of their own.
//
// The sort takes two passes, each over memory that fits the cache: rows go to bands of
// neighbouring cells first, then each band is sorted by cell. Both passes are shared by threads
// and keep the order of the caller's rows within a cell, so the index does not depend on how many
// there are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/parallel.hpp"
#include "grid.hpp"

namespace tinsmith {

class GridBuilder {
 public:
  static constexpr double kPointsPerCell = 2.0;
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
  // Cells up to here are sorted by insertion.
  static constexpr std::int32_t kShort = 32;
  // Each level divides its box by the number of its points; what is crowded still is at points
  // closer together than any survey's, and is searched as one cell.
  static constexpr int kDeepest = 12;
  // Rows between two questions whether to go on.
  static constexpr std::int32_t kPerQuestion = 1 << 20;
  // A band of so many points fits the second-level cache, in so many bands a page each of memory
  // stays at hand.
  static constexpr std::int64_t kPointsPerBand = 4096;
  static constexpr std::int64_t kMostBands = 1024;

  struct Entry {
    Point p;
    Row row;
    std::int32_t cell;
  };

  // What one thread finds out.
  struct alignas(kCacheLine) Part {
    Box box;
    std::vector<std::int32_t> band_end;    // while filling: where its next entry of a band goes
    std::vector<std::int32_t> full_cells;  // with more points than kCrowdedIfUneven, ascending
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
    team_.run([&](int part) {
      const Range own = part_of(bands_, part, team_.size());
      for (std::int32_t band = own.begin; band < own.end; ++band) {
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
    for (std::int32_t i = held.begin; i < held.end; ++i) ++start[entries_[i].cell];
    std::int32_t total = held.begin;
    for (std::int64_t cell = first; cell < last; ++cell) {
      part.squares += static_cast<double>(start[cell]) * start[cell];
      total += start[cell];
      start[cell] = total;
    }
    for (std::int32_t i = held.end; i-- > held.begin;) {
      store(--start[entries_[i].cell], entries_[i]);
    }
    for (std::int64_t cell = first; cell < last; ++cell) {
      const std::int32_t begin = start[cell];
      const std::int32_t end = cell + 1 < last ? start[cell + 1] : held.end;
      if (end - begin > kCrowdedIfUneven) {
        part.full_cells.push_back(static_cast<std::int32_t>(cell));
      } else {
        sort_cell(begin, end);
      }
    }
  }

  void store(std::int32_t position, const Entry& entry) {
    grid_.x_[position] = entry.p.x;
    grid_.y_[position] = entry.p.y;
    grid_.rows_[position] = entry.row;
  }
  Entry entry(std::int32_t position) const {
    return {{grid_.x_[position], grid_.y_[position]}, grid_.rows_[position], 0};
  }

  // ------------------------------------------------------------- nested levels

  bool nest_top() {
    double squares = 0.0;
    for (const Part& part : parts_) squares += part.squares;
    crowded_ = crowd(squares, rows_.count);
    std::vector<std::int64_t> cells;
    for (const Part& part : parts_) {
      cells.insert(cells.end(), part.full_cells.begin(), part.full_cells.end());
    }
    nest(0, 0, cells);
    return !team_.is_stopped();
  }

  void nest_all(std::int32_t index, int depth) {
    std::vector<std::int64_t> cells(grid_.levels_[index].cell_count());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      cells[cell] = static_cast<std::int64_t>(cell);
    }
    nest(index, depth, cells);
  }

  bool keeps_nesting() {
    return ++nested_ % kPerQuestion == 0 ? team_.keeps_going(0) : !team_.is_stopped();
  }

  // Sort the given cells of a level, but give the crowded ones a level each.
  void nest(std::int32_t index, int depth, const std::vector<std::int64_t>& cells) {
    const Level level = grid_.levels_[index];
    std::vector<std::pair<std::int64_t, std::int32_t>> inner;  // cell, level
    for (const std::int64_t cell : cells) {
      if (!keeps_nesting()) return;
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
    for (const auto& [cell, child] : inner) nest_all(child, depth + 1);
  }

  // Put the points of a cell into a level of their own; false if they are all at one point.
  bool spread(std::int32_t begin, std::int32_t end) {
    const std::vector<Entry> entries = copy(begin, end);
    Box box;
    for (const Entry& e : entries) box.include(e.p);
    if (box.west == box.east && box.south == box.north) return false;
    Level level = Level::fitted(box, begin, end, kPointsPerCell);
    auto& start = grid_.start_;
    level.first_start = static_cast<std::int64_t>(start.size());
    start.resize(start.size() + level.cell_count() + 1, 0);
    std::int32_t* first = start.data() + level.first_start;
    for (const Entry& e : entries) ++first[level.cell_at(e.p)];
    std::int32_t total = begin;
    for (std::int64_t cell = 0; cell <= level.cell_count(); ++cell) {
      total += first[cell];
      first[cell] = total;
    }
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

  // Insertion sort for the usual cell; stable, so rows at one point stay in the caller's order.
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
    for (std::int32_t i = 0; i < n; ++i) {
      // Compared with the last kept: places below i may be overwritten already.
      const bool is_repeated = i > 0 && repeats(i, kept - 1);
      position[i] = kept;
      if (!is_repeated) store(kept++, entry(i));
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
  std::int32_t crowded_ = kCrowdedIfEven;
  std::int32_t nested_ = 0;  // cells looked at
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
