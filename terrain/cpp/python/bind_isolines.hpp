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

#include "../../../tin/cpp/python/conversion.hpp"
#include "../isolines/band_filling.hpp"
#include "../isolines/line_arrays.hpp"
#include "../isolines/line_smoothing.hpp"
#include "../isolines/line_tracing.hpp"

namespace tinsmith::python {

inline Surface joined_surface_of(const GivenXyz& points, const GivenTriples& triangles,
                                 const GivenTriples& neighbors) {
  const Surface surface = surface_of(points, triangles, &neighbors);
  if (!surface.has_sound_neighbors()) {
    throw std::invalid_argument("neighbors must be numbers of triangles or -1");
  }
  return surface;
}

inline isolines::Levels levels_of(const GivenValues& levels) {
  const double* const end = levels.data() + levels.shape(0);
  const auto ascends = [](double a, double b) { return !(a < b); };
  if (std::adjacent_find(levels.data(), end, ascends) != end ||
      !are_all(levels, [](double level) { return std::isfinite(level); })) {
    throw std::invalid_argument("levels must be finite and ascend");
  }
  return {levels.data(), row_count(levels.shape(0))};
}

// Coordinates and offsets, and of each line its level, whether it is closed, and its length.
inline auto hand_over(isolines::LineArrays made) {
  const std::size_t count = made.count;
  return std::make_tuple(hand_over<Xyz>(std::move(made.xyz), {made.point_count, 3}),
                         hand_over<Offsets>(std::move(made.offsets), {count + 1}),
                         hand_over<Numbers>(std::move(made.level), {count}),
                         hand_over<Flags>(std::move(made.is_closed), {count}),
                         hand_over<Elevations>(std::move(made.length), {count}));
}

inline auto trace_contours(const GivenXyz& points, const GivenTriples& triangles,
                           const GivenTriples& neighbors, const GivenValues& levels) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  return hand_over(unlocked(1, [&](Team& team) {
    return isolines::LineArrays(isolines::trace_lines(surface, wanted, team), wanted);
  }));
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
  return isolines::lines_of({xyz.data(), offset, level.data(), is_closed.data(), count}, levels);
}

inline auto smooth_contours(const GivenXyz& points, const GivenTriples& triangles,
                            const GivenTriples& neighbors, const GivenValues& levels,
                            const GivenXyz& xyz, const GivenOffsets& offsets,
                            const GivenNumbers& level, const GivenClosed& is_closed,
                            const GivenNumbers& places, double smooth, int rounds,
                            double simplify) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  const isolines::TracedLines lines = lines_of(xyz, offsets, level, is_closed, wanted);
  const auto is_sound = [&](std::int32_t t) {
    return t == kNoNeighbor || surface.is_triangle(triangle_numbered(t));
  };
  if (places.shape(0) != lines.points.size() || !are_all(places, is_sound)) {
    throw std::invalid_argument("every point of a line needs a triangle");
  }
  return hand_over(unlocked(1, [&](Team& team) {
    isolines::LineSmoother smoother(surface, wanted, lines, places.data(), team);
    if (smooth > 0.0) smoother.smooth(smooth, rounds);
    if (simplify > 0.0) smoother.simplify(simplify);
    isolines::TracedLines made = smoother.take();
    isolines::sort_lines(made);
    return isolines::LineArrays(made, wanted);
  }));
}

// Points of the rings, offsets of rings and polygons, and the band of each polygon.
inline auto fill_bands(const GivenXyz& points, const GivenTriples& triangles,
                       const GivenTriples& neighbors, const GivenValues& levels) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  const isolines::Bands found =
      unlocked(1, [&](Team& team) { return isolines::fill_bands(surface, wanted, team); });
  return std::make_tuple(
      copy_over<Xy, double>(found.points, {found.points.size(), 2}),
      copy_over<Offsets, std::int64_t>(found.ring_offsets, {found.ring_offsets.size()}),
      copy_over<Offsets, std::int64_t>(found.polygon_offsets, {found.polygon_offsets.size()}),
      hand_over(found.band));
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
