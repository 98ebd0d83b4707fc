// Mesh: a triangulation that can be changed, with edges that must stay.
//
// Triangles as in insertion/ghost_mesh.hpp: the outside is covered by ghosts, triangles with the
// ghost as a corner, so that every edge has two triangles. Of a half-edge, which is directed with
// its triangle on its left:
//
//                apex
//               .    .             the edge runs from `from` to `to`; `after` is the next one
//      before .        . after     counter-clockwise, `before` the one before
//           .            .
//        from --- edge --- to
//
// Topology takes no coordinates here; mesh_editor.hpp decides what to change. Where the triangles
// are is the business of a store: in one array (AllTriangles), or in the arrays of a surface but
// for those that were touched (partial_mesh.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../insertion/canonical_order.hpp"
#include "../insertion/ghost_mesh.hpp"

namespace tinsmith {

// Every triangle in one array, with one edge that leaves each vertex.
class AllTriangles {
 public:
  static constexpr bool kFindsVertices = false;

  std::uint32_t slots() const { return static_cast<std::uint32_t>(triangles_.size()); }
  const GhostTriangle* data() const { return triangles_.data(); }
  const GhostTriangle& operator[](Triangle t) const { return triangles_[number(t)]; }
  GhostTriangle& operator[](Triangle t) { return triangles_[number(t)]; }
  Vertex corner(Triangle t, std::uint32_t k) const { return (*this)[t].corner[k]; }
  HalfEdge twin(HalfEdge e) const { return (*this)[triangle_of(e)].twin[corner_of(e)]; }
  const GhostTriangle& complete(Triangle t) const { return (*this)[t]; }
  // Of the fixed edges, by corner, both sides of an edge alike; and marks.
  std::uint8_t bits(Triangle t) const { return bits_[number(t)]; }
  std::uint8_t& bits(Triangle t) { return bits_[number(t)]; }

  Triangle add() {
    triangles_.push_back({});
    bits_.push_back(0);
    return Triangle{slots() - 1};
  }
  void resize(std::uint32_t count) {
    triangles_.resize(count);
    bits_.resize(count);
  }
  void reserve(std::size_t vertices, std::size_t triangles) {
    leaving_.reserve(vertices);
    triangles_.reserve(triangles);
    bits_.reserve(triangles);
  }

  HalfEdge leaving(Vertex v) const { return leaving_[number(v)]; }
  void set_leaving(Vertex v, HalfEdge e) { leaving_[number(v)] = e; }
  void add_vertices(std::size_t count) { leaving_.resize(leaving_.size() + count, kNoHalfEdge); }
  void drop_last_vertex() { leaving_.pop_back(); }

 private:
  ScratchVector<GhostTriangle> triangles_;
  ScratchVector<std::uint8_t> bits_;
  ScratchVector<HalfEdge> leaving_;
};

template <typename Store>
class BasicMesh {
 public:
  static constexpr bool kFindsVertices = Store::kFindsVertices;  // near any point

  BasicMesh() = default;
  explicit BasicMesh(Store store) : store_(std::move(store)) {}

  const Store& store() const { return store_; }

  // ------------------------------------------------------------------ reading

  Vertex apex(HalfEdge e) const { return store_.corner(triangle_of(e), corner_of(e)); }
  Vertex from(HalfEdge e) const { return apex(after(e)); }
  Vertex to(HalfEdge e) const { return apex(before(e)); }
  HalfEdge twin(HalfEdge e) const { return store_.twin(e); }
  static HalfEdge after(HalfEdge e) {
    return half_edge(triangle_of(e), corner_after(corner_of(e)));
  }
  static HalfEdge before(HalfEdge e) {
    return half_edge(triangle_of(e), corner_before(corner_of(e)));
  }

  // Edges that leave a vertex, counter-clockwise about it and back.
  HalfEdge next_leaving(HalfEdge e) const { return twin(before(e)); }
  HalfEdge previous_leaving(HalfEdge e) const { return after(twin(e)); }
  HalfEdge leaving(Vertex v) const { return store_.leaving(v); }
  bool is_alive(Vertex v) const { return leaving(v) != kNoHalfEdge; }

