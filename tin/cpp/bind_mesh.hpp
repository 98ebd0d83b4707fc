// The border to Python for a mesh that can be changed.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "bind_arrays.hpp"
#include "index/spatial_order.hpp"
#include "mesh/mesh_arrays.hpp"
#include "mesh/mesh_editor.hpp"
#include "mesh/regions.hpp"

namespace tinsmith::python {

using GivenPlaces = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using GivenRows = nb::ndarray<const double, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using GivenTriangles =
    nb::ndarray<const std::int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using GivenPairs = nb::ndarray<const std::int32_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using GivenNumbers = nb::ndarray<const std::int32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using GivenFlags = nb::ndarray<const bool, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<nb::numpy, bool, nb::shape<-1, 3>>;
using FlagRow = nb::ndarray<nb::numpy, bool, nb::shape<-1>>;

// So many vertices can be added before anything is moved in memory.
inline std::int32_t room_for(std::int32_t vertices) { return 64 + vertices / 8; }

// A mesh of arrays, ready to be changed.
inline MeshEditor editor_of(const GivenRows& points, const GivenTriangles& triangles,
                       const GivenTriangles& neighbors, const std::optional<GivenFlags>& fixed) {
  const auto count = static_cast<std::int32_t>(triangles.shape(0));
  if (neighbors.shape(0) != triangles.shape(0) ||
      (fixed && fixed->shape(0) != triangles.shape(0))) {
    throw std::invalid_argument("triangles, neighbors and fixed must have as many rows");
  }
  if (points.shape(1) < 2) throw std::invalid_argument("points must have two columns at least");
  const bool* const flags = fixed ? fixed->data() : nullptr;
  nb::gil_scoped_release release;
  const PointRows rows{points.data(), static_cast<std::int64_t>(points.shape(0)),
                       static_cast<std::int64_t>(points.shape(1))};
  const auto vertices = static_cast<std::int32_t>(rows.count);
  const HullTriangles given{triangles.data(), neighbors.data(), flags, count};
  MeshPoints places;
  places.reserve(std::size_t{0} + vertices + room_for(vertices));
  for (std::int32_t row = 0; row < vertices; ++row) places.push_back(rows[row]);
  return MeshEditor(mesh_of(given, vertices, room_for(vertices)), std::move(places));
}

// The editor with the checks that keep a caller's mistake from corrupting it.
class HeldMesh {
 public:
  HeldMesh(const GivenRows& points, const GivenTriangles& triangles,
           const GivenTriangles& neighbors, const std::optional<GivenFlags>& fixed)
      : editor_(editor_of(points, triangles, neighbors, fixed)) {}

  std::int32_t slots() const { return editor_.slots(); }
  std::int32_t count() const { return editor_.count(); }

  // The vertex at each place, in the order given: a new slot's, or the one that is there already.
  Numbers insert(const GivenPlaces& xy) {
    const auto count = static_cast<std::int32_t>(xy.shape(0));
    if (std::int64_t{count} + editor_.slots() > kMostPoints) {
      throw std::invalid_argument("more points than 32-bit indices can number");
    }
    const auto* places = reinterpret_cast<const Point*>(xy.data());
    auto result = streamed_array<std::int32_t>(count);
    nb::gil_scoped_release release;
    const std::int32_t first = editor_.slots();
    for (std::int32_t i = 0; i < count; ++i) editor_.add_slot();
    const SpatialOrder order(places, count);
    for (std::int32_t i = 0; i < count; ++i) {
      result[order[i]] = editor_.insert(places[order[i]], first + order[i]);
    }
    nb::gil_scoped_acquire acquire;
    return hand_over<Numbers>(std::move(result), {static_cast<std::size_t>(count)});
  }

  // Put a vertex that was removed at another place; returns the one that stands there.
  std::int32_t put(std::int32_t slot, double x, double y) {
    if (slot < 0 || slot >= editor_.slots() || editor_.mesh().is_alive(slot)) {
      throw std::invalid_argument("the slot must be one whose vertex was removed");
    }
    return editor_.insert({x, y}, slot);
  }

  // Whether all were removed; stops at the first without which there would be no triangle.
  bool remove(const GivenNumbers& vertices) {
    for (std::size_t i = 0; i < vertices.shape(0); ++i) {
      const std::int32_t v = vertices.data()[i];
      require_vertex(v);
      if (editor_.has_fixed_edge(v)) throw std::invalid_argument("a fixed edge ends at the vertex");
      if (!editor_.can_remove(v)) return false;
      editor_.remove(v);
    }
    return true;
  }

