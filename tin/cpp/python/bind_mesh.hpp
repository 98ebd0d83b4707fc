// Bindings of a mesh that can be changed.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "../location/surface.hpp"
#include "../mesh/boundary_walks.hpp"
#include "../mesh/checked_mesh.hpp"
#include "../mesh/mesh_arrays.hpp"
#include "../mesh/regions.hpp"
#include "../mesh/triangle_joining.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

inline GivenTriangles triangles_of(const GivenTriples& triangles, const GivenTriples& neighbors,
                                   const std::optional<GivenFlags>& fixed) {
  if (neighbors.shape(0) != triangles.shape(0) ||
      (fixed && fixed->shape(0) != triangles.shape(0))) {
    throw std::invalid_argument("triangles, neighbors and fixed must have as many rows");
  }
  return {triangles.data(), neighbors.data(), fixed ? fixed->data() : nullptr,
          static_cast<std::int32_t>(triangles.shape(0))};
}

inline MeshEditor editor_from(const GivenRows& points, const GivenTriples& triangles,
                              const GivenTriples& neighbors,
                              const std::optional<GivenFlags>& fixed) {
  const GivenTriangles given = triangles_of(triangles, neighbors, fixed);
  if (points.shape(1) < 2) throw std::invalid_argument("points must have two columns at least");
  const PointRows rows{points.data(), static_cast<std::int64_t>(points.shape(0)),
                       static_cast<std::int64_t>(points.shape(1))};
  ReleasedLock release;
  return editor_of(rows, given);
}

inline VertexPairs pairs_of(const GivenPairs& pairs) { return {pairs.data(), pairs.shape(0)}; }

class HeldMesh {
 public:
  explicit HeldMesh(std::shared_ptr<CheckedMesh> mesh) : held_(std::move(mesh)) {}
  HeldMesh(const GivenRows& points, const GivenTriples& triangles, const GivenTriples& neighbors,
           const std::optional<GivenFlags>& fixed)
      : held_(std::make_shared<CheckedMesh>(editor_from(points, triangles, neighbors, fixed))) {}

  std::int32_t slots() const { return held_->editor().slots(); }
  std::int32_t count() const { return held_->editor().count(); }
  std::int64_t fixed_splits() const { return held_->editor().fixed_splits(); }

  Flags alive() const {
    const auto size = static_cast<std::size_t>(slots());
    auto flags = streamed_array<bool>(size);
    held_->write_alive(flags.get());
    return hand_over<Flags>(std::move(flags), {size});
  }

  Numbers insert(const GivenXy& xy) {
    const std::int32_t count = row_count(xy.shape(0));
    auto result = streamed_array<std::int32_t>(count);
    {
      ReleasedLock release;
      held_->insert(points_of(xy), count, result.get());
    }
    return hand_over<Numbers>(std::move(result), {xy.shape(0)});
  }

  std::int32_t put(std::int32_t slot, double x, double y) {
    return number(held_->put(Vertex{slot}, {x, y}));
  }

  bool remove(const GivenNumbers& vertices) {
    return held_->remove(vertices.data(), vertices.shape(0));
  }

  auto force(const GivenPairs& segments) {
    const CheckedMesh::Forced forced = [&] {
      ReleasedLock release;
      return held_->force(pairs_of(segments), no_signal);
    }();
    if (!forced.is_complete) throw nb::python_error();
    return std::make_tuple(hand_over(forced.passed), hand_over(forced.blocked));
  }

  Numbers crossed(const GivenPairs& segments, bool only_fixed) const {
    return hand_over(held_->crossed(pairs_of(segments), only_fixed));
  }
  std::int32_t release(const GivenPairs& segments) { return held_->release(pairs_of(segments)); }
  void release_all() {
    ReleasedLock release;
    held_->release_all();
  }

  Numbers illegal_fixed_edges() {
    const auto illegal = [&] {
      ReleasedLock release;
      return held_->illegal_fixed_edges();
    }();
    return hand_over(illegal);
  }

  bool has_fixed_edge(std::int32_t v) const { return held_->has_fixed_edge(Vertex{v}); }
  double clearance(std::int32_t v) const { return held_->clearance(Vertex{v}); }
  Numbers fixed_neighbors(std::int32_t v) const {
    return hand_over(held_->fixed_neighbors(Vertex{v}));
  }
  Numbers corners_beside(std::int32_t a, std::int32_t b) const {
    return hand_over(held_->apexes_beside(Vertex{a}, Vertex{b}));
  }

