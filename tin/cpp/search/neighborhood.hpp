// Neighbourhood of a vertex: the later points around it, gathered once for all its searches.
//
//      +----+----+----+----+        Around the vertex v a few cells are copied side by side, as
//      | .  |. . |  . | .  |        coordinates relative to v. Each search then looks at all of
//      +----+----+----+----+        them at once with vector instructions, without a branch per
//      |  . |. . |. . | .  |        point, and ends with a proof: no other point is nearly as
//      +----+----+----+----+        good, and the winner's circle, where it lies left of the
//           v . .|  . | .  |        edge, does not leave the cells.
//           +----+----+----+
//
// Without the proof the search goes on over the whole index (full_search.hpp). Of random points 96
// searches in 100 end here, of rasters all.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../base/parallel.hpp"
#include "../index/grid.hpp"
#include "../predicates/predicates.hpp"
#include "circle_on_edge.hpp"
#include "search_counts.hpp"

namespace tinsmith {

// Place of the lowest bit that is set.
inline std::int32_t lowest_bit(std::uint64_t bits) {
#ifdef __GNUC__
  return __builtin_ctzll(bits);
#else
  std::int32_t place = 0;
  for (; (bits & 1) == 0; bits >>= 1) ++place;
  return place;
#endif
}

// Everything but the loops over vectors, which are compiled once per instruction set
// (vector_neighborhood.inc).
class Neighborhood {
 public:
  // A point that wins among those gathered, or kNone; proven if it wins among all.
  struct Answer {
    std::int32_t point;
    bool is_proven;
  };
  static constexpr std::int32_t kNone = -1;

  // `own` are the positions whose vertices are finished in turn; all others come later.
  Neighborhood(const PointGrid& grid, Range own)
      : grid_(grid),
        x_(grid.x()),
        y_(grid.y()),
        own_(own),
        slack_(coordinate_slack(grid.top().box)),
        seam_row_(own.begin > 0 ? grid.row_of(own.begin - 1) : kNoRow) {}

 protected:
  static constexpr std::int32_t kMost = 64;  // one bit each in a word
  static constexpr std::int32_t kMostRuns = 6;
  static constexpr std::int32_t kNoRow = -10;
  // Cells on either side and rows ahead: fewer fail more often, more cost every search.
  static constexpr double kWidthInCells = 1.2;
  static constexpr std::int32_t kRowsAhead = 2;
  // Farther from v than any gathered point, in cells.
  static constexpr double kReachInCells = 4.0;
  // Cross products above this share of the reach's square make sound cotangents: by the bounds of
  // CotangentErrors their error is below 2^-30 (1 + |cotangent|).
  static constexpr double kSoundCross = 0x1p-16;
  static constexpr double kCotangentError = 0x1p-30;
  // So many places of a run are always copied, so that the usual trip count is foreseen.
  static constexpr std::int32_t kUsualRun = 12;

  // Choose the cells around `a`, and list their runs of later points.
  void choose(std::int32_t a, const Level& level) {
    a_ = a;
    ax_ = x_[a];
    ay_ = y_[a];
    reach_ = kReachInCells * level.cell_size;
    sound_cross_ = kSoundCross * reach_ * reach_;
    runs_ = 0;
    count_ = 0;
    last_point_ = kNone;
    const bool is_top = &level == &grid_.top();
    if (!is_top && level.begin < own_.begin) {
      count_ = kMost + 1;  // the seam runs through a nested level: left to the whole index
      return;
    }
    const double width = kWidthInCells * level.cell_size;
    const std::int32_t first = level.column_at(ax_ - width), last = level.column_at(ax_ + width);
    const std::int32_t row = level.row_at(ay_);
    const std::int32_t top_row = std::min(row + kRowsAhead, level.rows - 1);
    list_runs_behind(level, row, first, last, is_top);
    for (std::int32_t r = row; r <= top_row; ++r) {
      add_run(std::max(grid_.start(level, r, first), a + 1), grid_.start(level, r, last + 1));
    }
    set_limits(level, first, last, top_row, is_top);
  }

  // Points before `own` come later than v too: they matter to the first rows after the seam.
  void list_runs_behind(const Level& level, std::int32_t row, std::int32_t first, std::int32_t last,
                        bool is_top) {
    south_ = is_top ? -HUGE_VAL : level.box.south - ay_ + slack_;
    if (!is_top || seam_row_ == kNoRow) return;
    const std::int32_t lowest = std::max(row - kRowsAhead, 0);
    for (std::int32_t r = lowest; r <= std::min(row, seam_row_); ++r) {
      add_run(grid_.start(level, r, first), std::min(grid_.start(level, r, last + 1), own_.begin));
    }
    const std::int32_t limit = std::min(lowest, seam_row_ + 1);
    if (limit > 0) south_ = level.box.south + limit * level.cell_size - ay_ + slack_;
  }

  void add_run(std::int32_t begin, std::int32_t end) {
    begin_[runs_] = begin;
    offset_[runs_] = count_;
    count_ += std::max(end - begin, 0);
    ++runs_;
  }

