// Between traced lines and arrays: coordinates of all lines with offsets, and a row for each line.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "../../../tin/cpp/base/arrays.hpp"
#include "line_tracing.hpp"

namespace tinsmith::isolines {

// A closed line repeats its first point at its end.
struct GivenLines {
  const double* xyz;
  const std::int64_t* offsets;  // into points, one more than there are lines
  const std::int32_t* levels;
  const bool* are_closed;
  std::size_t count;
};

// Throws std::invalid_argument where a line has no level or too few points.
inline TracedLines lines_of(const GivenLines& given, const Levels& levels) {
  TracedLines lines;
  for (std::size_t k = 0; k < given.count; ++k) {
    const std::int32_t level = given.levels[k];
    const bool is_closed = given.are_closed[k];
    if (level < 0 || level >= levels.count) {
      throw std::invalid_argument("every line needs a level");
    }
    const std::size_t begin = lines.points.size();
    const std::int64_t end = given.offsets[k + 1] - (is_closed ? 1 : 0);
    for (std::int64_t i = given.offsets[k]; i < end; ++i) {
      lines.points.push_back({given.xyz[3 * i], given.xyz[3 * i + 1]});
    }
    if (lines.points.size() < begin + (is_closed ? 3 : 2)) {
      throw std::invalid_argument("a line has two points or more, a closed one three");
    }
    lines.lines.push_back({begin, lines.points.size(), level, is_closed});
  }
  return lines;
}

// hypot, which takes several times as long, where squares are too large or too small.
inline double measure_length(double x, double y) {
  const double square = x * x + y * y;
  return square > 0x1p-900 && square < 0x1p900 ? std::sqrt(square) : std::hypot(x, y);
}

// The same arrays made, and the length of each line.
class LineArrays {
 public:
  LineArrays(const TracedLines& lines, const Levels& levels)
      : count(lines.lines.size()), point_count(lines.points.size()) {
    for (const Line& line : lines.lines) point_count += line.is_closed;
    xyz = streamed_array<double>(3 * point_count);
    offsets = streamed_array<std::int64_t>(count + 1);
    level = streamed_array<std::int32_t>(count);
    is_closed = streamed_array<bool>(count);
    length = streamed_array<double>(count);
    for (std::size_t k = 0; k < count; ++k) write(k, lines, levels);
    offsets[count] = static_cast<std::int64_t>(written_);
  }

  std::size_t count, point_count;
  StreamedArray<double> xyz;
  StreamedArray<std::int64_t> offsets;
  StreamedArray<std::int32_t> level;
  StreamedArray<bool> is_closed;
  StreamedArray<double> length;

 private:
  void write(std::size_t k, const TracedLines& lines, const Levels& levels) {
    const Line& line = lines.lines[k];
    const Point* const points = lines.points.data();
    offsets[k] = static_cast<std::int64_t>(written_);
    level[k] = line.level;
    is_closed[k] = line.is_closed;
    length[k] = 0.0;
    Point last = points[line.begin];
    const auto add = [&](Point p) {
      double* const row = xyz.get() + 3 * written_++;
      row[0] = p.x;
      row[1] = p.y;
      row[2] = levels.values[line.level];
      length[k] += measure_length(p.x - last.x, p.y - last.y);
      last = p;
    };
    for (std::size_t i = line.begin; i < line.end; ++i) add(points[i]);
    if (line.is_closed) add(points[line.begin]);
  }

  std::size_t written_ = 0;  // points
};

}  // namespace tinsmith::isolines
