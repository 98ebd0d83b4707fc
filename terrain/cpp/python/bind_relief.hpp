// Bindings of slopes and curvatures.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "../../../tin/cpp/python/conversion.hpp"
#include "../relief/normals.hpp"
#include "../relief/quadratic_fit.hpp"
#include "../relief/shading.hpp"

namespace tinsmith::python {

using Shades = Made<std::uint8_t, -1>;
using Derivatives = Made<double, QuadraticFit::kTerms, -1>;

inline std::pair<Xyz, Numbers> triangle_normals(const GivenXyz& points,
                                                const GivenTriples& triangles, int threads) {
  const Surface surface = surface_of(points, triangles);
  auto normals = streamed_array<double>(3 * triangles.shape(0));
  const auto slivers =
      unlocked(threads, [&](Team& team) { return compute_normals(surface, normals.get(), team); });
  return {hand_over<Xyz>(std::move(normals), {triangles.shape(0), 3}), hand_over(slivers)};
}

inline Xyz vertex_normals(const GivenXyz& points, const GivenTriples& triangles,
                          const GivenXyz& normals, int threads) {
  const Surface surface = surface_of(points, triangles);
  if (normals.shape(0) != triangles.shape(0)) {
    throw std::invalid_argument("there must be one normal for each triangle");
  }
  auto sums = streamed_array<double>(3 * points.shape(0));
  run_unlocked(threads,
               [&](Team& team) { sum_at_vertices(surface, normals.data(), sums.get(), team); });
  return hand_over<Xyz>(std::move(sums), {points.shape(0), 3});
}

inline Derivatives fit_quadratics(const GivenXyz& points, const GivenTriples& triangles,
                                  const GivenValues& east, const GivenValues& north, double up,
                                  int threads) {
  const Surface surface = surface_of(points, triangles);
  const std::size_t count = points.shape(0), given = east.shape(0);
  if (given != north.shape(0) || (given != 1 && given != count)) {
    throw std::invalid_argument("there must be one factor for all vertices or for each");
  }
  const VertexScales scales{east.data(), north.data(), up, given != 1};
  auto derivatives = streamed_array<double>(QuadraticFit::kTerms * count);
  run_unlocked(threads,
               [&](Team& team) { QuadraticFit::run(surface, scales, derivatives.get(), team); });
  return hand_over<Derivatives>(std::move(derivatives), {QuadraticFit::kTerms, count});
}

inline Shades shade_planes(const GivenXyz& normals, double east, double north, double up,
                           std::uint8_t darkest, std::uint8_t brightest) {
  const std::size_t count = normals.shape(0);
  auto shades = streamed_array<std::uint8_t>(count);
  {
    ReleasedLock release;
    tinsmith::shade_planes(normals.data(), count, {east, north, up}, darkest, brightest,
                           shades.get());
  }
  return hand_over<Shades>(std::move(shades), {count});
}

inline void bind_relief(nb::module_& m) {
  m.def("triangle_normals", &triangle_normals, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "threads"_a = 1, "Upward normals of triangles; numbers of those too thin for doubles.");
  m.def("vertex_normals", &vertex_normals, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "normals"_a.noconvert(), "threads"_a = 1, "Sums of the triangles' normals at each vertex.");
  m.def("shade_planes", &shade_planes, "normals"_a.noconvert(), "east"_a, "north"_a, "up"_a,
        "darkest"_a, "brightest"_a, "Brightness of planes under a light from a direction.");
  m.def("fit_quadratics", &fit_quadratics, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "east"_a.noconvert(), "north"_a.noconvert(), "up"_a, "threads"_a = 1,
        "Derivatives x, y, xx, xy, yy of the quadratic surface that fits around each vertex.");
}

}  // namespace tinsmith::python
