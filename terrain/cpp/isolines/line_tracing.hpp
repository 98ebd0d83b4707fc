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
#include "../../../tin/cpp/base/pulse.hpp"
#include "level_surface.hpp"
#include "line_exits.hpp"

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

// End a line, the last of all; it is none if it has shrunk to a point, or to a way forth and back.
inline void settle_line(TracedLines& found, std::size_t begin, std::int32_t level, bool is_closed) {
  auto& points = found.points;
  if (is_closed) {
    while (points.size() > begin + 1 && points.back() == points[begin]) points.pop_back();
    turn_to_first(points, begin);
  }
  if (points.size() - begin < (is_closed ? 3 : 2)) {
    points.resize(begin);
    return;
  }
  found.lines.push_back({begin, points.size(), level, is_closed});
}

// Every crossed triangle has one exit for each level, and what follows an exit is given by the
// triangle beyond: lines are the cycles of that map and its ways from boundary to boundary.
class LineTracer {
 public:
  LineTracer(const LevelSurface& surface, Team& team) : pulse_(team), exits_(surface, pulse_) {}

  TracedLines trace() {
    found_.points.reserve(exits_.size() + exits_.starts().size());
    for (const Start& start : exits_.starts()) trace_from(start);
    for (ExitId e{0}; number(e) < exits_.size() && pulse_.goes_on(); e = ExitId{number(e) + 1}) {
      if (!exits_.is_left(e)) trace_closed(e);
    }
    return std::move(found_);
  }

 private:
  void trace_from(const Start& start) {
    const std::size_t begin = found_.points.size();
    found_.points.push_back(start.point);
    const std::int32_t level = exits_.level(start.first);
    require(follow(start.first, begin) == kNoExit);
    settle_line(found_, begin, level, false);
  }

  void trace_closed(ExitId first) {
    const std::size_t begin = found_.points.size();
    const std::int32_t level = exits_.level(first);
    require(follow(first, begin) == first);
    settle_line(found_, begin, level, true);
  }

  // From exit to exit, until the boundary or an exit that was left before: returns that.
  ExitId follow(ExitId e, std::size_t begin) {
    auto& points = found_.points;
    while (e != kNoExit && !exits_.is_left(e) && pulse_.goes_on()) {
      const Point point = exits_.point(e);
      if (points.size() == begin || !(points.back() == point)) points.push_back(point);
      e = exits_.leave(e);
    }
    return e;
  }

  void require(bool comes_to_its_end) {
    if (!comes_to_its_end && pulse_.goes_on()) {
      throw std::invalid_argument("the neighbours are not those of the triangles");
    }
  }

  Pulse pulse_;
  LineExits exits_;
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
