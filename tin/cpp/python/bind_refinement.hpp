// Bindings of refinement.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>

#include "../refinement/refine.hpp"
#include "bind_mesh.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

struct RefinedArrays {
  Xy points;
  Triples splits;
  Quadruples misses;
  std::int64_t triangle_count;
  bool is_too_many;
};

inline RefinedArrays refine_arrays(const GivenRows& points, const GivenTriples& triangles,
                                   const GivenTriples& neighbors, const GivenFlags& fixed,
                                   const GivenPairs& kept_whole, double least_angle,
                                   double largest_area, double longest_edge, std::int32_t most,
                                   const Listener::Tell& tell) {
  MeshEditor editor = editor_from(points, triangles, neighbors, fixed);
  const VertexPairs whole = pairs_of(kept_whole);
  const Refined refined = unlocked(
      1,
      [&](Team& team) {
        return refine(editor, {least_angle, largest_area, longest_edge}, whole, most, team);
      },
      tell);
  return {copy_over<Xy, double>(refined.points, {refined.points.size(), 2}),
          copy_over<Triples, std::int32_t>(refined.splits, {refined.splits.size() / 3, 3}),
          copy_over<Quadruples, std::int32_t>(refined.misses, {refined.misses.size() / 4, 4}),
          refined.triangle_count, refined.ended == Refiner::Ended::kTooMany};
}

inline void bind_refinement(nb::module_& m) {
  m.def("refine", &refine_arrays, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "fixed"_a.noconvert(), "kept_whole"_a.noconvert(),
        "least_angle"_a, "largest_area"_a, "longest_edge"_a, "most"_a, "progress"_a = nb::none(),
        "Vertices that make a mesh of triangles that reach a goal.");
  Result<RefinedArrays>(m, "Refined", "What refinement adds.")
      .def_array("points", &RefinedArrays::points, "(k, 2), the new vertices.")
      .def_array("splits", &RefinedArrays::splits, "(s, 3), of segments: from, to, middle.")
      .def_array("misses", &RefinedArrays::misses,
                 "(l, 4), triangles that miss the goal: three corners, why.")
      .def_ro("triangle_count", &RefinedArrays::triangle_count, "How many triangles there are.")
      .def_ro("is_too_many", &RefinedArrays::is_too_many,
              "Whether it ended for more vertices than are allowed.");
}

}  // namespace tinsmith::python
