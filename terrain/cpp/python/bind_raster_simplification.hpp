// Bindings of the simplification of rasters.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "../../../tin/cpp/python/bind_mesh.hpp"
#include "../../../tin/cpp/python/conversion.hpp"
#include "../../../tin/cpp/simplification/simplify.hpp"
#include "../simplification/cell_errors.hpp"
#include "../simplification/cell_mesh.hpp"

namespace tinsmith::python {

inline CellElevations elevations_of(const GivenValues& x, const GivenValues& y,
                                    const GivenRows& z) {
  if (z.shape(0) != y.shape(0) || z.shape(1) != x.shape(0)) {
    throw std::invalid_argument("there must be an elevation for each column and row");
  }
  row_count(z.size(), INT32_MAX - kMostLanes);
  return {x.data(), y.data(), z.data(), static_cast<std::int32_t>(x.shape(0)),
          static_cast<std::int32_t>(y.shape(0))};
}

inline auto simplify_cell_arrays(const GivenValues& x, const GivenValues& y, const GivenRows& z,
                                 const GivenNumbers& vertex_cells, const GivenRows& vertices,
                                 const GivenTriples& triangles, const GivenTriples& neighbors,
                                 const GivenFlags& fixed, double tolerance, std::int32_t most,
                                 bool prunes, const std::string& path) {
  const VectorPath vectors = vector_path_named(path);
  const CellElevations grid = elevations_of(x, y, z);
  const auto is_cell = [&](std::int32_t cell) {
    return cell >= 0 && static_cast<std::size_t>(cell) < grid.count();
  };
  if (vertex_cells.shape(0) != vertices.shape(0) || !are_all(vertex_cells, is_cell)) {
    throw std::invalid_argument("each vertex must be a cell");
  }
  MeshEditor editor = editor_from(vertices, triangles, neighbors, fixed);
  const Simplified found = [&] {
    ReleasedLock release;
    CellMesh mesh(editor, grid, vertex_cells.data(), tolerance, vectors);
    if (!mesh.measure_all(no_signal)) return Simplified{{}, 0, false};
    const Vertex first{editor.slots()};
    return simplify_mesh(mesh, first, {tolerance, most}, prunes, no_signal);
  }();
  if (!found.is_complete) throw nb::python_error();
  return std::make_tuple(hand_over(found.rows), found.removed);
}

inline auto measure_cell_arrays(const GivenRows& z, const GivenPairs& cells,
                                const GivenValues& elevations, const GivenTriples& triangles) {
  if (elevations.shape(0) != cells.shape(0)) {
    throw std::invalid_argument("each vertex must have a cell and an elevation");
  }
  corners_of(triangles, row_count(cells.shape(0)));
  const std::size_t rows = z.shape(0), columns = z.shape(1);
  row_count(std::max(rows, columns));
  auto errors = streamed_array<double>(rows * columns);
  {
    ReleasedLock release;
    std::fill(errors.get(), errors.get() + rows * columns, kNoElevation);
    CellErrors(z.data(), static_cast<std::int32_t>(columns), static_cast<std::int32_t>(rows),
               errors.get())
        .write({reinterpret_cast<const Cell*>(cells.data()), elevations.data(), triangles.data(),
                triangles.shape(0)});
  }
  return hand_over<Made<double, -1, -1>>(std::move(errors), {rows, columns});
}

inline void bind_raster_simplification(nb::module_& m) {
  m.def("simplify_cells", &simplify_cell_arrays, "x"_a.noconvert(), "y"_a.noconvert(),
        "z"_a.noconvert(), "vertex_cells"_a.noconvert(), "vertices"_a.noconvert(),
        "triangles"_a.noconvert(), "neighbors"_a.noconvert(), "fixed"_a.noconvert(), "tolerance"_a,
        "most"_a, "prunes"_a, "path"_a = vector_paths().back().name,
        "Cells that are left, ascending, and how many were removed again.");
  m.def("measure_cells", &measure_cell_arrays, "z"_a.noconvert(), "cells"_a.noconvert(),
        "elevations"_a.noconvert(), "triangles"_a.noconvert(),
        "How far cells are from a surface between cells in elevation; NaN where there is none.");
}

}  // namespace tinsmith::python
