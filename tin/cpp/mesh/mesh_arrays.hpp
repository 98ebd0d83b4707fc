// Between arrays of triangles and a mesh that can be changed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../growth/triangle_store.hpp"
#include "../index/grid.hpp"
#include "../insertion/canonical_order.hpp"
#include "../triangulation.hpp"
#include "given_triangles.hpp"
#include "mesh_editor.hpp"

namespace tinsmith {

namespace detail {

// Fills in one triangle after another, and remembers edges of the hull.
class TriangleCopy {
 public:
  TriangleCopy(const GivenTriangles& given, std::vector<HalfEdge>& hull)
      : given_(given), hull_(hull) {}

  std::uint8_t operator()(Triangle t, GhostTriangle& made) const {
    const std::size_t row = entry_of(t, 0);
    std::uint8_t fixed = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      made.corner[k] = Vertex{given_.corners[row + k]};
      made.twin[k] = twin(t, k, given_.neighbors[row + k]);
      if (given_.fixed != nullptr) fixed |= static_cast<std::uint8_t>(given_.fixed[row + k] << k);
    }
    return fixed;
  }

 private:
  HalfEdge twin(Triangle t, std::uint32_t k, std::int32_t neighbor) const {
    if (neighbor != kNoNeighbor) return given_.twin(t, triangle_numbered(neighbor));
    hull_.push_back(half_edge(t, k));
    return kNoHalfEdge;
  }

  const GivenTriangles& given_;
  std::vector<HalfEdge>& hull_;
};

// A ghost at every edge of the boundary, each joined to the next along it: around their vertex,
// through the surface, so that a vertex may be on the boundary more than once.
inline void add_ghosts(const std::vector<HalfEdge>& hull, Mesh& mesh) {
  for (const HalfEdge e : hull) {
    const Triangle ghost = mesh.add(kGhost, mesh.to(e), mesh.from(e));
    mesh.join(half_edge(ghost, 0), e);
  }
  for (const HalfEdge e : hull) {
    HalfEdge next = Mesh::after(e);
    for (std::uint32_t most = mesh.triangle_slots(); mesh.apex(mesh.twin(next)) != kGhost; --most) {
      if (most == 0) throw std::invalid_argument("the neighbors of the triangles do not fit");
      next = Mesh::after(mesh.twin(next));
    }
    mesh.join(half_edge(triangle_of(mesh.twin(e)), 2), half_edge(triangle_of(mesh.twin(next)), 1));
  }
}

}  // namespace detail

// So many vertices can be added before anything is moved in memory.
inline std::int32_t room_for(std::int32_t vertices) { return 64 + vertices / 8; }

// With room for some more vertices.
inline Mesh mesh_of(const GivenTriangles& given, std::int32_t vertex_count, std::int32_t more) {
  Mesh mesh;
  mesh.reserve(std::size_t{0} + vertex_count + more,
               2 * (std::size_t{0} + vertex_count + more));  // ghosts included
  mesh.add_vertices(vertex_count);
  std::vector<HalfEdge> hull;
  mesh.add_all(static_cast<std::uint32_t>(given.count), detail::TriangleCopy(given, hull));
  detail::add_ghosts(hull, mesh);
  for (const HalfEdge e : hull) {
    if (mesh.is_fixed(e)) mesh.fix(e, true);  // on the ghost's side too
  }
  return mesh;
}

// A mesh of arrays with its points, ready to be changed.
inline MeshEditor editor_of(const PointRows& rows, const GivenTriangles& given) {
  const auto vertices = static_cast<std::int32_t>(rows.count);
  MeshPoints points;
  points.reserve(std::size_t{0} + vertices + room_for(vertices));
  for (std::int32_t row = 0; row < vertices; ++row) points.add(rows[row]);
  return MeshEditor(mesh_of(given, vertices, room_for(vertices)), std::move(points));
}

namespace detail {

// What was inserted is taken as it is, ghosts included, with no arrays between.
inline Mesh mesh_of_inserted(const Triangulation& made, std::int32_t vertex_count) {
  Mesh mesh;
  const std::size_t vertices = std::size_t{0} + vertex_count + room_for(vertex_count);
  mesh.reserve(vertices, 2 * vertices);
  mesh.add_vertices(vertex_count);
  mesh.add_all(made.inserted_count, [&](Triangle t, GhostTriangle& triangle) {
    triangle = made.inserted[number(t)];
    return std::uint8_t{0};
  });
  return mesh;
}

}  // namespace detail

