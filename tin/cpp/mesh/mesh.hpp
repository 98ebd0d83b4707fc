// Mesh: a triangulation that can be changed, with edges that must stay.
//
// Triangles as in insertion/ghost_mesh.hpp: the outside is covered by ghosts, triangles with the
// ghost as a corner, so that every edge has two triangles. An edge is a number as seen from one
// triangle, and is directed with that triangle on its left:
//
//               corner
//               .    .             the edge runs from `from` to `to`; `after` is the next one
//      before .        . after     counter-clockwise, `before` the one before
//           .            .
//        from --- edge --- to
//
// Topology takes no coordinates here; mesh_edit.hpp decides what to change.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/arrays.hpp"
#include "../insertion/ghost_mesh.hpp"

namespace tinsmith {

using MeshEdge = std::uint32_t;
constexpr MeshEdge kNoMeshEdge = UINT32_MAX;

class Mesh {
 public:
  // ------------------------------------------------------------------ reading

  std::int32_t corner(MeshEdge e) const { return triangle(e).corner[place_of(e)]; }
  std::int32_t from(MeshEdge e) const { return triangle(e).corner[place_after(place_of(e))]; }
  std::int32_t to(MeshEdge e) const { return triangle(e).corner[place_before(place_of(e))]; }
  MeshEdge twin(MeshEdge e) const { return triangle(e).twin[place_of(e)]; }
  static MeshEdge after(MeshEdge e) { return mesh_edge(triangle_of(e), place_after(place_of(e))); }
  static MeshEdge before(MeshEdge e) {
    return mesh_edge(triangle_of(e), place_before(place_of(e)));
  }

  // Edges that leave a vertex, counter-clockwise about it and back.
  MeshEdge next_leaving(MeshEdge e) const { return twin(before(e)); }
  MeshEdge previous_leaving(MeshEdge e) const { return after(twin(e)); }
  MeshEdge leaving(std::int32_t vertex) const { return leaving_[vertex]; }
  bool is_alive(std::int32_t vertex) const { return leaving_[vertex] != kNoMeshEdge; }

  bool is_fixed(MeshEdge e) const { return fixed_[triangle_of(e)] >> place_of(e) & 1; }
  bool is_ghost(std::uint32_t t) const {
    const auto& c = triangles_[t].corner;
    return c[0] == kGhost || c[1] == kGhost || c[2] == kGhost;
  }
  bool is_free(std::uint32_t t) const { return triangles_[t].corner[0] == kFree; }
  const GhostTriangle& operator[](std::uint32_t t) const { return triangles_[t]; }
  std::uint32_t triangle_slots() const { return static_cast<std::uint32_t>(triangles_.size()); }
  std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(triangles_.size() - free_.size());
  }

  // ----------------------------------------------------------------- changing

  void reserve(std::size_t vertices, std::size_t triangles) {
    leaving_.reserve(vertices);
    triangles_.reserve(triangles);
    fixed_.reserve(triangles);
  }
  void add_vertices(std::size_t count) { leaving_.resize(leaving_.size() + count, kNoMeshEdge); }

  // The first triangles, all at once: make(t, triangle) fills one in, neighbours and all, and
  // returns the bits of its fixed edges.
  template <typename Make>
  void add_all(std::uint32_t count, const Make& make) {
    triangles_.resize(count);
    fixed_.resize(count);
    for (std::uint32_t t = 0; t < count; ++t) {
      fixed_[t] = make(t, triangles_[t]);
      keep_leaving(t);
    }
  }

  // A triangle without neighbours yet.
  std::uint32_t add(std::int32_t a, std::int32_t b, std::int32_t c) {
    const std::uint32_t t = allocate();
    set_corners(t, a, b, c);
    fixed_[t] = 0;
    return t;
  }
  // The same for one that is no longer needed as it is.
  void reuse(std::uint32_t t, std::int32_t a, std::int32_t b, std::int32_t c) {
    set_corners(t, a, b, c);
    fixed_[t] = 0;
  }
  // A mark stays until the triangle is made anew.
  void mark(std::uint32_t t) { fixed_[t] |= kMark; }
  bool is_marked(std::uint32_t t) const { return (fixed_[t] & kMark) != 0; }
  // Likewise: every fixed edge of the triangle was found to be Delaunay.
  void set_proven(std::uint32_t t) { fixed_[t] |= kProven; }
  bool is_proven(std::uint32_t t) const { return (fixed_[t] & kProven) != 0; }

