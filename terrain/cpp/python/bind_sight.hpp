// Bindings of viewsheds.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "../../../tin/cpp/python/conversion.hpp"
#include "../sight/cell_sides.hpp"
#include "../sight/seen_parts.hpp"
#include "../sight/seen_vertices.hpp"

namespace tinsmith::python {

using GivenEye = Given<double, 3>;
using GivenMask = Given<bool, -1>;
using Verdicts = Made<std::uint8_t, -1>;

inline Surface seen_surface(const GivenXyz& points, const GivenTriples& triangles,
                            const GivenTriples& neighbors) {
  const Surface surface = surface_of(points, triangles, &neighbors);
  require_exact_points(surface);
  if (surface.has_sound_neighbors()) return surface;
  throw std::invalid_argument("neighbors must be triangles or -1");
}

inline Verdicts find_seen_vertices(const GivenXyz& points, const GivenTriples& triangles,
                                   const GivenTriples& neighbors, const GivenMask& wanted,
                                   const GivenEye& eye, double target_height, double radius,
                                   double fall, int threads) {
  const Surface surface = seen_surface(points, triangles, neighbors);
  if (wanted.shape(0) != points.shape(0)) {
    throw std::invalid_argument("there must be one flag for each point");
  }
  const double* const at = eye.data();
  const sight::View view{{{at[0], at[1]}, at[2]}, target_height, radius};
  auto seen = streamed_array<sight::Sight>(points.shape(0));
  for (std::size_t i = 0; i < points.shape(0); ++i) {
    seen[i] = wanted.data()[i] ? sight::Sight::kSeen : sight::Sight::kHidden;
  }
  run_unlocked(threads, [&](Team& team) {
    sight::find_seen_vertices(surface, view, fall, seen.get(), team);
  });
  StreamedArray<std::uint8_t> numbers(reinterpret_cast<std::uint8_t*>(seen.release()));
  return hand_over<Verdicts>(std::move(numbers), {points.shape(0)});
}

// Parts of triangles, and the cells of divided ones.
struct SeenParts {
  Verdicts parts;
  Offsets offsets;
  Numbers triangles;
  Flags is_seen;
  Xy corners;
  Offsets lines;
};

inline SeenParts find_seen_parts(const GivenXyz& points, const GivenTriples& triangles,
                                 const GivenTriples& neighbors, const GivenEye& eye,
                                 double target_height, int threads) {
  const Surface surface = seen_surface(points, triangles, neighbors);
  const double* const at = eye.data();
  const double infinite = std::numeric_limits<double>::infinity();
  const sight::View view{{{at[0], at[1]}, at[2]}, target_height, infinite};
  std::vector<sight::Part> parts(triangles.shape(0), sight::Part::kNone);
  sight::Cells cells;
  run_unlocked(threads, [&](Team& team) {
    sight::find_seen_parts(surface, view, parts.data(), cells, team);
  });
  return {copy_over<Verdicts, std::uint8_t>(parts, {parts.size()}),
          copy_over<Offsets, std::int64_t>(cells.offsets, {cells.offsets.size()}),
          hand_over(cells.triangles),
          copy_over<Flags, bool>(cells.seen, {cells.seen.size()}),
          copy_over<Xy, double>(cells.corners, {cells.corners.size(), 2}),
          copy_over<Offsets, std::int64_t>(cells.lines, {cells.lines.size()})};
}

using GivenWholes = Given<std::int64_t, -1>;

// Corners of each cell, and all corners and lines, with those of other cells on the sides.
inline std::tuple<Offsets, Offsets, Offsets> complete_sides(const GivenXy& points,
                                                            const GivenWholes& counts,
                                                            const GivenWholes& corners,
                                                            const GivenWholes& lines,
                                                            std::int64_t line_count) {
  const auto is_vertex = [&](std::int64_t v) {
    return 0 <= v && v < static_cast<std::int64_t>(points.shape(0));
  };
  const auto is_line = [=](std::int64_t line) { return line < line_count; };
  std::int64_t sum = 0;
  for (std::size_t c = 0; c < counts.shape(0); ++c) {
    const std::int64_t count = counts.data()[c];
    if (count < 1 || count > INT32_MAX) throw std::invalid_argument("cells must have corners");
    sum += count;
  }
  if (sum != static_cast<std::int64_t>(corners.shape(0)) || sum >= UINT32_MAX ||
      lines.shape(0) != corners.shape(0) || !are_all(corners, is_vertex) ||
      !are_all(lines, is_line)) {
    throw std::invalid_argument("corners must be of points, with a line for each");
  }
  const sight::CellSides given{points_of(points), counts.data(),    counts.shape(0), corners.data(),
                               lines.data(),      corners.shape(0), line_count};
  const auto found = unlocked(1, [&](Team& team) {
    Pulse pulse(team);
    return sight::SideCompletion(given).run(pulse);
  });
  return {copy_over<Offsets, std::int64_t>(found.counts, {found.counts.size()}),
          copy_over<Offsets, std::int64_t>(found.corners, {found.corners.size()}),
          copy_over<Offsets, std::int64_t>(found.lines, {found.lines.size()})};
}

inline void bind_sight(nb::module_& m) {
  m.def("find_seen_vertices", &find_seen_vertices, "points"_a.noconvert(),
        "triangles"_a.noconvert(), "neighbors"_a.noconvert(), "wanted"_a.noconvert(),
        "eye"_a.noconvert(), "target_height"_a, "radius"_a, "fall"_a, "threads"_a = 1,
        "Of the vertices wanted: 0 hidden, 1 seen, 2 not known (with a fall alone).");
  m.def("find_seen_parts", &find_seen_parts, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "eye"_a.noconvert(), "target_height"_a, "threads"_a = 1,
        "Which triangles are seen, and cells of those that are divided.");
  m.def("complete_sides", &complete_sides, "points"_a.noconvert(), "counts"_a.noconvert(),
        "corners"_a.noconvert(), "lines"_a.noconvert(), "line_count"_a,
        "Cells with the corners of others that lie on their sides: counts, corners and lines.");
  Result<SeenParts>(m, "SeenParts", "Triangles that are seen, hidden, or divided into cells.")
      .def_array("parts", &SeenParts::parts,
                 "(m,), of triangles: 0 hidden, 1 seen, 2 divided, 3 too thin.")
      .def_array("offsets", &SeenParts::offsets, "(k + 1,), where the corners of cells begin.")
      .def_array("triangles", &SeenParts::triangles, "(k,), that cells are part of.")
      .def_array("is_seen", &SeenParts::is_seen, "(k,), whether cells are seen.")
      .def_array("corners", &SeenParts::corners, "(c, 2), of cells, counter-clockwise.")
      .def_array("lines", &SeenParts::lines,
                 "(c,), numbers of the lines on which the sides after the corners lie, -1 for "
                 "none.");
}

}  // namespace tinsmith::python
