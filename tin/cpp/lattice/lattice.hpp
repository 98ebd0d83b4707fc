// A lattice: points on the crossings of some columns and some rows, not all of them taken.
//
//       row 3   .     .     .           Every point has the easting of its column and the northing
//       row 2   .           .           of its row, to the last bit. Steps are constant but for
//       row 1   .     .     .           rounding, so the column of an easting is computed; that
//             col 1 col 2 col 3         it is the easting of all others there is compared.
//
// A ring of empty places lies around the points, so that every place of a point has eight others
// around it. Places are numbered row by row from the south, the ring included.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../base/point.hpp"
#include "../index/grid.hpp"

namespace tinsmith {

class Lattice {
 public:
  // The lattice of all rows, if they lie on one. Fewer places than rows may be taken.
  static std::optional<Lattice> of(const PointRows& rows, Team& team) {
    Lattice lattice;
    if (!lattice.fit(rows, team) || !lattice.place_all(rows, team) ||
        !lattice.order_rows(rows.count)) {
      return std::nullopt;
    }
    return std::optional<Lattice>(std::move(lattice));
  }

  const Box& box() const { return box_; }
  std::int32_t columns() const { return columns_; }  // with those of the ring
  std::int32_t rows() const { return rows_; }        // likewise
  std::int32_t places() const { return columns_ * rows_; }

  std::int32_t column_of(std::int32_t place) const { return place % columns_; }
  std::int32_t row_of(std::int32_t place) const { return place / columns_; }
  double x(std::int32_t column) const { return x_[column]; }  // infinite in the ring
  double y(std::int32_t row) const { return y_[row]; }
  Point point(std::int32_t place) const { return {x_[column_of(place)], y_[row_of(place)]}; }

  // The caller's row at a place, or a negative number.
  std::int32_t at(std::int32_t place) const {
    return taken_[place].load(std::memory_order_relaxed);
  }
  bool is_taken(std::int32_t place) const { return at(place) >= 0; }

  // Rows of places that share a row of cells of the point grid: a stripe. In the order of the
  // sweep points come stripe by stripe, and by easting, then northing within one.
  const std::vector<Range>& stripes() const { return stripes_; }

  // Ascends in the order of the sweep.
  Vertex sweep_order(std::int32_t column, std::int32_t row) const {
    return Vertex{order_base_[row] + column * order_step_[row]};
  }
  Vertex sweep_order(std::int32_t place) const {
    return sweep_order(column_of(place), row_of(place));
  }

 private:
  static constexpr double kMostPlaces = 1 << 29;  // two triangles each must be numbered
  // More empty places than this to a point, and nearly nothing about the triangles is certain.
  static constexpr double kMostPlacesPerPoint = 4.0;
  static constexpr std::int64_t kFirstLook = 4096;
  static constexpr std::int32_t kRing = 1;
  static constexpr std::int32_t kFree = -1;

  // The bounds of successive rows, and the least steps between them along each axis.
  struct Steps {
    Box box;
    double dx = std::numeric_limits<double>::infinity();
    double dy = std::numeric_limits<double>::infinity();

    void look_at(const PointRows& rows, std::int64_t begin, std::int64_t end) {
      Point before = rows[begin];
      for (std::int64_t i = begin; i < end; ++i) {
        const Point p = rows[i];
        box.include(p);
        const double across = std::fabs(p.x - before.x), up = std::fabs(p.y - before.y);
        dx = (across > 0.0) & (across < dx) ? across : dx;
        dy = (up > 0.0) & (up < dy) ? up : dy;
        before = p;
      }
    }
    void include(const Steps& other) {
      box.include(other.box);
      dx = std::min(dx, other.dx);
      dy = std::min(dy, other.dy);
    }
    double columns() const { return box.width() > 0.0 ? std::round(box.width() / dx) + 1.0 : 1.0; }
    double rows() const { return box.height() > 0.0 ? std::round(box.height() / dy) + 1.0 : 1.0; }
    bool is_plausible(std::int64_t count) const {
      const double places = columns() * rows();
      return places <= kMostPlacesPerPoint * static_cast<double>(count) &&
             (columns() + 2.0) * (rows() + 2.0) < kMostPlaces;
    }
  };

  struct alignas(kCacheLine) Part {
    Steps steps;
    std::vector<double> x, y;  // of columns and rows met; others are not numbers
  };

  // Guess the steps: the least between rows that follow each other. What is no lattice fails here,
  // most of it within the first rows.
  bool fit(const PointRows& rows, Team& team) {
    Steps first;
    first.look_at(rows, 0, std::min(kFirstLook, rows.count));
    if (!first.is_plausible(rows.count)) return false;
    std::vector<Part> parts(team.size());
    team.run([&](int part) {
      const Range range = part_of(rows.count, part, team.size());
      if (range.begin < range.end) parts[part].steps.look_at(rows, range.begin, range.end);
    });
    Steps all;
    for (const Part& part : parts) all.include(part.steps);
    const double columns = all.columns(), lines = all.rows();
    if (!all.is_plausible(rows.count) || columns < 2.0 || lines < 2.0) return false;
    box_ = all.box;
    columns_ = static_cast<std::int32_t>(columns) + 2 * kRing;
    rows_ = static_cast<std::int32_t>(lines) + 2 * kRing;
    per_x_ = (columns - 1.0) / box_.width();
    per_y_ = (lines - 1.0) / box_.height();
    return true;
  }

