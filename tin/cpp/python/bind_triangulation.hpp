// Bindings of the main path: points become triangles.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../mesh/mesh_arrays.hpp"
#include "../triangulation.hpp"
#include "bind_mesh.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

inline Triangulation triangulate(const GivenXyz& points, const Options& options,
                                 const Listener::Tell& tell) {
  const PointRows rows = rows_of(points);
  if (options.threads < 1) throw std::invalid_argument("at least one thread is needed");
  Triangulation made = [&] {
    ReleasedLock release;
    Listener listener(tell);
    const auto keep_going = [&] { return listener.keeps_going(); };
    return Triangulator(rows, options, keep_going, listener.progress()).run();
  }();
  if (!made.is_complete) throw nb::python_error();
  return made;
}

inline Triangulation triangulate(const GivenXyz& points, Method method, int threads,
                                 const std::string& path, const Listener::Tell& tell = {},
                                 bool keeps_sweep = false) {
  Options options;
  options.method = method;
  options.threads = threads;
  options.path = vector_path_named(path);
  options.keeps_sweep = keeps_sweep;
  return triangulate(points, options, tell);
}

struct GrownArrays {
  Triples triangles, neighbors;
  std::optional<Numbers> kept_row;
  std::int64_t distinct_count;
};

inline GrownArrays grow(const GivenXyz& points, Method method, int threads, const std::string& path,
                        const Listener::Tell& tell) {
  Triangulation made = triangulate(points, method, threads, path, tell);
  const auto size = static_cast<std::size_t>(made.triangle_count);
  std::optional<Numbers> kept_row;
  if (!made.kept_row.empty()) kept_row = hand_over(made.kept_row);
  return {hand_over<Triples>(std::move(made.corners), {size, 3}),
          hand_over<Triples>(std::move(made.neighbors), {size, 3}), std::move(kept_row),
          made.distinct_count};
}

struct SweptArrays {
  Triples triangles, neighbors;
  Numbers rows;
  Xy places;
  std::optional<Numbers> kept_row;
  std::int64_t distinct_count;
};

inline SweptArrays sweep(const GivenXyz& points, int threads, const std::string& path) {
  Triangulation made = triangulate(points, Method::kAutomatic, threads, path, {}, true);
  const auto size = static_cast<std::size_t>(made.triangle_count);
  const auto count = size == 0 ? 0 : static_cast<std::size_t>(made.distinct_count);
  std::optional<Numbers> kept_row;
  if (!made.kept_row.empty()) kept_row = hand_over(made.kept_row);
  StreamedArray<double> places(reinterpret_cast<double*>(made.places.release()));
  return {hand_over<Triples>(std::move(made.corners), {size, 3}),
          hand_over<Triples>(std::move(made.neighbors), {size, 3}),
          hand_over<Numbers>(std::move(made.rows), {count}),
          hand_over<Xy>(std::move(places), {count, 2}),
          std::move(kept_row),
          made.distinct_count};
}

struct TriangulatedMesh {
  std::optional<HeldMesh> mesh;  // none if all points are collinear
  std::optional<Numbers> kept_row;
  std::int64_t distinct_count;
};

inline TriangulatedMesh triangulate_mesh(const GivenXyz& points, int threads,
                                         const Listener::Tell& tell) {
  Options options;
  options.threads = threads;
  options.is_for_mesh = true;
  Triangulation made = triangulate(points, options, tell);
  std::optional<HeldMesh> mesh;
  if (made.inserted_count > 0 || made.triangle_count > 0) {
    ReleasedLock release;
    MeshEditor editor = editor_of_triangulation(rows_of(points), made);
    mesh.emplace(std::make_shared<CheckedMesh>(std::move(editor), std::move(made.sweep)));
  }
  std::optional<Numbers> kept_row;
  if (!made.kept_row.empty()) kept_row = hand_over(made.kept_row);
  return {std::move(mesh), std::move(kept_row), made.distinct_count};
}

