// Bindings of the ground filter.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include "../../../tin/cpp/python/bind_mesh.hpp"
#include "../../../tin/cpp/python/conversion.hpp"
#include "../ground/densification.hpp"

namespace tinsmith::python {

using GivenMarks = Given<bool, -1>;

// Heights above the surface of ground, and its slopes, at points within the hull of the seeds.
inline std::pair<Elevations, Elevations> densify(
    const GivenXyz& seeds, const GivenTriples& triangles, const GivenTriples& neighbors,
    const GivenXyz& points, const GivenMarks& is_candidate, double sine, double distance,
    double full_edge, const Listener::Tell& tell) {
  const std::size_t count = points.shape(0);
  if (is_candidate.shape(0) != count) {
    throw std::invalid_argument("there must be one mark for each point");
  }
  for (const GivenXyz* const given : {&seeds, &points}) {
    if (!are_all(*given, [](double c) { return std::fabs(c) <= kLargestCoordinate; })) {
      throw std::invalid_argument("every coordinate must be finite and within the exact range");
    }
  }
  const PointRows rows = rows_of(seeds);
  const GivenTriangles given = triangles_of(triangles, neighbors, std::nullopt);
  auto heights = streamed_array<double>(count), slopes = streamed_array<double>(count);
  run_unlocked(
      1,
      [&](Team& team) {
        Densification work(rows, given, points.data(), row_count(count),
                           {sine, distance, full_edge});
        if (work.run(is_candidate.data(), team)) work.measure(heights.get(), slopes.get(), team);
      },
      tell);
  return {hand_over<Elevations>(std::move(heights), {count}),
          hand_over<Elevations>(std::move(slopes), {count})};
}

inline void bind_ground(nb::module_& m) {
  m.def("densify", &densify, "seeds"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "points"_a.noconvert(), "is_candidate"_a.noconvert(), "sine"_a,
        "distance"_a, "full_edge"_a, "progress"_a = nb::none(),
        "Heights of points above a TIN of seeds and the points that fit, and its slopes there.");
}

}  // namespace tinsmith::python
