// Index: points bucketed into square cells of about two, stored row of cells by row of cells.
//
// The storage order is the sweep order. Within a cell points are sorted by easting, then
// northing, so the order is a function of the point set, and rows at one place stand together.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ids.hpp"
#include "predicates.hpp"

namespace tinsmith {

// The caller's points: n rows of (x, y, ...), `stride` doubles apart.
struct PointRows {
  const double* data;
  std::int64_t count;
  std::int64_t stride;

  Point operator[](std::int64_t row) const {
    return {data[row * stride], data[row * stride + 1]};
  }
};

class PointGrid {
 public:
  explicit PointGrid(const PointRows& rows) {
    measure(rows);
    bucket(rows);
    sort_cells();
    drop_repeated(rows.count);
  }

  std::int32_t count() const { return static_cast<std::int32_t>(x_.size()); }
  Point point(Vertex v) const { return {x_[number(v)], y_[number(v)]}; }
  const double* x() const { return x_.data(); }
  const double* y() const { return y_.data(); }
  Row row_of(Vertex v) const { return rows_[number(v)]; }

  // For each input row the first row at its place; empty if no two rows share a place.
  const std::vector<std::int32_t>& kept_row() const { return kept_row_; }

  // Points that share the cell of a point, on average: about 3 for even data.
  double crowding() const {
    double squares = 0.0;
    for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell) {
      const double held = start_[cell + 1] - start_[cell];
      squares += held * held;
    }
    return squares / count();
  }

  double cell_size() const { return cell_size_; }
  std::int32_t columns() const { return columns_; }
  std::int32_t cell_rows() const { return cell_rows_; }
  double west() const { return west_; }
  double south() const { return south_; }

  // Monotone in x and y, so the cells of a box's corners bound the cells of its points.
  std::int32_t column_at(double x) const { return clamped((x - west_) * per_cell_, columns_); }
  std::int32_t cell_row_at(double y) const { return clamped((y - south_) * per_cell_, cell_rows_); }

  // First stored position of a cell; the cell after the last one of a row begins the next row.
  std::int32_t begin_of(std::int32_t cell_row, std::int32_t column) const {
    return start_[static_cast<std::size_t>(cell_row) * columns_ + column];
  }

 private:
  static constexpr double kPointsPerCell = 2.0;

  static std::int32_t clamped(double cell, std::int32_t count) {
    if (!(cell > 0.0)) return 0;
    return cell < count ? static_cast<std::int32_t>(cell) : count - 1;
  }

  void measure(const PointRows& rows) {
    double east = rows[0].x, north = rows[0].y;
    west_ = east;
    south_ = north;
    for (std::int64_t i = 1; i < rows.count; ++i) {
      const Point p = rows[i];
      west_ = std::min(west_, p.x);
      east = std::max(east, p.x);
      south_ = std::min(south_, p.y);
      north = std::max(north, p.y);
    }
    const double width = east - west_, height = north - south_;
    const double cells = std::max(1.0, static_cast<double>(rows.count) / kPointsPerCell);
    cell_size_ = std::max({std::sqrt(width / cells) * std::sqrt(height), width / cells,
                           height / cells});
    if (!(cell_size_ > 0.0)) cell_size_ = 1.0;
    per_cell_ = 1.0 / cell_size_;
    columns_ = 1 + static_cast<std::int32_t>(width * per_cell_);
    cell_rows_ = 1 + static_cast<std::int32_t>(height * per_cell_);
  }

  void bucket(const PointRows& rows) {
    const auto n = static_cast<std::size_t>(rows.count);
    std::vector<std::int32_t> cell_of(n);
    start_.assign(static_cast<std::size_t>(columns_) * cell_rows_ + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const Point p = rows[static_cast<std::int64_t>(i)];
      cell_of[i] = cell_row_at(p.y) * columns_ + column_at(p.x);
      ++start_[cell_of[i]];
    }
    std::int32_t total = 0;
    for (auto& start : start_) {
      total += start;
      start = total;  // the end of the cell; filling backwards turns it into the begin
    }
    x_.resize(n);
    y_.resize(n);
    rows_.resize(n);
    for (std::size_t i = n; i-- > 0;) {
      const Point p = rows[static_cast<std::int64_t>(i)];
      const std::int32_t place = --start_[cell_of[i]];
      x_[place] = p.x;
      y_[place] = p.y;
      rows_[place] = static_cast<Row>(i);
    }
  }

  void sort_cells() {
    for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell) {
      const std::int32_t begin = start_[cell], end = start_[cell + 1];
      if (end - begin > kLongCell) {
        sort_long_cell(begin, end);
      } else {
        sort_short_cell(begin, end);
      }
    }
  }

  static constexpr std::int32_t kLongCell = 24;

  // Both sorts are stable: rows at one place stay in the caller's order.
  void sort_short_cell(std::int32_t begin, std::int32_t end) {
    for (std::int32_t i = begin + 1; i < end; ++i) {
      const Point p{x_[i], y_[i]};
      const Row row = rows_[i];
      std::int32_t j = i;
      for (; j > begin && lexicographically_before(p, {x_[j - 1], y_[j - 1]}); --j) {
        x_[j] = x_[j - 1];
        y_[j] = y_[j - 1];
        rows_[j] = rows_[j - 1];
      }
      x_[j] = p.x;
      y_[j] = p.y;
      rows_[j] = row;
    }
  }

  void sort_long_cell(std::int32_t begin, std::int32_t end) {
    struct Entry {
      Point p;
      Row row;
    };
    std::vector<Entry> entries;
    entries.reserve(end - begin);
    for (std::int32_t i = begin; i < end; ++i) entries.push_back({{x_[i], y_[i]}, rows_[i]});
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return lexicographically_before(a.p, b.p);
    });
    for (std::int32_t i = begin; i < end; ++i) {
      x_[i] = entries[i - begin].p.x;
      y_[i] = entries[i - begin].p.y;
      rows_[i] = entries[i - begin].row;
    }
  }

  bool repeats_previous(std::size_t i) const { return x_[i] == x_[i - 1] && y_[i] == y_[i - 1]; }

  void drop_repeated(std::int64_t n_rows) {
    std::size_t repeated = 0;
    for (std::size_t i = 1; i < x_.size(); ++i) repeated += repeats_previous(i);
    if (repeated == 0) return;
    kept_row_.resize(n_rows);
    std::size_t kept = 0;
    std::size_t i = 0;
    for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell) {
      const auto end = static_cast<std::size_t>(start_[cell + 1]);
      start_[cell] = static_cast<std::int32_t>(kept);
      for (; i < end; ++i) {
        const bool repeats = kept > 0 && x_[i] == x_[kept - 1] && y_[i] == y_[kept - 1];
        if (!repeats) {
          x_[kept] = x_[i];
          y_[kept] = y_[i];
          rows_[kept] = rows_[i];
          ++kept;
        }
        kept_row_[number(rows_[i])] = number(rows_[kept - 1]);
      }
    }
    start_.back() = static_cast<std::int32_t>(kept);
    x_.resize(kept);
    y_.resize(kept);
    rows_.resize(kept);
  }

  double west_ = 0.0, south_ = 0.0, cell_size_ = 1.0, per_cell_ = 1.0;
  std::int32_t columns_ = 1, cell_rows_ = 1;
  std::vector<std::int32_t> start_;
  std::vector<double> x_, y_;
  std::vector<Row> rows_;
  std::vector<std::int32_t> kept_row_;
};

}  // namespace tinsmith
