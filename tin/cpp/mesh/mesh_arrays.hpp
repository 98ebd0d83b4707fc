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

// Triangles of the whole convex hull, or of a surface with any rim, three entries each: corners, neighbours (kNoNeighbor
// outside) and whether the edge opposite the corner is fixed (null: none is).
struct HullTriangles {
  const std::int32_t* corners;
  const std::int32_t* neighbors;
  const bool* fixed;
  std::int32_t count;
};

namespace detail {

// Fills in one triangle after another, and remembers edges of the hull.
class TriangleCopy {
 public:
  TriangleCopy(const HullTriangles& given, std::vector<MeshEdge>& hull)
      : given_(given), hull_(hull) {}

  std::uint8_t operator()(std::uint32_t t, GhostTriangle& made) const {
    const std::size_t row = 3 * std::size_t{t};
    std::uint8_t fixed = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      made.corner[k] = given_.corners[row + k];
      made.twin[k] = twin(t, k, given_.neighbors[row + k]);
      if (given_.fixed != nullptr) fixed |= static_cast<std::uint8_t>(given_.fixed[row + k] << k);
    }
    return fixed;
  }

 private:
  MeshEdge twin(std::uint32_t t, std::uint32_t k, std::int32_t neighbor) const {
    if (neighbor == kNoNeighbor) {
      hull_.push_back(mesh_edge(t, k));
      return kNoMeshEdge;
    }
    const std::int32_t* const back = given_.neighbors + 3 * std::int64_t{neighbor};
    const auto own = static_cast<std::int32_t>(t);
    const std::uint32_t place = (back[1] == own) + 2u * (back[2] == own);
    return mesh_edge(static_cast<std::uint32_t>(neighbor), place);
  }

  const HullTriangles& given_;
  std::vector<MeshEdge>& hull_;
};

// A ghost at every edge of the rim, each joined to the next along the rim: around their vertex,
// through the surface, so that a vertex may be on the rim more than once.
inline void add_ghosts(const std::vector<MeshEdge>& hull, Mesh& mesh) {
  for (const MeshEdge e : hull) {
    const std::uint32_t ghost = mesh.add(kGhost, mesh.to(e), mesh.from(e));
    mesh.join(mesh_edge(ghost, 0), e);
  }
  for (const MeshEdge e : hull) {
    MeshEdge next = Mesh::after(e);
    while (mesh.corner(mesh.twin(next)) != kGhost) next = Mesh::after(mesh.twin(next));
    mesh.join(mesh_edge(triangle_of(mesh.twin(e)), 2), mesh_edge(triangle_of(mesh.twin(next)), 1));
  }
}

}  // namespace detail

// With room for some more vertices.
inline Mesh mesh_of(const HullTriangles& given, std::int32_t vertex_count, std::int32_t more) {
  Mesh mesh;
  mesh.reserve(std::size_t{0} + vertex_count + more,
               2 * (std::size_t{0} + vertex_count + more));  // ghosts included
  mesh.add_vertices(vertex_count);
  std::vector<MeshEdge> hull;
  mesh.add_all(static_cast<std::uint32_t>(given.count), detail::TriangleCopy(given, hull));
  detail::add_ghosts(hull, mesh);
  for (const MeshEdge e : hull) {
    if (mesh.is_fixed(e)) mesh.fix(e, true);  // on the ghost's side too
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
    const auto sweep_of = scratch_array<std::int32_t>(places_.size());
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
  MeshPoints places_;              // of the vertices, without gaps
  ScratchVector<std::int32_t> number_of_;  // of each slot
  std::vector<std::uint32_t> slot_of_;     // of each triangle of the copy; empty if the same
  std::uint32_t ghosts_ = 0;
};

}  // namespace tinsmith