  // The circulator: for (const HalfEdge e : mesh.around(v)) meets every edge that leaves a vertex
  // once, counter-clockwise. The mesh must not be changed meanwhile.
  class Around {
   public:
    class Iterator {
     public:
      Iterator(const BasicMesh& mesh, HalfEdge first, HalfEdge at)
          : mesh_(mesh), first_(first), at_(at) {}
      HalfEdge operator*() const { return at_; }
      Iterator& operator++() {
        at_ = mesh_.next_leaving(at_);
        if (at_ == first_) at_ = kNoHalfEdge;
        return *this;
      }
      bool operator!=(const Iterator& other) const { return at_ != other.at_; }

     private:
      const BasicMesh& mesh_;
      HalfEdge first_, at_;
    };

    Around(const BasicMesh& mesh, HalfEdge first) : mesh_(mesh), first_(first) {}
    Iterator begin() const { return {mesh_, first_, first_}; }
    Iterator end() const { return {mesh_, first_, kNoHalfEdge}; }

   private:
    const BasicMesh& mesh_;
    HalfEdge first_;
  };
  Around around(Vertex v) const { return {*this, leaving(v)}; }

  bool is_fixed(HalfEdge e) const { return bits(triangle_of(e)) >> corner_of(e) & 1; }
  bool is_ghost(Triangle t) const {
    return store_.corner(t, 0) == kGhost || store_.corner(t, 1) == kGhost ||
           store_.corner(t, 2) == kGhost;
  }
  bool is_free(Triangle t) const { return store_.corner(t, 0) == kFree; }
  // Its corners; the twins by twin(), or of a complete one.
  const GhostTriangle& operator[](Triangle t) const { return store_[t]; }
  const GhostTriangle& complete(Triangle t) const { return store_.complete(t); }
  // As the order of triangles takes them, by the position in the sweep of each vertex.
  SweptMesh swept(const Vertex* sweep_of) const {
    return {store_.data(), triangle_slots(), sweep_of};
  }
  std::uint32_t triangle_slots() const { return store_.slots(); }
  Ids<Triangle> triangles() const { return Ids<Triangle>(triangle_slots()); }  // free ones too
  std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(triangle_slots() - free_.size());
  }

  // ----------------------------------------------------------------- changing

  void reserve(std::size_t vertices, std::size_t triangles) { store_.reserve(vertices, triangles); }
  void add_vertices(std::size_t count) { store_.add_vertices(count); }
  void drop_last_vertex() { store_.drop_last_vertex(); }

  // The first triangles, all at once: make(t, triangle) fills one in, neighbours and all, and
  // returns the bits of its fixed edges.
  template <typename Make>
  void add_all(std::uint32_t count, const Make& make) {
    store_.resize(count);
    for (const Triangle t : Ids<Triangle>(count)) {
      bits(t) = make(t, at(t));
      keep_leaving(t);
    }
  }

  // A triangle without neighbours yet.
  Triangle add(Vertex a, Vertex b, Vertex c) {
    const Triangle t = allocate();
    set_corners(t, a, b, c);
    bits(t) = 0;
    return t;
  }
  // The same for one that is no longer needed as it is.
  void reuse(Triangle t, Vertex a, Vertex b, Vertex c) {
    set_corners(t, a, b, c);
    bits(t) = 0;
  }
  // A mark stays until the triangle is made anew.
  void mark(Triangle t) { bits(t) |= kMark; }
  bool is_marked(Triangle t) const { return (bits(t) & kMark) != 0; }
  // Likewise: every fixed edge of the triangle was found to be Delaunay.
  void set_proven(Triangle t) { bits(t) |= kProven; }
  bool is_proven(Triangle t) const { return (bits(t) & kProven) != 0; }

