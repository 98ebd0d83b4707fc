// Between arrays of triangles and a mesh that can be changed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../growth/triangle_store.hpp"
#include "../index/grid.hpp"
#include "../insertion/canonical.hpp"
#include "mesh_editor.hpp"

namespace tinsmith {

// Triangles of the whole convex hull, three entries each: corners, neighbours (kNoNeighbor
// outside) and whether the edge opposite the corner is fixed.
struct HullTriangles {
  const std::int32_t* corners;
  const std::int32_t* neighbors;
  const bool* fixed;
  std::int32_t count;
};

namespace detail {

inline void join_neighbors(const HullTriangles& given, Mesh& mesh) {
  for (std::int32_t t = 0; t < given.count; ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::int32_t u = given.neighbors[3 * std::int64_t{t} + k];
      if (u < t) continue;  // joined already, or outside
      const std::int32_t* const back = given.neighbors + 3 * std::int64_t{u};
      const std::uint32_t place = back[0] == t ? 0 : back[1] == t ? 1 : 2;
      mesh.join(mesh_edge(static_cast<std::uint32_t>(t), k),
                mesh_edge(static_cast<std::uint32_t>(u), place));
    }
  }
}

// A ghost at every hull edge, each joined to the next along the hull.
inline void add_ghosts(const HullTriangles& given, std::int32_t vertex_count, Mesh& mesh) {
  std::vector<std::uint32_t> ghost_from(vertex_count, kNoMeshEdge);
  std::vector<std::pair<std::uint32_t, std::int32_t>> ends;  // ghost, end of its hull edge
  for (std::int32_t t = 0; t < given.count; ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (given.neighbors[3 * std::int64_t{t} + k] != kNoNeighbor) continue;
      const MeshEdge e = mesh_edge(static_cast<std::uint32_t>(t), k);
      const std::int32_t start = mesh.from(e), end = mesh.to(e);
      const std::uint32_t ghost = mesh.add(kGhost, end, start);
      mesh.join(mesh_edge(ghost, 0), e);
      ghost_from[start] = ghost;
      ends.emplace_back(ghost, end);
    }
  }
  for (const auto& [ghost, end] : ends) {
    mesh.join(mesh_edge(ghost, 2), mesh_edge(ghost_from[end], 1));
  }
}

}  // namespace detail

// With room for some more vertices.
inline Mesh mesh_of(const HullTriangles& given, std::int32_t vertex_count, std::int32_t more) {
  Mesh mesh;
  mesh.reserve(std::size_t{0} + vertex_count + more,
               2 * (std::size_t{0} + vertex_count + more));  // ghosts included
  mesh.add_vertices(vertex_count);
  for (std::int64_t t = 0; t < given.count; ++t) {
    mesh.add(given.corners[3 * t], given.corners[3 * t + 1], given.corners[3 * t + 2]);
  }
  detail::join_neighbors(given, mesh);
  detail::add_ghosts(given, vertex_count, mesh);
  for (std::int64_t i = 0; i < std::int64_t{3} * given.count; ++i) {
    if (!given.fixed[i]) continue;
    mesh.fix(mesh_edge(static_cast<std::uint32_t>(i / 3), static_cast<std::uint32_t>(i % 3)), true);
  }
  return mesh;
}

// The mesh as arrays in canonical order, as a fresh triangulation of its points would be;
// vertices are numbered in the order of their slots, without gaps.
class MeshArrays {
 public:
  MeshArrays(const MeshEditor& editor, Team& team) : editor_(editor), mesh_(editor.mesh()) {
    gather_vertices();
    const PointGrid grid({&places_[0].x, editor.count(), 2}, team);
    const GhostMesh copy = swept_copy(grid);
    triangle_count = copy.count - ghosts_;
    corners = streamed_array<std::int32_t>(3 * std::size_t{triangle_count});
    neighbors = streamed_array<std::int32_t>(3 * std::size_t{triangle_count});
    fixed = streamed_array<bool>(3 * std::size_t{triangle_count});
    CanonicalOrder order(grid, copy);
    order.write(Triangles{corners.get(), neighbors.get()});
    order.write_flags(fixed.get(), [this](std::uint32_t t, std::uint32_t place) {
      return mesh_.is_fixed(mesh_edge(slot_of_.empty() ? t : slot_of_[t], place));
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
    places_.reserve(editor_.count());
    number_of_.resize(editor_.slots(), kNoNeighbor);
    for (std::int32_t v = 0; v < editor_.slots(); ++v) {
      if (!mesh_.is_alive(v)) continue;
      number_of_[v] = static_cast<std::int32_t>(places_.size());
      places_.push_back(editor_.point(v));
    }
  }

  // Without gaps, corners numbered by the sweep.
  GhostMesh swept_copy(const PointGrid& grid) {
    std::vector<std::int32_t> sweep_of(places_.size());
    for (std::int32_t i = 0; i < grid.count(); ++i) sweep_of[number(grid.rows()[i])] = i;
    GhostMesh copy;
    copy.triangles = scratch_array<GhostTriangle>(mesh_.triangle_count());
    const std::vector<std::uint32_t> place_in_copy = close_gaps();
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t) {
      if (mesh_.is_free(t)) continue;
      GhostTriangle& to = copy.triangles[copy.count++];
      for (int k = 0; k < 3; ++k) {
        const std::int32_t v = mesh_[t].corner[k];
        const MeshEdge twin = mesh_[t].twin[k];
        ghosts_ += v == kGhost;
        to.corner[k] = v == kGhost ? kGhost : sweep_of[number_of_[v]];
        to.twin[k] = place_in_copy.empty()
                         ? twin
                         : mesh_edge(place_in_copy[triangle_of(twin)], place_of(twin));
      }
    }
    return copy;
  }

  // Where each triangle stands in the copy; empty if there are no gaps.
  std::vector<std::uint32_t> close_gaps() {
    if (mesh_.triangle_count() == mesh_.triangle_slots()) return {};
    std::vector<std::uint32_t> place(mesh_.triangle_slots());
    slot_of_.reserve(mesh_.triangle_count());
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t) {
      if (mesh_.is_free(t)) continue;
      place[t] = static_cast<std::uint32_t>(slot_of_.size());
      slot_of_.push_back(t);
    }
    return place;
  }

  const MeshEditor& editor_;
  const Mesh& mesh_;
  std::vector<Point> places_;              // of the vertices, without gaps
  std::vector<std::int32_t> number_of_;    // of each slot
  std::vector<std::uint32_t> slot_of_;     // of each triangle of the copy; empty if the same
  std::uint32_t ghosts_ = 0;
};

}  // namespace tinsmith