  auto arrays(int threads) const {
    MeshArrays made = [&] {
      ReleasedLock release;
      Team team(threads, [] { return true; });
      const CheckedMesh& held = *held_;
      return MeshArrays(held.editor(), team, false, held.sweep());
    }();
    const std::size_t size = made.triangle_count;
    return std::make_tuple(hand_over<Triples>(std::move(made.corners), {size, 3}),
                           hand_over<Triples>(std::move(made.neighbors), {size, 3}),
                           hand_over<TripleFlags>(std::move(made.fixed), {size, 3}));
  }

 private:
  std::shared_ptr<CheckedMesh> held_;
};

// Region of each triangle, and the largest triangle of each region.
inline auto regions(const GivenXyz& points, const GivenTriples& triangles,
                    const GivenTriples& neighbors, const GivenFlags& barrier) {
  const Surface surface = surface_of(points, triangles, &neighbors);
  if (barrier.shape(0) != triangles.shape(0) || !surface.has_sound_neighbors()) {
    throw std::invalid_argument("neighbors and barriers must be those of the triangles");
  }
  const Regions found = [&] {
    ReleasedLock release;
    return RegionSearch(surface, barrier.data()).find();
  }();
  return std::make_tuple(hand_over(found.region_of), hand_over(found.largest));
}

// The triangle across each edge, and whether the triangles fit together.
inline auto join_triangles(const GivenTriples& triangles, std::int32_t vertex_count) {
  const Surface surface = corners_of(triangles, vertex_count);
  auto neighbors = streamed_array<std::int32_t>(3 * triangles.shape(0));
  const bool is_sound = [&] {
    ReleasedLock release;
    return TriangleJoining(surface).join(neighbors.get());
  }();
  return std::make_tuple(hand_over<Triples>(std::move(neighbors), {triangles.shape(0), 3}),
                         is_sound);
}

// The boundary edges ring by ring, and where each ring begins.
inline auto boundary_walks(const GivenTriples& triangles, const GivenTriples& neighbors) {
  Surface surface = corners_of(triangles, kMostRows);
  if (neighbors.shape(0) != triangles.shape(0)) {
    throw std::invalid_argument("triangles and neighbors must have the same number of rows");
  }
  surface.neighbors = neighbors.data();
  if (!surface.has_sound_neighbors()) {
    throw std::invalid_argument("neighbors must be triangles or -1");
  }
  const BoundaryWalks found = [&] {
    ReleasedLock release;
    return BoundaryWalker(surface).walk();
  }();
  return std::make_tuple(copy_over<Offsets, std::int64_t>(found.edges, {found.edges.size()}),
                         copy_over<Offsets, std::int64_t>(found.offsets, {found.offsets.size()}));
}

// Signs of the areas of triangles, seen from above.
inline Signs turns_of_triangles(const GivenXyz& points, const GivenTriples& triangles) {
  const Surface surface = surface_of(points, triangles);
  require_exact_points(surface);
  auto result = streamed_array<std::int8_t>(surface.triangle_count);
  {
    ReleasedLock release;
    write_turns(surface, result.get());
  }
  return hand_over<Signs>(std::move(result), {surface.triangle_count});
}

inline void bind_mesh(nb::module_& m) {
  m.def("join_triangles", &join_triangles, "triangles"_a.noconvert(), "vertex_count"_a,
        "The triangle across each edge, and whether the triangles fit together.");
  m.def("boundary_walks", &boundary_walks, "triangles"_a.noconvert(), "neighbors"_a.noconvert(),
        "The boundary edges, ring by ring, and where each ring begins.");
  m.def("turns_of_triangles", &turns_of_triangles, "points"_a.noconvert(),
        "triangles"_a.noconvert(), "+1 for a counter-clockwise triangle, -1 clockwise, 0 flat.");
  m.def("regions", &regions, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "barrier"_a.noconvert(),
        "The region of each triangle between barrier edges, and each region's largest triangle.");
  nb::class_<HeldMesh>(m, "Mesh", "A constrained Delaunay triangulation that can be changed.")
      .def(nb::init<const GivenRows&, const GivenTriples&, const GivenTriples&,
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
           "The vertex at each point; one new slot a point.")
      .def("put", &HeldMesh::put, "slot"_a, "x"_a, "y"_a,
           "Put a removed vertex back at a point; returns the vertex there.")
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
      .def("release_all", &HeldMesh::release_all, "Let all fixed edges go.")
      .def("release", &HeldMesh::release, "segments"_a.noconvert(),
           "Let fixed edges go; how many there were.")
      .def("arrays", &HeldMesh::arrays, "threads"_a = 1,
           "Triangles, neighbours and fixed edges in canonical order.");
}

}  // namespace tinsmith::python