  // False if a point is off its column or row. Of several points at one place any is taken.
  bool place_all(const PointRows& rows, Team& team) {
    taken_ = scratch_array<std::atomic<std::int32_t>>(places());
    std::vector<Part> parts(team.size());
    std::atomic<bool> is_lattice{true};
    team.run([&](int part) {
      const Range range = part_of(places(), part, team.size());
      for (std::int32_t i = range.begin; i < range.end; ++i) {
        new (&taken_[i]) std::atomic<std::int32_t>(kFree);
      }
    });
    team.run([&](int part) {
      const Range own = part_of(rows.count, part, team.size());
      const auto goes_on = [&] { return is_lattice && team.keeps_going(part); };
      if (!place(rows, own, parts[part], goes_on)) {
        is_lattice = false;
      }
    });
    if (!is_lattice) return false;
    x_ = joined(parts, &Part::x, columns_, box_.west, 1.0 / per_x_);
    y_ = joined(parts, &Part::y, rows_, box_.south, 1.0 / per_y_);
    return !x_.empty() && !y_.empty();
  }

  template <typename GoesOn>
  bool place(const PointRows& rows, Range range, Part& part, GoesOn&& goes_on) {
    constexpr std::int32_t kBlock = 4096;
    part.x.assign(columns_, std::nan(""));
    part.y.assign(rows_, std::nan(""));
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      if (i % kBlock == 0 && !goes_on()) return false;
      const Point p = rows[i];
      const auto column = kRing + static_cast<std::int32_t>((p.x - box_.west) * per_x_ + 0.5);
      const auto row = kRing + static_cast<std::int32_t>((p.y - box_.south) * per_y_ + 0.5);
      if (!agrees(part.x[column], p.x) || !agrees(part.y[row], p.y)) return false;
      taken_[std::int64_t{row} * columns_ + column].store(i, std::memory_order_relaxed);
    }
    return true;
  }

  // Whether a column's or row's coordinate is this one; the first that comes is taken.
  static bool agrees(double& known, double given) {
    if (known == given) return true;
    if (known == known) return false;
    known = given;
    return true;
  }

  // The coordinates that the parts met, which must agree; between them those of columns or rows
  // without points. Empty if they do not ascend.
  static std::vector<double> joined(std::vector<Part>& parts, std::vector<double> Part::* which,
                                    std::int32_t count, double first, double step) {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    std::vector<double> all = std::move(parts[0].*which);
    for (std::size_t part = 1; part < parts.size(); ++part) {
      for (std::int32_t i = 0; i < count; ++i) {
        const double met = (parts[part].*which)[i];
        if (met == met && !agrees(all[i], met)) return {};
      }
    }
    all.front() = -kEndless;
    all.back() = kEndless;
    for (std::int32_t i = 1; i + 1 < count; ++i) {
      if (all[i] != all[i]) all[i] = first + (i - kRing) * step;
    }
    for (std::int32_t i = 1; i < count; ++i) {
      if (!(all[i - 1] < all[i])) return {};
    }
    return all;
  }

  // The order of the sweep, as the grid of points has it. False if the grid would nest cells.
  bool order_rows(std::int64_t count) {
    const Level level = Level::fitted(box_, 0, static_cast<std::int32_t>(count), kPointsPerCell);
    stripes_ = ranges_of(rows_, [&](std::int32_t row) { return level.row_at(y_[row]); });
    const std::vector<Range> across =
        ranges_of(columns_, [&](std::int32_t column) { return level.column_at(x_[column]); });
    order_base_.assign(rows_, 0);
    order_step_.assign(rows_, 0);
    for (const Range stripe : stripes_) {
      for (std::int32_t row = stripe.begin; row < stripe.end; ++row) {
        order_base_[row] = stripe.begin * columns_ + row - stripe.begin;
        order_step_[row] = stripe.size();
      }
    }
    return !is_nested(across, count);
  }

  template <typename CellOf>
  static std::vector<Range> ranges_of(std::int32_t count, CellOf&& cell_of) {
    std::vector<Range> ranges;
    std::int32_t last = -1;
    for (std::int32_t i = kRing; i < count - kRing; ++i) {
      const std::int32_t cell = cell_of(i);
      if (cell != last) ranges.push_back({i, i});
      last = cell;
      ranges.back().end = i + 1;
    }
    return ranges;
  }

  bool is_nested(const std::vector<Range>& across, std::int64_t count) const {
    const auto longest = [](const std::vector<Range>& ranges) {
      std::int32_t size = 0;
      for (const Range range : ranges) size = std::max(size, range.size());
      return std::int64_t{size};
    };
    if (longest(stripes_) * longest(across) <= GridBuilder::kCrowdedIfUneven) return false;
    double squares = 0.0;
    std::int64_t most = 0;
    for (const Range stripe : stripes_) {
      for (const Range columns : across) {
        const std::int64_t held = count_in(columns, stripe);
        squares += static_cast<double>(held * held);
        most = std::max(most, held);
      }
    }
    return most > GridBuilder::crowd(squares, count);
  }

  std::int64_t count_in(Range columns, Range rows) const {
    std::int64_t held = 0;
    for (std::int32_t row = rows.begin; row < rows.end; ++row) {
      for (std::int32_t column = columns.begin; column < columns.end; ++column) {
        held += is_taken(row * columns_ + column);
      }
    }
    return held;
  }

  Box box_;
  std::int32_t columns_ = 0, rows_ = 0;
  double per_x_ = 0.0, per_y_ = 0.0;
  std::vector<double> x_, y_;
  ScratchArray<std::atomic<std::int32_t>> taken_;
  std::vector<Range> stripes_;
  std::vector<std::int32_t> order_base_, order_step_;  // of rows
};

}  // namespace tinsmith
