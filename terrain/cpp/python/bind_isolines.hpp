// Bindings for contours: lines and bands of a TIN between levels.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "../../../tin/cpp/python/arrays.hpp"
#include "../isolines/band_filling.hpp"
#include "../isolines/line_smoothing.hpp"
#include "../isolines/line_tracing.hpp"

namespace tinsmith::python {

using GivenLevels = Given<double, -1>;
using Offsets = Made<std::int64_t, -1>;

inline void require_between(const GivenTriples& numbers, std::int32_t least, std::int32_t end) {
  const auto first = static_cast<std::uint32_t>(least);
  const std::uint32_t count = static_cast<std::uint32_t>(end) - first;
  bool is_any_outside = false;  // without a way out of the loop, many are compared at once
  for (std::size_t i = 0; i < 3 * numbers.shape(0); ++i) {
    is_any_outside |= static_cast<std::uint32_t>(numbers.data()[i]) - first >= count;
  }
  if (is_any_outside) throw std::invalid_argument("every number must be that of an existing row");
}

inline isolines::SurfaceArrays surface_of(const GivenXyz& points, const GivenTriples& triangles,
                                          const GivenTriples& neighbors) {
  const std::int32_t vertices = row_count(points.shape(0));
  const std::int32_t count = row_count(triangles.shape(0));
  if (neighbors.shape(0) != triangles.shape(0)) {
    throw std::invalid_argument("every triangle needs neighbours");
  }
  require_between(triangles, 0, vertices);
  require_between(neighbors, kNoNeighbor, count);
  return {points.data(), triangles.data(), neighbors.data(), vertices, count};
}

inline isolines::Levels levels_of(const GivenLevels& levels) {
  const double* const end = levels.data() + levels.shape(0);
  const auto ascends = [](double a, double b) { return !(a < b); };
  if (std::adjacent_find(levels.data(), end, ascends) != end ||
      !std::all_of(levels.data(), end, [](double level) { return std::isfinite(level); })) {
    throw std::invalid_argument("levels must be finite and ascend");
  }
  return {levels.data(), row_count(levels.shape(0))};
}

// hypot, which takes several times as long, where squares are too large or too small.
inline double measure_length(double x, double y) {
  const double square = x * x + y * y;
  return square > 0x1p-900 && square < 0x1p900 ? std::sqrt(square) : std::hypot(x, y);
}

// Coordinates and offsets, and of each line its level, whether it is closed, and its length.
inline auto hand_over_lines(const isolines::TracedLines& found, const isolines::Levels& levels) {
  const std::size_t count = found.lines.size();
  const auto closed = [](const isolines::Line& line) { return line.is_closed; };
  const auto repeated = std::count_if(found.lines.begin(), found.lines.end(), closed);
  const std::size_t total = found.points.size() + static_cast<std::size_t>(repeated);
  auto xyz = streamed_array<double>(3 * total);
  auto offsets = streamed_array<std::int64_t>(count + 1);
  auto level = streamed_array<std::int32_t>(count);
  auto is_closed = streamed_array<bool>(count);
  auto length = streamed_array<double>(count);
  std::size_t at = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const isolines::Line& line = found.lines[k];
    offsets[k] = static_cast<std::int64_t>(at);
    level[k] = line.level;
    is_closed[k] = line.is_closed;
    length[k] = 0.0;
    const std::size_t points = line.end - line.begin + (line.is_closed ? 1 : 0);
    for (std::size_t i = 0; i < points; ++i, ++at) {
      const Point p = found.points[line.begin + i == line.end ? line.begin : line.begin + i];
      xyz[3 * at] = p.x;
      xyz[3 * at + 1] = p.y;
      xyz[3 * at + 2] = levels.values[line.level];
      if (i > 0) length[k] += measure_length(p.x - xyz[3 * at - 3], p.y - xyz[3 * at - 2]);
    }
  }
  offsets[count] = static_cast<std::int64_t>(at);
  return std::make_tuple(hand_over<Xyz>(std::move(xyz), {total, 3}),
                         hand_over<Offsets>(std::move(offsets), {count + 1}),
                         hand_over<Numbers>(std::move(level), {count}),
                         hand_over<Flags>(std::move(is_closed), {count}),
                         hand_over<Elevations>(std::move(length), {count}));
}

inline auto trace_contours(const GivenXyz& points, const GivenTriples& triangles,
                           const GivenTriples& neighbors, const GivenLevels& levels) {
  const isolines::SurfaceArrays surface = surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  return hand_over_lines(
      unlocked(1, [&](Team& team) { return isolines::trace_lines(surface, wanted, team); }),
      wanted);
}