  void join(HalfEdge e, HalfEdge f) {
    at(triangle_of(e)).twin[corner_of(e)] = f;
    at(triangle_of(f)).twin[corner_of(f)] = e;
  }
  void fix(HalfEdge e, bool is_fixed) {
    for (const HalfEdge side : {e, twin(e)}) {
      std::uint8_t& held = bits(triangle_of(side));
      const auto bit = static_cast<std::uint8_t>(1u << corner_of(side));
      held = static_cast<std::uint8_t>(is_fixed ? held | bit : held & ~bit);
    }
  }

  // Swap the diagonal of the two triangles at an edge from b to c with corners a and d:
  // (a, b, c) and (d, c, b) become (a, b, d), which keeps its number, and (d, c, a).
  void flip(HalfEdge e) {
    const HalfEdge f = twin(e);
    const Triangle t = triangle_of(e), u = triangle_of(f);
    const Vertex a = apex(e), b = from(e), c = to(e), d = apex(f);
    const Side ca = side(after(e)), ab = side(before(e));
    const Side bd = side(after(f)), dc = side(before(f));
    put(t, a, b, d, bd, {half_edge(u, 1), false}, ab);
    put(u, d, c, a, ca, {half_edge(t, 1), false}, dc);
  }

  // (a, b, c) becomes (a, b, v), (b, c, v) and (c, a, v); returns the edges opposite v.
  struct ThreeEdges {
    HalfEdge edge[3];
  };
  ThreeEdges split_triangle(Triangle t, Vertex v) {
    const Triangle s = allocate(), r = allocate();
    const Vertex a = at(t).corner[0], b = at(t).corner[1], c = at(t).corner[2];
    const Side bc = side(half_edge(t, 0)), ca = side(half_edge(t, 1)), ab = side(half_edge(t, 2));
    put(t, a, b, v, {half_edge(s, 1), false}, {half_edge(r, 0), false}, ab);
    put(s, b, c, v, {half_edge(r, 1), false}, {half_edge(t, 0), false}, bc);
    put(r, c, a, v, {half_edge(t, 1), false}, {half_edge(s, 0), false}, ca);
    return {{half_edge(t, 2), half_edge(s, 2), half_edge(r, 2)}};
  }

  // v on the edge from b to c with corners a and d; both halves stay fixed if it was. Returns the
  // edges opposite v.
  struct FourEdges {
    HalfEdge edge[4];
  };
  FourEdges split_edge(HalfEdge e, Vertex v) {
    const HalfEdge f = twin(e);
    const bool is_held = is_fixed(e);
    const Triangle t = triangle_of(e), u = triangle_of(f);
    const Triangle s = allocate(), r = allocate();
    const Vertex a = apex(e), b = from(e), c = to(e), d = apex(f);
    const Side ca = side(after(e)), ab = side(before(e));
    const Side bd = side(after(f)), dc = side(before(f));
    put(t, a, b, v, {half_edge(r, 0), is_held}, {half_edge(s, 2), false}, ab);
    put(s, a, v, c, {half_edge(u, 0), is_held}, ca, {half_edge(t, 1), false});
    put(u, d, c, v, {half_edge(s, 0), is_held}, {half_edge(r, 2), false}, dc);
    put(r, d, v, b, {half_edge(t, 0), is_held}, bd, {half_edge(u, 1), false});
    return {{half_edge(t, 2), half_edge(s, 1), half_edge(u, 2), half_edge(r, 1)}};
  }

  // A vertex in three triangles goes; they become one. Returns it.
  Triangle merge_three(Vertex v) {
    const HalfEdge e = leaving(v), f = next_leaving(e), g = next_leaving(f);
    const Triangle t = triangle_of(e), s = triangle_of(f), r = triangle_of(g);
    const Vertex x = to(e), y = to(f), z = to(g);
    const Side xy = side(after(e)), yz = side(after(f)), zx = side(after(g));
    put(t, x, y, z, yz, zx, xy);
    drop(v, s, r);
    return t;
  }