  // Vertices on the way of each segment, as (segment, vertex) pairs; and the segments that a fixed
  // edge stops.
  auto force(const GivenPairs& segments) {
    std::vector<std::int32_t> passed, blocked;
    bool is_complete = true;
    require_vertices(segments);
    {
      nb::gil_scoped_release release;
      constexpr std::int32_t kSegmentsPerQuestion = 4096;
      std::int32_t until_question = kSegmentsPerQuestion;
      for (std::int32_t i = 0; i < static_cast<std::int32_t>(segments.shape(0)); ++i) {
        if (--until_question == 0) {
          is_complete = no_signal();
          until_question = kSegmentsPerQuestion;
        }
        if (!is_complete) break;
        const std::int32_t a = segments.data()[2 * std::int64_t{i}];
        const std::int32_t b = segments.data()[2 * std::int64_t{i} + 1];
        const auto visit = [&](std::int32_t v) {
          if (v == b) return;
          passed.push_back(i);
          passed.push_back(v);
        };
        if (editor_.force(a, b, visit) == MeshEditor::Forced::kBlocked) blocked.push_back(i);
      }
    }
    if (!is_complete) throw nb::python_error();
    return std::make_tuple(hand_over(passed), hand_over(blocked));
  }

  // The edges that each segment crosses, in order: (segment, from, to).
  auto crossed(const GivenPairs& segments, bool only_fixed) {
    std::vector<std::int32_t> found;
    for (std::size_t i = 0; i < segments.shape(0); ++i) {
      const std::int32_t a = segments.data()[2 * i], b = segments.data()[2 * i + 1];
      require_vertex(a);
      require_vertex(b);
      editor_.cross(a, b, [&](std::int32_t from, std::int32_t to, bool is_fixed) {
        if (only_fixed && !is_fixed) return;
        found.insert(found.end(), {static_cast<std::int32_t>(i), from, to});
      });
    }
    return hand_over(found);
  }

  Numbers fixed_neighbors(std::int32_t v) const {
    require_vertex(v);
    return hand_over(editor_.fixed_neighbors(v));
  }

  double clearance(std::int32_t v) const {
    require_vertex(v);
    return editor_.clearance(v);
  }

  Numbers corners_beside(std::int32_t a, std::int32_t b) const {
    require_vertex(a);
    require_vertex(b);
    return hand_over(editor_.corners_beside(a, b));
  }

  // The fixed edges that are not Delaunay, as (from, to) pairs.
  auto illegal_fixed_edges() {
    std::vector<std::int32_t> illegal;
    {
      nb::gil_scoped_release release;
      editor_.visit_illegal_fixed_edges(
          [&](std::int32_t from, std::int32_t to) { illegal.insert(illegal.end(), {from, to}); });
    }
    return hand_over(illegal);
  }

  std::int64_t fixed_splits() const { return editor_.fixed_splits(); }

  // The number of segments that were fixed edges.
  std::int32_t release(const GivenPairs& segments) {
    std::int32_t released = 0;
    for (std::size_t i = 0; i < segments.shape(0); ++i) {
      const std::int32_t a = segments.data()[2 * i], b = segments.data()[2 * i + 1];
      require_vertex(a);
      require_vertex(b);
      released += editor_.release(a, b);
    }
    return released;
  }

  // Triangles, neighbours and fixed edges in canonical order.
  auto arrays(int threads) const {
    MeshArrays made = [&] {
      nb::gil_scoped_release release;
      Team team(threads, [] { return true; });
      return MeshArrays(editor_, team);
    }();
    const std::size_t size = made.triangle_count;
    return std::make_tuple(hand_over<Corners>(std::move(made.corners), {size, 3}),
                           hand_over<Corners>(std::move(made.neighbors), {size, 3}),
                           hand_over<Flags>(std::move(made.fixed), {size, 3}));
  }

  // Which slots hold a vertex.
  FlagRow alive() const {
    const auto size = static_cast<std::size_t>(editor_.slots());
    auto flags = streamed_array<bool>(size);
    for (std::size_t v = 0; v < size; ++v) {
      flags[v] = editor_.mesh().is_alive(static_cast<std::int32_t>(v));
    }
    return hand_over<FlagRow>(std::move(flags), {size});
  }

