// Bindings of refinement.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <tuple>

#include "../refinement/refine.hpp"
#include "bind_mesh.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

inline auto refine_arrays(const GivenRows& points, const GivenTriples& triangles,
                          const GivenTriples& neighbors, const GivenFlags& fixed,
                          const GivenPairs& kept_whole, double least_angle, double largest_area,
                          double longest_edge, std::int32_t most, const Listener::Tell& tell) {
  MeshEditor editor = editor_from(points, triangles, neighbors, fixed);
  const VertexPairs whole = pairs_of(kept_whole);
  const Refined refined = unlocked(
      1,
      [&](Team& team) {
        return refine(editor, {least_angle, largest_area, longest_edge}, whole, most, team);
      },
      tell);
  return std::make_tuple(copy_over<Xy, double>(refined.points, {refined.points.size(), 2}),
                         hand_over(refined.splits), hand_over(refined.misses),
                         refined.triangle_count, refined.ended == Refiner::Ended::kTooMany);
}

inline void bind_refinement(nb::module_& m) {
  m.def("refine", &refine_arrays, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "fixed"_a.noconvert(), "kept_whole"_a.noconvert(),
        "least_angle"_a, "largest_area"_a, "longest_edge"_a, "most"_a, "progress"_a = nb::none(),
        "New vertices, splits of segments (from, to, middle), triangles that miss the goal "
        "(three corners, why), the number of triangles, and whether there are too many vertices.");
}

}  // namespace tinsmith::python