using GivenOffsets = Given<std::int64_t, -1>;
using GivenClosed = Given<bool, -1>;

// Lines as they were handed over; the places of their points come without those repeated.
inline isolines::TracedLines lines_of(const GivenXyz& xyz, const GivenOffsets& offsets,
                                      const GivenNumbers& level, const GivenClosed& is_closed,
                                      const isolines::Levels& levels) {
  const std::size_t count = level.shape(0);
  const std::int64_t* const offset = offsets.data();
  if (offsets.shape(0) != count + 1 || is_closed.shape(0) != count || offset[0] != 0 ||
      offset[count] != row_count(xyz.shape(0)) || !std::is_sorted(offset, offset + count + 1)) {
    throw std::invalid_argument("offsets must grow from 0 to the number of points");
  }
  isolines::TracedLines lines;
  for (std::size_t k = 0; k < count; ++k) {
    if (level.data()[k] < 0 || level.data()[k] >= levels.count) {
      throw std::invalid_argument("every line needs a level");
    }
    const std::size_t begin = lines.points.size();
    const std::int64_t end = offset[k + 1] - (is_closed.data()[k] ? 1 : 0);
    for (std::int64_t i = offset[k]; i < end; ++i) {
      lines.points.push_back({xyz.data()[3 * i], xyz.data()[3 * i + 1]});
    }
    if (lines.points.size() < begin + (is_closed.data()[k] ? 3 : 2)) {
      throw std::invalid_argument("a line has two points or more, a closed one three");
    }
    lines.lines.push_back({begin, lines.points.size(), level.data()[k], is_closed.data()[k]});
  }
  return lines;
}

inline auto smooth_contours(const GivenXyz& points, const GivenTriples& triangles,
                            const GivenTriples& neighbors, const GivenLevels& levels,
                            const GivenXyz& xyz, const GivenOffsets& offsets,
                            const GivenNumbers& level, const GivenClosed& is_closed,
                            const GivenNumbers& places, double smooth, int rounds,
                            double simplify) {
  const isolines::SurfaceArrays surface = surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  const isolines::TracedLines lines = lines_of(xyz, offsets, level, is_closed, wanted);
  const auto is_sound = [&](std::int32_t t) { return t >= -1 && t < surface.triangle_count; };
  if (places.shape(0) != lines.points.size() ||
      !std::all_of(places.data(), places.data() + places.shape(0), is_sound)) {
    throw std::invalid_argument("every point of a line needs a triangle");
  }
  return hand_over_lines(unlocked(1,
                                  [&](Team& team) {
                                    isolines::LineSmoother smoother(surface, wanted, lines,
                                                                    places.data(), team);
                                    if (smooth > 0.0) smoother.smooth(smooth, rounds);
                                    if (simplify > 0.0) smoother.simplify(simplify);
                                    isolines::TracedLines made = smoother.take();
                                    isolines::sort_lines(made);
                                    return made;
                                  }),
                         wanted);
}

// Points of the rings, offsets of rings and polygons, and the band of each polygon.
inline auto fill_bands(const GivenXyz& points, const GivenTriples& triangles,
                       const GivenTriples& neighbors, const GivenLevels& levels) {
  const isolines::SurfaceArrays surface = surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  const isolines::Bands found =
      unlocked(1, [&](Team& team) { return isolines::fill_bands(surface, wanted, team); });
  return std::make_tuple(
      copy_over<Xy, double>(found.points, {found.points.size(), 2}),
      copy_over<Offsets, std::int64_t>(found.ring_offsets, {found.ring_offsets.size()}),
      copy_over<Offsets, std::int64_t>(found.polygon_offsets, {found.polygon_offsets.size()}),
      copy_over<Numbers, std::int32_t>(found.band, {found.band.size()}));
}

inline void bind_isolines(nb::module_& m) {
  m.def("trace_contours", &trace_contours, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "levels"_a.noconvert(),
        "Contour lines joined: coordinates, offsets, level and whether closed of each.");
  m.def("smooth_contours", &smooth_contours, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "levels"_a.noconvert(), "xyz"_a.noconvert(),
        "offsets"_a.noconvert(), "level"_a.noconvert(), "is_closed"_a.noconvert(),
        "places"_a.noconvert(), "smooth"_a, "rounds"_a, "simplify"_a,
        "The same lines rounder, then with fewer points, within two vertical tolerances; 0 is "
        "neither. places: a triangle for each point but those repeated.");
  m.def("fill_bands", &fill_bands, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "levels"_a.noconvert(),
        "Bands between levels: points of rings, offsets of rings and polygons, band of each.");
}

}  // namespace tinsmith::python
