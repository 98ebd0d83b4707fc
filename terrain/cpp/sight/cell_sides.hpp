// Sides of cells, and the corners of other cells that lie on them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/point.hpp"
#include "../../../tin/cpp/base/pulse.hpp"

namespace tinsmith::sight {

// Convex polygons, one after the other: of each corner the vertex, and the line on which the side to
// the next corner lies, negative for a line that no other side lies on.
struct CellSides {
  const Point* points;
  const std::int64_t* counts;  // of corners, of each cell
  std::size_t cell_count;
  const std::int64_t* corners;
  const std::int64_t* lines;
  std::size_t size;
  std::int64_t line_count;
};

// Cells with more corners, as CellSides has them.
struct CompletedCells {
  std::vector<std::int64_t> counts, corners, lines;
};

// Each line has its vertices in order: by the direction of the longest side on it, of the last one
// of several; those in one place by their numbers. A side gets those between its ends.
class SideCompletion {
 public:
  explicit SideCompletion(const CellSides& given)
      : given_(given),
        ends_(scratch_array<std::int64_t>(given.size)),
        first_(scratch_array<std::uint32_t>(given.size)),
        last_(scratch_array<std::uint32_t>(given.size)) {
    std::size_t begin = 0;
    for (std::size_t c = 0; c < given.cell_count; ++c) {
      const std::size_t end = begin + static_cast<std::size_t>(given.counts[c]);
      for (std::size_t i = begin; i < end; ++i) {
        ends_[i] = given.corners[i + 1 < end ? i + 1 : begin];
      }
      begin = end;
    }
  }

  CompletedCells run(Pulse& pulse) {
    sort_by_line();
    std::uint32_t begin = 0;
    for (const std::uint32_t end : line_ends_) {
      if (!pulse.goes_on()) return {};
      if (begin < end) order_vertices(sides_.get() + begin, sides_.get() + end);
      begin = end;
    }
    return write(pulse);
  }

 private:
  struct OnLine {
    double along;
    std::int64_t vertex;

    bool operator<(const OnLine& other) const {
      return along < other.along || (along == other.along && vertex < other.vertex);
    }
  };

  Point start(std::size_t i) const { return given_.points[given_.corners[i]]; }
  Point end(std::size_t i) const { return given_.points[ends_[i]]; }

  // Sides of a line by their numbers (counting sort).
  void sort_by_line() {
    line_ends_.assign(static_cast<std::size_t>(given_.line_count) + 1, 0);
    for (std::size_t i = 0; i < given_.size; ++i) {
      if (given_.lines[i] >= 0) ++line_ends_[static_cast<std::size_t>(given_.lines[i]) + 1];
    }
    for (std::size_t l = 1; l < line_ends_.size(); ++l) line_ends_[l] += line_ends_[l - 1];
    sides_ = scratch_array<std::uint32_t>(line_ends_.back());
    for (std::size_t i = 0; i < given_.size; ++i) {
      if (given_.lines[i] < 0) continue;
      sides_[line_ends_[static_cast<std::size_t>(given_.lines[i])]++] =
          static_cast<std::uint32_t>(i);
    }
  }

  void order_vertices(const std::uint32_t* begin, const std::uint32_t* end_of_line) {
    std::size_t chosen = *begin;
    double longest = -1.0;
    on_line_.clear();
    for (const std::uint32_t* side = begin; side != end_of_line; ++side) {
      const Point p = start(*side), q = end(*side);
      const double length = std::hypot(q.x - p.x, q.y - p.y);
      if (length >= longest) {
        longest = length;
        chosen = *side;
      }
      on_line_.push_back({0.0, given_.corners[*side]});
      on_line_.push_back({0.0, ends_[*side]});
    }
    std::sort(on_line_.begin(), on_line_.end());
    on_line_.erase(
        std::unique(on_line_.begin(), on_line_.end(),
                    [](const OnLine& a, const OnLine& b) { return a.vertex == b.vertex; }),
        on_line_.end());
    const Point from = start(chosen), to = end(chosen);
    const auto on_line = [&](std::int64_t vertex) {
      const Point p = given_.points[vertex];
      return OnLine{(p.x - from.x) * (to.x - from.x) + (p.y - from.y) * (to.y - from.y), vertex};
    };
    for (OnLine& one : on_line_) one = on_line(one.vertex);
    std::sort(on_line_.begin(), on_line_.end());
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    for (const OnLine& one : on_line_) vertices_.push_back(one.vertex);
    for (const std::uint32_t* side = begin; side != end_of_line; ++side) {
      first_[*side] = first + place_of(on_line(given_.corners[*side]));
      last_[*side] = first + place_of(on_line(ends_[*side]));
    }
  }

  std::uint32_t place_of(const OnLine& one) const {
    return static_cast<std::uint32_t>(std::lower_bound(on_line_.begin(), on_line_.end(), one) -
                                      on_line_.begin());
  }

  CompletedCells write(Pulse& pulse) const {
    CompletedCells found;
    found.counts.reserve(given_.cell_count);
    std::size_t i = 0;
    for (std::size_t c = 0; c < given_.cell_count; ++c) {
      if (!pulse.goes_on()) return {};
      const std::size_t before = found.corners.size();
      for (std::int64_t k = 0; k < given_.counts[c]; ++k, ++i) write_side(i, found);
      found.counts.push_back(static_cast<std::int64_t>(found.corners.size() - before));
    }
    return found;
  }

  void write_side(std::size_t i, CompletedCells& found) const {
    const std::int64_t line = given_.lines[i];
    found.corners.push_back(given_.corners[i]);
    found.lines.push_back(line);
    if (line < 0) return;
    const std::int64_t first = first_[i], last = last_[i];
    const std::int64_t step = first < last ? 1 : -1;
    for (std::int64_t at = first + step; first != last && at != last; at += step) {
      found.corners.push_back(vertices_[static_cast<std::size_t>(at)]);
      found.lines.push_back(line);
    }
  }

  const CellSides& given_;
  ScratchArray<std::int64_t> ends_;
  ScratchArray<std::uint32_t> first_, last_;  // of sides: where their ends are among vertices_
  std::vector<std::uint32_t> line_ends_;
  ScratchArray<std::uint32_t> sides_;
  ScratchVector<std::int64_t> vertices_;  // of lines, in order
  std::vector<OnLine> on_line_;
};

}  // namespace tinsmith::sight