  bool has_fixed_edge(std::int32_t v) const {
    require_vertex(v);
    return editor_.has_fixed_edge(v);
  }

 private:
  void require_vertices(const GivenPairs& segments) const {
    for (std::size_t i = 0; i < 2 * segments.shape(0); ++i) require_vertex(segments.data()[i]);
  }

  void require_vertex(std::int32_t v) const {
    if (v < 0 || v >= editor_.slots() || !editor_.mesh().is_alive(v)) {
      throw std::invalid_argument("there is no such vertex");
    }
  }

  MeshEditor editor_;
};

// Region of each triangle, and the largest triangle of each region.
inline auto regions(const GivenPlaces& xy, const GivenTriangles& triangles,
                    const GivenTriangles& neighbors, const GivenFlags& barrier) {
  const auto count = static_cast<std::int32_t>(triangles.shape(0));
  if (neighbors.shape(0) != triangles.shape(0) || barrier.shape(0) != triangles.shape(0)) {
    throw std::invalid_argument("triangles, neighbors and barrier must have as many rows");
  }
  const Regions found = [&] {
    nb::gil_scoped_release release;
    return find_regions(reinterpret_cast<const Point*>(xy.data()), triangles.data(),
                        neighbors.data(), barrier.data(), count);
  }();
  return std::make_tuple(hand_over(found.region_of), hand_over(found.largest));
}

inline void bind_mesh(nb::module_& m) {
  m.def("regions", &regions, "xy"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "barrier"_a.noconvert(),
        "The region of each triangle between barrier edges, and each region's largest triangle.");
  nb::class_<HeldMesh>(m, "Mesh", "A constrained Delaunay triangulation that can be changed.")
      .def(nb::init<const GivenRows&, const GivenTriangles&, const GivenTriangles&,
                    const std::optional<GivenFlags>&>(),
           "points"_a.noconvert(), "triangles"_a.noconvert(), "neighbors"_a.noconvert(),
           "fixed"_a.noconvert() = nb::none())
      .def_prop_ro("slots", &HeldMesh::slots, "Vertices that are or were there.")
      .def_prop_ro("count", &HeldMesh::count, "Vertices that are there.")
      .def_prop_ro("fixed_splits", &HeldMesh::fixed_splits,
                   "How often a vertex was put on a fixed edge.")
      .def("alive", &HeldMesh::alive, "Which slots hold a vertex.")
      .def("has_fixed_edge", &HeldMesh::has_fixed_edge, "vertex"_a)
      .def("insert", &HeldMesh::insert, "xy"_a.noconvert(),
           "The vertex at each place; one new slot a place.")
      .def("put", &HeldMesh::put, "slot"_a, "x"_a, "y"_a,
           "Put a removed vertex back at a place; returns the vertex there.")
      .def("remove", &HeldMesh::remove, "vertices"_a.noconvert(),
           "Remove vertices; False if one could not be, for no triangle would be left.")
      .def("force", &HeldMesh::force, "segments"_a.noconvert(),
           "Fix edges along segments; (segment, vertex) pairs passed, and segments blocked.")
      .def("illegal_fixed_edges", &HeldMesh::illegal_fixed_edges,
           "Fixed edges that are not Delaunay, flat pairs of vertices.")
      .def("fixed_neighbors", &HeldMesh::fixed_neighbors, "vertex"_a,
           "The other ends of the fixed edges at a vertex.")
      .def("clearance", &HeldMesh::clearance, "vertex"_a,
           "How far a vertex is, nearly, from the edges between its neighbours.")
      .def("corners_beside", &HeldMesh::corners_beside, "a"_a, "b"_a,
           "The corners left and right of the edge from a to b; none if it is no inner edge.")
      .def("crossed", &HeldMesh::crossed, "segments"_a.noconvert(), "only_fixed"_a = false,
           "Edges that segments cross, flat triples of segment, start and end.")
      .def("release", &HeldMesh::release, "segments"_a.noconvert(),
           "Let fixed edges go; how many there were.")
      .def("arrays", &HeldMesh::arrays, "threads"_a = 1,
           "Triangles, neighbours and fixed edges in canonical order.");
}

}  // namespace tinsmith::python
