// Contour lines, traced from triangle to triangle and joined, in an order that does not depend on
// that of the triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../../../tin/cpp/base/parallel.hpp"
#include "../pulse.hpp"
#include "level_surface.hpp"

namespace tinsmith::isolines {

// A line: points[begin, end), the higher side on its left. The first point of a closed one is not
// repeated.
struct Line {
  std::size_t begin;
  std::size_t end;
  std::int32_t level;
  bool is_closed;
};

struct TracedLines {
  ScratchVector<Point> points;
  std::vector<Line> lines;
};

// Turn a closed line, the last of all, to its first point by easting, then northing; where it
// passes there twice, to the way whose next point is first.
inline void turn_to_first(ScratchVector<Point>& points, std::size_t begin) {
  const auto start = points.begin() + std::ptrdiff_t(begin);
  const std::size_t count = points.size() - begin;
  const auto after = [&](std::size_t i) { return start[std::ptrdiff_t((i + 1) % count)]; };
  std::size_t first = 0;
  for (std::size_t i = 1; i < count; ++i) {
    const Point point = start[std::ptrdiff_t(i)];
    const Point least = start[std::ptrdiff_t(first)];
    if (lexicographically_before(point, least) ||
        (point == least && lexicographically_before(after(i), after(first)))) {
      first = i;
    }
  }
  std::rotate(start, start + std::ptrdiff_t(first), points.end());
}

// Every crossed triangle has one exit for each level, and what follows an exit is given by the
// triangle beyond: lines are the cycles of that map and its ways from boundary to boundary.
class LineTracer {
 public:
  LineTracer(const LevelSurface& surface, Team& team) : surface_(surface), pulse_(team) {
    first_exit_.resize(std::size_t{surface.triangle_count()} + 1);
    std::size_t total = 0;
    for (const Triangle t : surface.triangles()) {
      const auto [low, high] = surface.ranks(t);
      first_exit_[number(t)] = static_cast<std::uint32_t>(total);
      total += std::size_t(high - low);
      if (total > kMostCrossings) throw std::length_error("too many crossings");
      if (low < high) list_boundary(t);
    }
    first_exit_.back() = static_cast<std::uint32_t>(total);
    is_left_.assign(total, 1);
  }

  static constexpr std::size_t kMostCrossings = INT32_MAX;

  TracedLines trace() {
    for (const HalfEdge e : boundary_) trace_from_boundary(triangle_of(e), corner_of(e));
    for (const Triangle t : surface_.triangles()) {
      if (!pulse_.goes_on()) break;
      const std::uint32_t begin = first_exit_[number(t)];
      const std::uint32_t end = first_exit_[std::size_t{number(t)} + 1];
      for (std::uint32_t exit = begin; exit < end; ++exit) {
        if (is_left_[exit]) trace_closed(t, surface_.ranks(t).first + std::int32_t(exit - begin));
      }
    }
    return std::move(found_);
  }

 private:
  void list_boundary(Triangle t) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      if (surface_.neighbor(t, corner) == kNoTriangle) boundary_.push_back(half_edge(t, corner));
    }
  }

  // Lines come in where the boundary falls, with the surface on its left.
  void trace_from_boundary(Triangle t, std::uint32_t corner) {
    const Vertex start = surface_.corner(t, corner_after(corner));
    const Vertex end = surface_.corner(t, corner_before(corner));
    for (std::int32_t level = surface_.rank(end); level < surface_.rank(start); ++level) {
      const std::size_t begin = found_.points.size();
      found_.points.push_back(surface_.crossing({corner, end, start}, level));
      follow(t, level, begin);
      keep(begin, level, false);
    }
  }

  void trace_closed(Triangle t, std::int32_t level) {
    const std::size_t begin = found_.points.size();
    Triangle next = t;
    leave(t, surface_.crossed(t, level), level, begin, next);
    follow(next, level, begin);
    auto& points = found_.points;
    while (points.size() > begin + 1 && points.back() == points[begin]) points.pop_back();
    turn_to_first(points, begin);
    keep(begin, level, true);
  }

  // From exit to exit, until the boundary or an exit that the line had before.
  void follow(Triangle t, std::int32_t level, std::size_t begin) {
    while (t != kNoTriangle && pulse_.goes_on()) {
      surface_.prefetch_around(t, first_exit_.data());
      Crossed crossed = surface_.crossed(t, level);
      const Triangle beyond = surface_.beyond_ridge(t, crossed.above, level);
      if (beyond != kNoTriangle) {
        t = beyond;
        crossed = surface_.crossed(t, level);
      }
      if (!leave(t, crossed, level, begin, t)) return;
    }
  }

  // Add the point where the line leaves a triangle and find the next one; false if that was done.
  bool leave(Triangle t, const Crossed& crossed, std::int32_t level, std::size_t begin,
             Triangle& next) {
    char& is_left = is_left_[first_exit_[number(t)] + std::uint32_t(level - crossed.lowest_rank)];
    if (!is_left) return false;
    is_left = 0;
    const Exit exit = surface_.exit_of(t, crossed.above);
    const Point point = surface_.crossing(exit, level);
    auto& points = found_.points;
    if (points.size() == begin || !(points.back() == point)) points.push_back(point);
    next = surface_.neighbor(t, exit.corner);
    return true;
  }

  // A line that has shrunk to a point, or to a way forth and back, is none.
  void keep(std::size_t begin, std::int32_t level, bool is_closed) {
    auto& points = found_.points;
    if (points.size() - begin < (is_closed ? 3 : 2)) {
      points.resize(begin);
      return;
    }
    found_.lines.push_back({begin, points.size(), level, is_closed});
  }

  const LevelSurface& surface_;
  Pulse pulse_;
  ScratchVector<std::uint32_t> first_exit_;  // of each triangle, that of its lowest level
  std::vector<HalfEdge> boundary_;           // of crossed triangles
  std::vector<char> is_left_;
  TracedLines found_;
};

// By level, then by the points from the first on.
inline void sort_lines(TracedLines& found) {
  const auto& points = found.points;
  const auto before = [&](const Line& a, const Line& b) {
    if (a.level != b.level) return a.level < b.level;
    return std::lexicographical_compare(
        points.begin() + std::ptrdiff_t(a.begin), points.begin() + std::ptrdiff_t(a.end),
        points.begin() + std::ptrdiff_t(b.begin), points.begin() + std::ptrdiff_t(b.end),
        lexicographically_before);
  };
  std::sort(found.lines.begin(), found.lines.end(), before);
}

inline TracedLines trace_lines(const Surface& given, const Levels& levels, Team& team) {
  const LevelSurface surface(given, levels);
  TracedLines found = LineTracer(surface, team).trace();
  sort_lines(found);
  return found;
}

}  // namespace tinsmith::isolines