  // The cells, as seen from v; the border cells of the top level have nothing beyond them.
  void set_limits(const Level& level, std::int32_t first, std::int32_t last, std::int32_t top_row,
                  bool is_top) {
    const Box& box = level.box;
    west_ = box.west + first * level.cell_size - ax_ + slack_;
    east_ = std::min(box.west + (last + 1) * level.cell_size, box.east) - ax_ - slack_;
    north_ = std::min(box.south + (top_row + 1) * level.cell_size, box.north) - ay_ - slack_;
    if (!is_top) return;
    if (first == 0) west_ = -HUGE_VAL;
    if (last == level.columns - 1) east_ = HUGE_VAL;
    if (top_row == level.rows - 1) north_ = HUGE_VAL;
  }

  bool is_gathered() const { return count_ <= kMost; }

  // False if b is too far away for the error bounds of the gathered points.
  bool set_edge(std::int32_t b) {
    b_ = b;
    ex_ = x_[b] - ax_;
    ey_ = y_[b] - ay_;
    return std::fabs(ex_) + std::fabs(ey_) <= reach_;
  }

  // One bit for b, if it was gathered: it sees no edge that it is an end of.
  std::uint64_t bit_of_end() const {
    std::int32_t lane = last_lane_;
    if (b_ != last_point_) {
      lane = -1;
      for (std::int32_t run = 0; run < runs_; ++run) {
        const std::int32_t end = run + 1 < runs_ ? offset_[run + 1] : count_;
        const std::int32_t place = offset_[run] + b_ - begin_[run];
        if (place >= offset_[run] && place < end) lane = place;
      }
    }
    return lane < 0 ? 0 : std::uint64_t{1} << lane;
  }

  // Lane of the winner among `lane` and its rivals: points that the error bound cannot rule out.
  std::int32_t settled(std::int32_t lane, std::uint64_t rivals, const CotangentErrors& errors,
                       SearchCounts& counts) const {
    for (; rivals != 0; rivals &= rivals - 1) {
      const std::int32_t rival = lowest_bit(rivals);
      const std::int32_t i = point_in(rival);
      ++counts.exact_decisions;
      const bool is_left =
          crosses_[rival] > errors.cross() || orientation(here(a_), here(b_), here(i)) > 0;
      if (is_left && is_in_circle(here(a_), here(b_), here(point_in(lane)), here(i))) lane = rival;
    }
    return lane;
  }

  // Whether all of the winner's cap was gathered.
  bool is_enclosed(std::int32_t lane) const {
    if (!(crosses_[lane] > sound_cross_)) return false;
    const double rounded = cotangents_[lane];
    const double cotangent = rounded + kCotangentError * (1.0 + std::fabs(rounded));
    const double cx = 0.5 * (ex_ - ey_ * cotangent), cy = 0.5 * (ey_ + ex_ * cotangent);
    const double square = (cx * cx + cy * cy) * (1.0 + 4.0 * kSlack);
    const double nearest =
        std::min(std::min(cx - west_, east_ - cx), std::min(north_ - cy, cy - south_));
    if (nearest > 0.0 && nearest * nearest > square) return true;
    const double radius = std::sqrt(square), slack = kSlack * radius;
    const Box cap = box_of_cap({ex_, ey_}, {cx, cy}, radius);
    return cap.west - slack > west_ && cap.east + slack < east_ && cap.north + slack < north_ &&
           cap.south - slack > south_;
  }

  std::int32_t point_in(std::int32_t lane) const {
    std::int32_t shift = begin_[0];
    for (std::int32_t run = 1; run < runs_; ++run) {
      if (lane >= offset_[run]) shift = begin_[run] - offset_[run];
    }
    return lane + shift;
  }

  Point here(std::int32_t i) const { return {x_[i], y_[i]}; }

  const PointGrid& grid_;
  const double* x_;
  const double* y_;
  Range own_;
  double slack_;
  std::int32_t seam_row_;  // of the last point before `own_`

  // The gathered points: lane k holds point k - offset_[r] + begin_[r] of its run r.
  std::int32_t a_ = 0;
  double ax_ = 0.0, ay_ = 0.0, reach_ = 0.0;
  double west_ = 0.0, east_ = 0.0, south_ = 0.0, north_ = 0.0;  // relative to a
  std::int32_t count_ = 0, runs_ = 0;
  std::int32_t begin_[kMostRuns], offset_[kMostRuns];
  alignas(64) double px_[kMost + PointGrid::kPadding], py_[kMost + PointGrid::kPadding];
  std::int32_t last_point_ = kNone, last_lane_ = 0;  // the last winner

  // The edge at hand, and what each lane is for it.
  std::int32_t b_ = 0;
  double ex_ = 0.0, ey_ = 0.0;
  double sound_cross_ = 0.0;
  alignas(64) double dots_[kMost], crosses_[kMost], cotangents_[kMost];
};

}  // namespace tinsmith
