// Bindings of gridding.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../../../tin/cpp/python/conversion.hpp"
#include "../gridding/centers.hpp"
#include "../gridding/means.hpp"

namespace tinsmith::python {

using Cells = Made<double, -1, -1>;
using CellVectors = Made<double, -1, -1, 3>;
// Cells, those whose centres lie on edges or vertices, and on which.
using SharedCells = std::tuple<Cells, Offsets, Offsets>;

using CellSize = std::pair<double, double>;  // width and height

inline CellGrid grid_of(const GivenValues& x, const GivenValues& y, const CellSize& size) {
  if (x.shape(0) == 0 || y.shape(0) == 0) throw std::invalid_argument("a grid has cells");
  return {x.data(),   y.data(),   row_count(x.shape(0)), row_count(y.shape(0)),
          size.first, size.second};
}

template <typename Draw>
Cells draw_cells(const CellGrid& grid, int threads, const Listener::Tell& tell, Draw&& draw) {
  const auto rows = static_cast<std::size_t>(grid.rows);
  const auto columns = static_cast<std::size_t>(grid.columns);
  auto cells = streamed_array<double>(rows * columns);
  run_unlocked(threads, [&](Team& team) { draw(cells.get(), team); }, tell);
  return hand_over<Cells>(std::move(cells), {rows, columns});
}

// A surface in an order for drawing, for any number of blocks of cells.
class GriddedSurface {
 public:
  GriddedSurface(const GivenXyz& points, const GivenTriples& triangles)
      : ordered_(order(surface_of(points, triangles))) {}

  Cells values_at_centers(const GivenValues& x, const GivenValues& y, const CellSize& size,
                          const std::optional<GivenValues>& values, int threads,
                          const Listener::Tell& tell) const {
    const CellGrid grid = grid_of(x, y, size);
    const double* each = values_of(values);
    return draw_cells(grid, threads, tell, [&](double* cells, Team& team) {
      if (each == nullptr) {
        scan(grid, ElevationPaint{ordered_, cells}, team);
      } else {
        scan(grid, TrianglePaint{ordered_, each, cells}, team);
      }
    });
  }

  SharedCells triangles_at_centers(const GivenValues& x, const GivenValues& y, const CellSize& size,
                                   const GivenValues& values, int threads,
                                   const Listener::Tell& tell) const {
    const CellGrid grid = grid_of(x, y, size);
    const double* each = values_of(values);
    std::vector<SharedCenter> shared;
    Cells drawn = draw_cells(grid, threads, tell, [&](double* cells, Team& team) {
      scan(grid, TrianglePaint{ordered_, each, cells}, team, &shared);
    });
    std::vector<std::int64_t> places(shared.size()), parts(shared.size());
    for (std::size_t i = 0; i < shared.size(); ++i) {
      places[i] = shared[i].place;
      parts[i] = shared[i].part;
    }
    return {drawn, copy_over<Offsets, std::int64_t>(places, {places.size()}),
            copy_over<Offsets, std::int64_t>(parts, {parts.size()})};
  }

  CellVectors vectors_at_centers(const GivenValues& x, const GivenValues& y, const CellSize& size,
                                 const GivenXyz& vectors, int threads,
                                 const Listener::Tell& tell) const {
    const CellGrid grid = grid_of(x, y, size);
    if (vectors.shape(0) != static_cast<std::size_t>(ordered_.surface().point_count)) {
      throw std::invalid_argument("there must be one vector for each vertex");
    }
    const auto rows = static_cast<std::size_t>(grid.rows);
    const auto columns = static_cast<std::size_t>(grid.columns);
    auto cells = streamed_array<double>(3 * rows * columns);
    run_unlocked(
        threads,
        [&](Team& team) { scan(grid, VectorPaint{ordered_, vectors.data(), cells.get()}, team); },
        tell);
    return hand_over<CellVectors>(std::move(cells), {rows, columns, 3});
  }

  Cells means_of_cells(const GivenValues& x, const GivenValues& y, const CellSize& size,
                       const GivenValues& x_edges, const GivenValues& y_edges,
                       const std::optional<GivenValues>& values, int threads,
                       const Listener::Tell& tell) const {
    const CellGrid grid = grid_of(x, y, size);
    if (x_edges.shape(0) != x.shape(0) + 1 || y_edges.shape(0) != y.shape(0) + 1) {
      throw std::invalid_argument("columns and rows have one edge more than centres");
    }
    const double* each = values_of(values);
    return draw_cells(grid, threads, tell, [&](double* cells, Team& team) {
      MeanScan::run(ordered_, grid, x_edges.data(), y_edges.data(), each, cells, team);
    });
  }

 private:
  template <typename Paint>
  void scan(const CellGrid& grid, const Paint& paint, Team& team,
            std::vector<SharedCenter>* shared = nullptr) const {
    CenterScan<Paint>::run(ordered_, grid, paint, team, shared);
  }

  static OrderedSurface order(const Surface& surface) {
    ReleasedLock release;
    return OrderedSurface(surface);
  }

  const double* values_of(const std::optional<GivenValues>& values) const {
    if (!values) return nullptr;
    if (values->shape(0) != ordered_.surface().triangle_count) {
      throw std::invalid_argument("there must be one value for each triangle");
    }
    return values->data();
  }

  OrderedSurface ordered_;
};

inline void bind_gridding(nb::module_& m) {
  m.attr("TILE_SIDE") = Tiles::kSide;
  nb::class_<GriddedSurface>(m, "GriddedSurface", "A surface to draw blocks of cells of.")
      .def(nb::init<const GivenXyz&, const GivenTriples&>(), "points"_a.noconvert(),
           "triangles"_a.noconvert())
      .def("values_at_centers", &GriddedSurface::values_at_centers, "x"_a.noconvert(),
           "y"_a.noconvert(), "size"_a, "values"_a.none(), "threads"_a = 1,
           "progress"_a = nb::none(),
           "Elevations, or values of triangles, at the centres of cells; NaN outside.")
      .def("triangles_at_centers", &GriddedSurface::triangles_at_centers, "x"_a.noconvert(),
           "y"_a.noconvert(), "size"_a, "values"_a.noconvert(), "threads"_a = 1,
           "progress"_a = nb::none(),
           "Values of triangles at centres; the cells whose centres lie on edges and vertices.")
      .def("vectors_at_centers", &GriddedSurface::vectors_at_centers, "x"_a.noconvert(),
           "y"_a.noconvert(), "size"_a, "vectors"_a.noconvert(), "threads"_a = 1,
           "progress"_a = nb::none(),
           "Vectors of vertices, which change evenly between them, at centres; NaN outside.")
      .def("means_of_cells", &GriddedSurface::means_of_cells, "x"_a.noconvert(), "y"_a.noconvert(),
           "size"_a, "x_edges"_a.noconvert(), "y_edges"_a.noconvert(), "values"_a.none(),
           "threads"_a = 1, "progress"_a = nb::none(),
           "Means over the parts of cells that the surface covers; NaN where it covers none.");
}

}  // namespace tinsmith::python