  void join(MeshEdge e, MeshEdge f) {
    triangles_[triangle_of(e)].twin[place_of(e)] = f;
    triangles_[triangle_of(f)].twin[place_of(f)] = e;
  }
  void fix(MeshEdge e, bool is_fixed) {
    for (const MeshEdge side : {e, twin(e)}) {
      std::uint8_t& bits = fixed_[triangle_of(side)];
      const auto bit = static_cast<std::uint8_t>(1u << place_of(side));
      bits = static_cast<std::uint8_t>(is_fixed ? bits | bit : bits & ~bit);
    }
  }

  // Swap the diagonal of the two triangles at an edge from b to c with corners a and d:
  // (a, b, c) and (d, c, b) become (a, b, d), which keeps its number, and (d, c, a).
  void flip(MeshEdge e) {
    const MeshEdge f = twin(e);
    const std::uint32_t t = triangle_of(e), u = triangle_of(f);
    const std::int32_t a = corner(e), b = from(e), c = to(e), d = corner(f);
    const Side ca = side(after(e)), ab = side(before(e));
    const Side bd = side(after(f)), dc = side(before(f));
    put(t, a, b, d, bd, {mesh_edge(u, 1), false}, ab);
    put(u, d, c, a, ca, {mesh_edge(t, 1), false}, dc);
  }

  // (a, b, c) becomes (a, b, v), (b, c, v) and (c, a, v); returns the edges opposite v.
  struct ThreeEdges {
    MeshEdge edge[3];
  };
  ThreeEdges split_triangle(std::uint32_t t, std::int32_t v) {
    const std::uint32_t s = allocate(), r = allocate();
    const std::int32_t a = triangles_[t].corner[0], b = triangles_[t].corner[1];
    const std::int32_t c = triangles_[t].corner[2];
    const Side bc = side(mesh_edge(t, 0)), ca = side(mesh_edge(t, 1)), ab = side(mesh_edge(t, 2));
    put(t, a, b, v, {mesh_edge(s, 1), false}, {mesh_edge(r, 0), false}, ab);
    put(s, b, c, v, {mesh_edge(r, 1), false}, {mesh_edge(t, 0), false}, bc);
    put(r, c, a, v, {mesh_edge(t, 1), false}, {mesh_edge(s, 0), false}, ca);
    return {{mesh_edge(t, 2), mesh_edge(s, 2), mesh_edge(r, 2)}};
  }

  // v on the edge from b to c with corners a and d; both halves stay fixed if it was. Returns the
  // edges opposite v.
  struct FourEdges {
    MeshEdge edge[4];
  };
  FourEdges split_edge(MeshEdge e, std::int32_t v) {
    const MeshEdge f = twin(e);
    const bool is_held = is_fixed(e);
    const std::uint32_t t = triangle_of(e), u = triangle_of(f);
    const std::uint32_t s = allocate(), r = allocate();
    const std::int32_t a = corner(e), b = from(e), c = to(e), d = corner(f);
    const Side ca = side(after(e)), ab = side(before(e));
    const Side bd = side(after(f)), dc = side(before(f));
    put(t, a, b, v, {mesh_edge(r, 0), is_held}, {mesh_edge(s, 2), false}, ab);
    put(s, a, v, c, {mesh_edge(u, 0), is_held}, ca, {mesh_edge(t, 1), false});
    put(u, d, c, v, {mesh_edge(s, 0), is_held}, {mesh_edge(r, 2), false}, dc);
    put(r, d, v, b, {mesh_edge(t, 0), is_held}, bd, {mesh_edge(u, 1), false});
    return {{mesh_edge(t, 2), mesh_edge(s, 1), mesh_edge(u, 2), mesh_edge(r, 1)}};
  }

  // A vertex in three triangles goes; they become one. Returns it.
  std::uint32_t merge_three(std::int32_t v) {
    const MeshEdge e = leaving(v), f = next_leaving(e), g = next_leaving(f);
    const std::uint32_t t = triangle_of(e), s = triangle_of(f), r = triangle_of(g);
    const std::int32_t x = to(e), y = to(f), z = to(g);
    const Side xy = side(after(e)), yz = side(after(f)), zx = side(after(g));
    put(t, x, y, z, yz, zx, xy);
    free(s);
    free(r);
    leaving_[v] = kNoMeshEdge;
    return t;
  }