  // A vertex in four triangles goes, on the line from `to(e)` to the vertex opposite; returns the
  // new edge between these.
  HalfEdge merge_four(Vertex v, HalfEdge e) {
    const HalfEdge f = next_leaving(e), g = next_leaving(f), h = next_leaving(g);
    const Triangle t = triangle_of(e), s = triangle_of(g);
    const Vertex w = to(e), x = to(f), y = to(g), z = to(h);
    const Side wx = side(after(e)), xy = side(after(f)), yz = side(after(g)), zw = side(after(h));
    drop(v, triangle_of(f), triangle_of(h));
    put(t, w, x, y, xy, {half_edge(s, 1), false}, wx);
    put(s, y, z, w, zw, {half_edge(t, 1), false}, yz);
    return half_edge(t, 1);
  }

  // A vertex on the hull goes; its triangles become ghosts. `e` leaves it towards the ghost.
  void merge_into_ghost(Vertex v, HalfEdge e) {
    const Triangle ghosts[2] = {triangle_of(e), triangle_of(twin(e))};
    const HalfEdge pair[2][2] = {{side(after(e)).twin, side(before(e)).twin},
                                 {side(after(twin(e))).twin, side(before(twin(e))).twin}};
    for (HalfEdge f = next_leaving(e); f != previous_leaving(e); f = next_leaving(f)) {
      at(triangle_of(f)).corner[corner_after(corner_of(f))] = kGhost;
    }
    for (int i = 0; i < 2; ++i) {
      join(pair[i][0], pair[i][1]);
      free(ghosts[i]);
    }
    for (int i = 0; i < 2; ++i) {
      for (const HalfEdge f : pair[i]) keep_leaving(triangle_of(f));
    }
    store_.set_leaving(v, kNoHalfEdge);
  }

  // A vertex is in no triangle any more, and two triangles go with it.
  void drop(Vertex v, Triangle t, Triangle s) {
    free(t);
    free(s);
    store_.set_leaving(v, kNoHalfEdge);
  }
  // Two triangles that have the same edge between them and the others go.
  void drop_pair(HalfEdge e, HalfEdge f) {
    const Side one = side(e), other = side(f);
    free(triangle_of(e));
    free(triangle_of(f));
    join(one.twin, other.twin);
    fix(one.twin, one.is_fixed || other.is_fixed);
    keep_leaving(triangle_of(one.twin));
    keep_leaving(triangle_of(other.twin));
  }

 private:
  static constexpr std::uint8_t kMark = 8, kProven = 16;  // beyond the bits of the three edges

  struct Side {  // what lies beyond an edge
    HalfEdge twin;
    bool is_fixed;
  };
  Side side(HalfEdge e) const { return {twin(e), is_fixed(e)}; }

  GhostTriangle& at(Triangle t) { return store_[t]; }
  std::uint8_t& bits(Triangle t) { return store_.bits(t); }
  std::uint8_t bits(Triangle t) const { return store_.bits(t); }

  Triangle allocate() {
    if (!free_.empty()) {
      const Triangle t = free_.back();
      free_.pop_back();
      return t;
    }
    return store_.add();
  }

  void free(Triangle t) {
    at(t).corner[0] = kFree;
    free_.push_back(t);
  }

  void set_corners(Triangle t, Vertex a, Vertex b, Vertex c) {
    Vertex* const corner = at(t).corner;
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
    keep_leaving(t);
  }

  // Every corner has an edge that leaves it in a triangle that is alive.
  void keep_leaving(Triangle t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Vertex v = at(t).corner[k];
      if (v != kGhost) store_.set_leaving(v, half_edge(t, corner_before(k)));
    }
  }

  void put(Triangle t, Vertex a, Vertex b, Vertex c, Side opposite_a, Side opposite_b,
           Side opposite_c) {
    set_corners(t, a, b, c);
    join(half_edge(t, 0), opposite_a.twin);
    join(half_edge(t, 1), opposite_b.twin);
    join(half_edge(t, 2), opposite_c.twin);
    bits(t) = static_cast<std::uint8_t>(opposite_a.is_fixed | opposite_b.is_fixed << 1 |
                                        opposite_c.is_fixed << 2);
  }

  Store store_;
  std::vector<Triangle> free_;  // triangles to use again
};

using Mesh = BasicMesh<AllTriangles>;

}  // namespace tinsmith
