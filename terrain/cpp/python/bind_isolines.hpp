// Bindings for contours: lines and bands of a TIN between levels.
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
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

struct ContourLines {
  Xyz coordinates;
  Offsets offsets;
  Numbers level;
  Flags is_closed;
  Elevations length;
};

inline ContourLines hand_over(isolines::LineArrays made) {
  const std::size_t count = made.count;
  return {hand_over<Xyz>(std::move(made.xyz), {made.point_count, 3}),
          hand_over<Offsets>(std::move(made.offsets), {count + 1}),
          hand_over<Numbers>(std::move(made.level), {count}),
          hand_over<Flags>(std::move(made.is_closed), {count}),
          hand_over<Elevations>(std::move(made.length), {count})};
}

inline ContourLines trace_contours(const GivenXyz& points, const GivenTriples& triangles,
                                   const GivenTriples& neighbors, const GivenValues& levels) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  return hand_over(unlocked(1, [&](Team& team) {
    return isolines::LineArrays(isolines::trace_lines(surface, wanted, team), wanted);
  }));
}

// Lines as they were handed over, whose numbers may have been written to since; the places of
// their points come without those repeated.
inline isolines::TracedLines lines_of(const ContourLines& lines, const isolines::Levels& levels) {
  const std::size_t count = lines.level.shape(0);
  const std::int64_t* const offset = lines.offsets.data();
  if (offset[0] != 0 || offset[count] != row_count(lines.coordinates.shape(0)) ||
      !std::is_sorted(offset, offset + count + 1)) {
    throw std::invalid_argument("offsets must grow from 0 to the number of points");
  }
  return isolines::lines_of(
      {lines.coordinates.data(), offset, lines.level.data(), lines.is_closed.data(), count},
      levels);
}

inline ContourLines smooth_contours(const GivenXyz& points, const GivenTriples& triangles,
                                    const GivenTriples& neighbors, const GivenValues& levels,
                                    const ContourLines& given, const GivenNumbers& places,
                                    double smooth, int rounds, double simplify) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  const isolines::TracedLines lines = lines_of(given, wanted);
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

struct BandPolygons {
  Xy points;
  Offsets ring_offsets, polygon_offsets;
  Numbers band;
};

inline BandPolygons fill_bands(const GivenXyz& points, const GivenTriples& triangles,
                               const GivenTriples& neighbors, const GivenValues& levels) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  const isolines::Bands found =
      unlocked(1, [&](Team& team) { return isolines::fill_bands(surface, wanted, team); });
  return {copy_over<Xy, double>(found.points, {found.points.size(), 2}),
          copy_over<Offsets, std::int64_t>(found.ring_offsets, {found.ring_offsets.size()}),
          copy_over<Offsets, std::int64_t>(found.polygon_offsets, {found.polygon_offsets.size()}),
          hand_over(found.band)};
}

inline void bind_isolines(nb::module_& m) {
  m.def("trace_contours", &trace_contours, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "levels"_a.noconvert(), "Contour lines, joined.");
  m.def("smooth_contours", &smooth_contours, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "levels"_a.noconvert(), "lines"_a, "places"_a.noconvert(),
        "smooth"_a, "rounds"_a, "simplify"_a,
        "The same lines rounder, then with fewer points, within two vertical tolerances; 0 is "
        "neither. places: a triangle for each point but those repeated.");
  m.def("fill_bands", &fill_bands, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "levels"_a.noconvert(), "Polygons of the bands between levels.");
  Result<ContourLines>(m, "ContourLines", "Contour lines one after the other.")
      .def_array("coordinates", &ContourLines::coordinates,
                 "(n, 3), of closed lines the first point is repeated.")
      .def_array("offsets", &ContourLines::offsets, "(k + 1,), where those of each line begin.")
      .def_array("level", &ContourLines::level, "(k,), place in the levels.")
      .def_array("is_closed", &ContourLines::is_closed, "(k,).")
      .def_array("length", &ContourLines::length, "(k,), in the plane of the coordinates.");
  Result<BandPolygons>(m, "BandPolygons", "Polygons with holes, by band.")
      .def_array("points", &BandPolygons::points, "(n, 2), of rings.")
      .def_array("ring_offsets", &BandPolygons::ring_offsets, "(r + 1,), into points.")
      .def_array("polygon_offsets", &BandPolygons::polygon_offsets, "(k + 1,), into rings.")
      .def_array("band", &BandPolygons::band, "(k,), of each polygon.");
}

}  // namespace tinsmith::python