// A mesh of a triangulation that was made for it (Options::is_for_mesh) and has triangles. Vertices
// are numbered by kept rows.
inline MeshEditor editor_of_triangulation(const PointRows& rows, const Triangulation& made) {
  const auto vertices = static_cast<std::int32_t>(made.distinct_count);
  MeshPoints points;
  points.reserve(std::size_t{0} + vertices + room_for(vertices));
  for (std::int32_t row = 0; row < rows.count; ++row) {
    if (made.kept_row.empty() || made.kept_row[row] == row) points.add(rows[row]);
  }
  if (made.inserted_count > 0) {
    return MeshEditor(detail::mesh_of_inserted(made, vertices), std::move(points));
  }
  const GivenTriangles given{made.corners.get(), made.neighbors.get(), nullptr,
                             static_cast<std::int32_t>(made.triangle_count)};
  return MeshEditor(mesh_of(given, vertices, room_for(vertices)), std::move(points));
}

// The mesh as arrays in canonical order, as a fresh triangulation of its points would be;
// vertices are numbered in the order of their slots, without gaps.
class MeshArrays {
 public:
  // If wished with which triangles are marked. `known` are the vertices in the order of the sweep,
  // or none; all slots hold a vertex where they are known.
  MeshArrays(const MeshEditor& editor, Team& team, bool tells_marks = false,
             const std::vector<Vertex>& known = {})
      : editor_(editor), mesh_(editor.mesh()) {
    release_freed_memory();
    if (editor.count() < editor.slots()) gather_vertices();
    const Point* const points = points_.empty() ? editor.points().begin() : points_.data();
    const std::vector<Vertex> found =
        known.empty() ? find_sweep(points, team) : std::vector<Vertex>();
    const std::vector<Vertex>& sweep = known.empty() ? found : known;
    const WithGhost<Vertex> sweep_of = positions_in(sweep, team);
    const PointsInSweep in_sweep(points, sweep);
    CanonicalOrder order(in_sweep, mesh_.swept(sweep_of.begin()), team);
    if (!order.count()) return;
    triangle_count = static_cast<std::uint32_t>(order.triangles());
    const std::size_t size = 3 * std::size_t{triangle_count};
    corners = streamed_array<std::int32_t>(size);
    neighbors = streamed_array<std::int32_t>(size);
    fixed = streamed_array<bool>(size);
    if (tells_marks) marked = streamed_array<bool>(triangle_count);
    order.write(Triangles{corners.get(), neighbors.get()},
                [this, tells_marks](std::int64_t t, std::uint32_t first, std::size_t entry) {
                  const HalfEdge e = half_edge(triangle_numbered(t), first);
                  fixed[entry] = mesh_.is_fixed(e);
                  fixed[entry + 1] = mesh_.is_fixed(Mesh::after(e));
                  fixed[entry + 2] = mesh_.is_fixed(Mesh::before(e));
                  if (tells_marks) marked[entry / 3] = mesh_.is_marked(triangle_of(e));
                });
    team.run([&](int member) {
      const Range own = part_of(triangle_count, member, team.size());
      for (std::int64_t i = std::int64_t{3} * own.begin; i < std::int64_t{3} * own.end; ++i) {
        corners[i] = number(sweep[corners[i]]);
      }
    });
  }

  StreamedArray<std::int32_t> corners, neighbors;
  StreamedArray<bool> fixed;
  StreamedArray<bool> marked;  // by triangle
  std::uint32_t triangle_count = 0;

 private:
  void gather_vertices() {
    points_.reserve(editor_.count());
    slot_of_.reserve(editor_.count());
    for (const Vertex v : editor_.vertices()) {
      if (!mesh_.is_alive(v)) continue;
      slot_of_.push_back(v);
      points_.push_back(editor_.point(v));
    }
  }

  // Numbers of points in the order of the sweep.
  std::vector<Vertex> find_sweep(const Point* points, Team& team) const {
    const PointGrid grid({&points->x, editor_.count(), 2}, team);
    std::vector<Vertex> sweep(grid.count());
    team.run([&](int member) {
      const Range own = part_of(grid.count(), member, team.size());
      for (std::int32_t i = own.begin; i < own.end; ++i) sweep[i] = Vertex{number(grid.rows()[i])};
    });
    return sweep;
  }

  // Of each slot its vertex's position in the sweep.
  WithGhost<Vertex> positions_in(const std::vector<Vertex>& sweep, Team& team) const {
    WithGhost<Vertex> sweep_of(editor_.slots());
    sweep_of[kGhost] = kGhost;
    const auto count = static_cast<std::int32_t>(sweep.size());
    team.run([&](int member) {
      const Range own = part_of(count, member, team.size());
      for (std::int32_t i = own.begin; i < own.end; ++i) {
        sweep_of[slot_of_.empty() ? sweep[i] : slot_of_[number(sweep[i])]] = Vertex{i};
      }
    });
    return sweep_of;
  }

  const MeshEditor& editor_;
  const Mesh& mesh_;
  ScratchVector<Point> points_;    // of the vertices, where slots are without one
  ScratchVector<Vertex> slot_of_;  // of each of these
};

}  // namespace tinsmith