  // A vertex in four triangles goes, on the line from `to(e)` to the vertex opposite; returns the
  // new edge between these.
  MeshEdge merge_four(std::int32_t v, MeshEdge e) {
    const MeshEdge f = next_leaving(e), g = next_leaving(f), h = next_leaving(g);
    const std::uint32_t t = triangle_of(e), s = triangle_of(g);
    const std::int32_t w = to(e), x = to(f), y = to(g), z = to(h);
    const Side wx = side(after(e)), xy = side(after(f)), yz = side(after(g)), zw = side(after(h));
    free(triangle_of(f));
    free(triangle_of(h));
    put(t, w, x, y, xy, {mesh_edge(s, 1), false}, wx);
    put(s, y, z, w, zw, {mesh_edge(t, 1), false}, yz);
    leaving_[v] = kNoMeshEdge;
    return mesh_edge(t, 1);
  }

  // A vertex on the hull goes; its triangles become ghosts. `e` leaves it towards the ghost.
  void merge_into_ghost(std::int32_t v, MeshEdge e) {
    const std::uint32_t ghosts[2] = {triangle_of(e), triangle_of(twin(e))};
    const MeshEdge pair[2][2] = {{side(after(e)).twin, side(before(e)).twin},
                                 {side(after(twin(e))).twin, side(before(twin(e))).twin}};
    for (MeshEdge f = next_leaving(e); f != previous_leaving(e); f = next_leaving(f)) {
      triangles_[triangle_of(f)].corner[place_after(place_of(f))] = kGhost;
    }
    for (int i = 0; i < 2; ++i) {
      join(pair[i][0], pair[i][1]);
      free(ghosts[i]);
    }
    for (int i = 0; i < 2; ++i) {
      for (const MeshEdge f : pair[i]) keep_leaving(triangle_of(f));
    }
    leaving_[v] = kNoMeshEdge;
  }

 private:
  static constexpr std::int32_t kFree = -2;
  static constexpr std::uint8_t kMark = 8, kProven = 16;  // beyond the bits of the three edges

  struct Side {  // what lies beyond an edge
    MeshEdge twin;
    bool is_fixed;
  };
  Side side(MeshEdge e) const { return {twin(e), is_fixed(e)}; }

  const GhostTriangle& triangle(MeshEdge e) const { return triangles_[triangle_of(e)]; }

  std::uint32_t allocate() {
    if (!free_.empty()) {
      const std::uint32_t t = free_.back();
      free_.pop_back();
      return t;
    }
    triangles_.push_back({});
    fixed_.push_back(0);
    return static_cast<std::uint32_t>(triangles_.size() - 1);
  }

  void free(std::uint32_t t) {
    triangles_[t].corner[0] = kFree;
    free_.push_back(t);
  }

  void set_corners(std::uint32_t t, std::int32_t a, std::int32_t b, std::int32_t c) {
    std::int32_t* const corner = triangles_[t].corner;
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
    keep_leaving(t);
  }

  // Every corner has an edge that leaves it in a triangle that is alive.
  void keep_leaving(std::uint32_t t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::int32_t vertex = triangles_[t].corner[k];
      if (vertex != kGhost) leaving_[vertex] = mesh_edge(t, place_before(k));
    }
  }

  void put(std::uint32_t t, std::int32_t a, std::int32_t b, std::int32_t c, Side opposite_a,
           Side opposite_b, Side opposite_c) {
    set_corners(t, a, b, c);
    join(mesh_edge(t, 0), opposite_a.twin);
    join(mesh_edge(t, 1), opposite_b.twin);
    join(mesh_edge(t, 2), opposite_c.twin);
    fixed_[t] = static_cast<std::uint8_t>(opposite_a.is_fixed | opposite_b.is_fixed << 1 |
                                          opposite_c.is_fixed << 2);
  }

  ScratchVector<GhostTriangle> triangles_;
  ScratchVector<std::uint8_t> fixed_;  // bits by corner, both sides of an edge alike; mark
  std::vector<std::uint32_t> free_;    // triangles to use again
  ScratchVector<MeshEdge> leaving_;    // one edge that leaves each vertex
};

}  // namespace tinsmith
