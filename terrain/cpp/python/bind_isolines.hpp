// Bindings for contours: lines and bands of a TIN between levels.
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../../../tin/cpp/python/conversion.hpp"
#include "../isolines/band_filling.hpp"
#include "../isolines/line_arrays.hpp"
#include "../isolines/line_pieces.hpp"
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

using TriangleNames = Made<std::int64_t, -1, 3>;

struct LinePieces {
  Xy points;
  Offsets offsets;
  Numbers level;
  TriangleNames first, next;
};

inline void require_owned(const Given<bool, -1>& is_owned, const Surface& surface) {
  if (is_owned.shape(0) != surface.triangle_count) {
    throw std::invalid_argument("a flag for each triangle is needed");
  }
}

inline LinePieces trace_pieces(const GivenXyz& points, const GivenTriples& triangles,
                               const GivenTriples& neighbors, const GivenValues& levels,
                               const Given<bool, -1>& is_owned,
                               const Given<std::int64_t, -1>& names) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  require_owned(is_owned, surface);
  if (names.shape(0) != points.shape(0)) {
    throw std::invalid_argument("a number for each point is needed");
  }
  const isolines::LinePieces found = unlocked(1, [&](Team& team) {
    return isolines::trace_pieces(surface, wanted, is_owned.data(), names.data(), team);
  });
  const std::size_t count = found.level.size();
  return {copy_over<Xy, double>(found.points, {found.points.size(), 2}),
          copy_over<Offsets, std::int64_t>(found.offsets, {count + 1}), hand_over(found.level),
          copy_over<TriangleNames, std::int64_t>(found.first, {count, 3}),
          copy_over<TriangleNames, std::int64_t>(found.next, {count, 3})};
}

inline ContourLines settle_contours(const GivenXyz& coordinates,
                                    const Given<std::int64_t, -1>& offsets,
                                    const GivenNumbers& line_levels,
                                    const Given<bool, -1>& are_closed, const GivenValues& levels) {
  const isolines::Levels wanted = levels_of(levels);
  const std::size_t count = line_levels.shape(0);
  const std::int64_t* const offset = offsets.data();
  if (offsets.shape(0) != count + 1 || are_closed.shape(0) != count || offset[0] != 0 ||
      offset[count] != row_count(coordinates.shape(0)) ||
      !std::is_sorted(offset, offset + count + 1)) {
    throw std::invalid_argument("offsets must grow from 0 to the number of points");
  }
  return hand_over(unlocked(1, [&](Team&) {
    return isolines::LineArrays(
        isolines::settle_lines(
            {coordinates.data(), offset, line_levels.data(), are_closed.data(), count}, wanted),
        wanted);
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

inline BandPolygons hand_over(const isolines::Bands& found) {
  return {copy_over<Xy, double>(found.points, {found.points.size(), 2}),
          copy_over<Offsets, std::int64_t>(found.ring_offsets, {found.ring_offsets.size()}),
          copy_over<Offsets, std::int64_t>(found.polygon_offsets, {found.polygon_offsets.size()}),
          hand_over(found.band)};
}

inline BandPolygons fill_bands(const GivenXyz& points, const GivenTriples& triangles,
                               const GivenTriples& neighbors, const GivenValues& levels) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  const isolines::Bands found =
      unlocked(1, [&](Team& team) { return isolines::fill_bands(surface, wanted, team); });
  return hand_over(found);
}

struct BandBoundaries {
  Made<double, -1, 4> segments;
  Offsets offsets;
};

inline BandBoundaries list_band_boundaries(const GivenXyz& points, const GivenTriples& triangles,
                                           const GivenTriples& neighbors, const GivenValues& levels,
                                           const Given<bool, -1>& is_owned) {
  const Surface surface = joined_surface_of(points, triangles, neighbors);
  const isolines::Levels wanted = levels_of(levels);
  require_owned(is_owned, surface);
  const isolines::BandBoundaries found = unlocked(1, [&](Team& team) {
    const isolines::LevelSurface level_surface(surface, wanted);
    return isolines::BandFiller(level_surface, team, is_owned.data()).list_boundaries();
  });
  return {copy_over<Made<double, -1, 4>, double>(found.segments, {found.segments.size(), 4}),
          copy_over<Offsets, std::int64_t>(found.offsets, {found.offsets.size()})};
}

inline BandPolygons fill_band(const Given<double, -1, 4>& segments, std::int32_t band) {
  std::vector<isolines::BoundarySegment> boundary;
  const double* row = segments.data();
  for (std::size_t i = 0; i < segments.shape(0); ++i, row += 4) {
    boundary.push_back({{row[0], row[1]}, {row[2], row[3]}});
  }
  return hand_over(unlocked(1, [&](Team&) {
    isolines::PolygonMaker maker;
    maker.add(std::move(boundary), band);
    return maker.take();
  }));
}

inline void bind_isolines(nb::module_& m) {
  m.def("trace_pieces", &trace_pieces, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "levels"_a.noconvert(), "is_owned"_a.noconvert(),
        "names"_a.noconvert(), "Contour lines within some triangles of a larger surface.");
  m.def("settle_contours", &settle_contours, "coordinates"_a.noconvert(), "offsets"_a.noconvert(),
        "line_levels"_a.noconvert(), "are_closed"_a.noconvert(), "levels"_a.noconvert(),
        "Contour lines, in order, of all points that they run through.");
  m.def("list_band_boundaries", &list_band_boundaries, "points"_a.noconvert(),
        "triangles"_a.noconvert(), "neighbors"_a.noconvert(), "levels"_a.noconvert(),
        "is_owned"_a.noconvert(), "Segments around the bands within some triangles.");
  m.def("fill_band", &fill_band, "segments"_a.noconvert(), "band"_a,
        "Polygons of a band of all segments around it.");
  Result<LinePieces>(m, "LinePieces", "Pieces of contour lines one after the other.")
      .def_array("points", &LinePieces::points, "(n, 2).")
      .def_array("offsets", &LinePieces::offsets, "(k + 1,), where those of each piece begin.")
      .def_array("level", &LinePieces::level, "(k,), place in the levels.")
      .def_array("first", &LinePieces::first,
                 "(k, 3), the corners of the triangle that it begins in; -1 for the boundary, -2 "
                 "where it is closed.")
      .def_array("next", &LinePieces::next, "(k, 3), of the triangle that it goes on in.");
  Result<BandBoundaries>(m, "BandBoundaries", "Directed segments around bands.")
      .def_array("segments", &BandBoundaries::segments, "(n, 4), from and to.")
      .def_array("offsets", &BandBoundaries::offsets, "(k + 1,), those of each band.");
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
