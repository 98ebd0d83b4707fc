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
#include "mesh_editor.hpp"

namespace tinsmith {

// Triangles of the whole convex hull, or of a surface with any boundary, three entries each:
// corners, neighbours (kNoNeighbor outside) and whether the edge opposite the corner is fixed
// (null: none is).
struct GivenTriangles {
  const std::int32_t* corners;
  const std::int32_t* neighbors;
  const bool* fixed;
  std::int32_t count;
};

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
    if (neighbor == kNoNeighbor) {
      hull_.push_back(half_edge(t, k));
      return kNoHalfEdge;
    }
    const Triangle across = triangle_numbered(neighbor);
    const std::int32_t own = index_of(t);
    const std::int32_t* const back = given_.neighbors + entry_of(across, 0);
    return half_edge(across, (back[1] == own) + 2u * (back[2] == own));
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

// The mesh as arrays in canonical order, as a fresh triangulation of its points would be;
// vertices are numbered in the order of their slots, without gaps.
class MeshArrays {
 public:
  MeshArrays(const MeshEditor& editor, Team& team) : editor_(editor), mesh_(editor.mesh()) {
    gather_vertices();
    const PointGrid grid({&points_[0].x, editor.count(), 2}, team);
    const GhostMesh copy = swept_copy(grid);
    triangle_count = copy.count - ghosts_;
    corners = streamed_array<std::int32_t>(3 * std::size_t{triangle_count});
    neighbors = streamed_array<std::int32_t>(3 * std::size_t{triangle_count});
    fixed = streamed_array<bool>(3 * std::size_t{triangle_count});
    CanonicalOrder order(grid, copy, team);
    order.write(Triangles{corners.get(), neighbors.get()});
    order.write_flags(fixed.get(), [this](HalfEdge e) {
      if (slot_of_.empty()) return mesh_.is_fixed(e);
      return mesh_.is_fixed(half_edge(slot_of_[number(triangle_of(e))], corner_of(e)));
    });
    for (std::size_t i = 0; i < 3 * std::size_t{triangle_count}; ++i) {
      corners[i] = number(grid.rows()[corners[i]]);
    }
  }

  StreamedArray<std::int32_t> corners, neighbors;
  StreamedArray<bool> fixed;
  std::uint32_t triangle_count = 0;

 private:
  void gather_vertices() {
    points_.reserve(editor_.count());
    number_of_.resize(editor_.slots(), kNoVertex);
    for (const Vertex v : editor_.vertices()) {
      if (!mesh_.is_alive(v)) continue;
      number_of_[number(v)] = Vertex{static_cast<std::int32_t>(points_.size())};
      points_.push_back(editor_.point(v));
    }
  }

  // Without gaps, corners numbered by the sweep.
  GhostMesh swept_copy(const PointGrid& grid) {
    const auto sweep_of = scratch_array<Vertex>(points_.size());
    for (const Vertex v : Ids<Vertex>(grid.count())) sweep_of[number(grid.rows()[number(v)])] = v;
    GhostMesh copy;
    copy.triangles = scratch_array<GhostTriangle>(mesh_.triangle_count());
    const std::vector<Triangle> in_copy = close_gaps();
    for (const Triangle t : mesh_.triangles()) {
      if (mesh_.is_free(t)) continue;
      GhostTriangle& to = copy.triangles[copy.count++];
      for (int k = 0; k < 3; ++k) {
        const Vertex v = mesh_[t].corner[k];
        const HalfEdge twin = mesh_[t].twin[k];
        ghosts_ += v == kGhost;
        to.corner[k] = v == kGhost ? kGhost : sweep_of[number(number_of_[number(v)])];
        to.twin[k] =
            in_copy.empty() ? twin : half_edge(in_copy[number(triangle_of(twin))], corner_of(twin));
      }
    }
    return copy;
  }

  // Each triangle's number in the copy; empty if there are no gaps.
  std::vector<Triangle> close_gaps() {
    if (mesh_.triangle_count() == mesh_.triangle_slots()) return {};
    std::vector<Triangle> in_copy(mesh_.triangle_slots());
    slot_of_.reserve(mesh_.triangle_count());
    for (const Triangle t : mesh_.triangles()) {
      if (mesh_.is_free(t)) continue;
      in_copy[number(t)] = Triangle{static_cast<std::uint32_t>(slot_of_.size())};
      slot_of_.push_back(t);
    }
    return in_copy;
  }

  const MeshEditor& editor_;
  const Mesh& mesh_;
  ScratchVector<Point> points_;      // of the vertices, without gaps
  ScratchVector<Vertex> number_of_;  // of each slot
  std::vector<Triangle> slot_of_;    // of each triangle of the copy; empty if the same
  std::uint32_t ghosts_ = 0;
};

}  // namespace tinsmith