inline nb::dict count_work(const GivenXyz& points, Method method, int threads,
                           const std::string& path) {
  const Triangulation made = triangulate(points, method, threads, path);
  nb::dict counts;
  counts["triangles"] = made.triangle_count;
  counts["searches"] = made.counts.searches;
  counts["full_searches"] = made.counts.full_searches;
  counts["candidates"] = made.counts.candidates;
  counts["cell_rows"] = made.counts.cell_rows;
  counts["exact_decisions"] = made.counts.exact_decisions;
  counts["walk_steps"] = made.counts.walk_steps;
  return counts;
}

inline std::vector<std::string> names_of_vector_paths() {
  std::vector<std::string> names;
  for (const NamedPath& path : vector_paths()) names.push_back(path.name);
  return names;
}

inline void bind_triangulation(nb::module_& m) {
  m.attr("MOST_POINTS") = kMostPoints;
  nb::enum_<Method>(m, "Method", "How to build; the result is the same.")
      .value("AUTOMATIC", Method::kAutomatic)
      .value("GROWTH_OR_INSERTION", Method::kGrowthOrInsertion)
      .value("GROWTH", Method::kGrowth)
      .value("INSERTION", Method::kInsertion);
  const auto fastest = vector_paths().back().name;
  m.def("grow", &grow, "points"_a.noconvert(), "method"_a = Method::kAutomatic, "threads"_a = 1,
        "path"_a = fastest, "progress"_a = nb::none(), "The triangulation of points.");
  Result<GrownArrays>(m, "Growth",
                      "Triangles in canonical order: by first vertex in the sweep, then by angle.")
      .def_array("triangles", &GrownArrays::triangles, "(m, 3), vertices, numbered by kept rows.")
      .def_array("neighbors", &GrownArrays::neighbors, "(m, 3), opposite the corners, -1 outside.")
      .def_array("kept_row", &GrownArrays::kept_row,
                 "(n,), for each row the first row at the same place; None when no two points "
                 "share a place.")
      .def_ro("distinct_count", &GrownArrays::distinct_count, "How many places there are.");
  Result<SweptArrays>(m, "Sweep", "As Growth, but numbered in the sweep, neighbours side by side.")
      .def_array("triangles", &SweptArrays::triangles, "(m, 3), vertices in the sweep.")
      .def_array("neighbors", &SweptArrays::neighbors, "(m, 3), opposite the corners, -1 outside.")
      .def_array("rows", &SweptArrays::rows, "(n,), the kept row of each vertex.")
      .def_array("places", &SweptArrays::places, "(n, 2), of each vertex.")
      .def_array("kept_row", &SweptArrays::kept_row, "As that of Growth.")
      .def_ro("distinct_count", &SweptArrays::distinct_count, "How many places there are.");
  m.def("sweep", &sweep, "points"_a.noconvert(), "threads"_a, "path"_a,
        "The triangulation of points, numbered in the sweep.");
  Result<TriangulatedMesh>(m, "TriangulatedMesh", "The triangulation of points, as a mesh.")
      .def_array("kept_row", &TriangulatedMesh::kept_row, "As that of Growth.")
      .def_ro("mesh", &TriangulatedMesh::mesh, "None if all points are collinear.")
      .def_ro("distinct_count", &TriangulatedMesh::distinct_count, "How many places there are.");
  m.def("triangulate_mesh", &triangulate_mesh, "points"_a.noconvert(), "threads"_a,
        "progress"_a = nb::none(), "Triangulate points that will be changed.");
  m.def("count_work", &count_work, "points"_a.noconvert(), "method"_a = Method::kAutomatic,
        "threads"_a = 1, "path"_a = fastest, "Triangulate and return how much the searches did.");
  m.def("vector_paths", &names_of_vector_paths,
        "Names of the vector instructions that this processor has, slowest first.");
}

}  // namespace tinsmith::python
