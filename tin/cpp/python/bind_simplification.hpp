// Bindings of simplification.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <stdexcept>
#include <tuple>

#include "../simplification/simplify.hpp"
#include "bind_mesh.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

inline void require_numbers(const GivenNumbers& numbers, std::size_t size, std::int64_t end,
                            const char* sentence) {
  const auto is_one = [end](std::int32_t number) { return number >= 0 && number < end; };
  if (numbers.shape(0) != size || !are_all(numbers, is_one)) throw std::invalid_argument(sentence);
}

inline auto simplify_arrays(const GivenXyz& points, const GivenNumbers& vertex_rows,
                            const GivenNumbers& holders, const GivenRows& vertices,
                            const GivenTriples& triangles, const GivenTriples& neighbors,
                            const GivenFlags& fixed, double tolerance, std::int32_t most,
                            bool prunes, double above, double below) {
  const auto count = static_cast<std::int32_t>(rows_of(points).count);
  require_numbers(vertex_rows, vertices.shape(0), count, "each vertex must have a row of points");
  require_numbers(holders, points.shape(0), row_count(triangles.shape(0)),
                  "each point must lie in a triangle");
  MeshEditor editor = editor_from(vertices, triangles, neighbors, fixed);
  const Simplified found = [&] {
    ReleasedLock release;
    return simplify(editor, {points.data(), count, vertex_rows.data(), holders.data()},
                    {tolerance, most, {above, below}}, prunes, no_signal);
  }();
  if (!found.is_complete) throw nb::python_error();
  return std::make_tuple(hand_over(found.rows), found.removed);
}

inline void bind_simplification(nb::module_& m) {
  m.def("simplify", &simplify_arrays, "points"_a.noconvert(), "vertex_rows"_a.noconvert(),
        "holders"_a.noconvert(), "vertices"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "fixed"_a.noconvert(), "tolerance"_a, "most"_a, "prunes"_a,
        "above"_a = 1.0, "below"_a = 1.0,
        "Rows of the points that are left, ascending, and how many were removed again.");
}

}  // namespace tinsmith::python
