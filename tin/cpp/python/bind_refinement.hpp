// Bindings of refinement.
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <cstdint>
#include <utility>

#include "../refinement/refine.hpp"
#include "bind_mesh.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

struct RefinedArrays {
  Xy points;
  Triples splits;
  Quadruples misses;
  std::int64_t triangle_count;
  bool is_too_many, has_surface;
  Triples triangles, neighbors;
  TripleFlags constrained;
};

inline RefinedArrays refine_arrays(const GivenXyz& points, const GivenTriples& triangles,
                                   const GivenTriples& neighbors, const GivenFlags& fixed,
                                   const GivenPairs& kept_whole, double least_angle,
                                   double largest_area, double longest_edge, std::int32_t most,
                                   int threads, const Listener::Tell& tell) {
  const GivenTriangles given = triangles_of(triangles, neighbors, fixed);
  const VertexPairs whole = pairs_of(kept_whole);
  const RefinementGoal goal{least_angle, largest_area, longest_edge};
  Refined refined = unlocked(
      threads, [&](Team& team) { return refine(rows_of(points), given, goal, whole, most, team); },
      tell);
  RefinedSurface surface = refined.surface ? std::move(*refined.surface) : RefinedSurface{};
  const std::size_t count = surface.triangle_count;
  return {copy_over<Xy, double>(refined.points, {refined.points.size(), 2}),
          copy_over<Triples, std::int32_t>(refined.splits, {refined.splits.size() / 3, 3}),
          copy_over<Quadruples, std::int32_t>(refined.misses, {refined.misses.size() / 4, 4}),
          refined.triangle_count,
          refined.ended == Refiner::Ended::kTooMany,
          refined.surface.has_value(),
          hand_over<Triples>(std::move(surface.corners), {count, 3}),
          hand_over<Triples>(std::move(surface.neighbors), {count, 3}),
          hand_over<TripleFlags>(std::move(surface.fixed), {count, 3})};
}

inline void bind_refinement(nb::module_& m) {
  m.def("refine", &refine_arrays, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "fixed"_a.noconvert(), "kept_whole"_a.noconvert(),
        "least_angle"_a, "largest_area"_a, "longest_edge"_a, "most"_a, "threads"_a,
        "progress"_a = nb::none(), "Vertices that make a mesh of triangles that reach a goal.");
  Result<RefinedArrays>(m, "Refined", "What refinement adds.")
      .def_array("points", &RefinedArrays::points, "(k, 2), the new vertices.")
      .def_array("splits", &RefinedArrays::splits, "(s, 3), of segments: from, to, middle.")
      .def_array("misses", &RefinedArrays::misses,
                 "(l, 4), triangles that miss the goal: three corners, why.")
      .def_array("triangles", &RefinedArrays::triangles,
                 "(t, 3), of all vertices, the new ones behind the given ones; if has_surface.")
      .def_array("neighbors", &RefinedArrays::neighbors, "(t, 3), the triangles across.")
      .def_array("constrained", &RefinedArrays::constrained, "(t, 3), which edges are fixed.")
      .def_ro("triangle_count", &RefinedArrays::triangle_count, "How many triangles there are.")
      .def_ro("has_surface", &RefinedArrays::has_surface,
              "Whether the triangles are known: else the boundary must be looked at.")
      .def_ro("is_too_many", &RefinedArrays::is_too_many,
              "Whether it ended for more vertices than are allowed.");
}

}  // namespace tinsmith::python
