// Local change: the constrained Delaunay triangulation of points and fixed edges, kept so while
// points come and go and edges are fixed and released.
//
// By flips (Lawson, "Software for C1 surface interpolation", 1977). A vertex goes ear by ear of its
// star (Devillers, "On deletion in Delaunay triangulations", 1999): at once where the ears are
// Delaunay (star_filling.hpp), else by flips.
//
// Every change makes any valid triangulation of the part that it touches, and then flips edges
// that are not Delaunay until none is left. Ties are decided by the points alone (is_in_circle),
// so the result is a function of the points and the fixed edges, not of the way to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/ids.hpp"
#include "../predicates/predicates.hpp"
#include "corridor.hpp"
#include "hull_closing.hpp"
#include "landmarks.hpp"
#include "mesh.hpp"
#include "mesh_points.hpp"
#include "point_search.hpp"
#include "star_filling.hpp"

namespace tinsmith {

template <typename Mesh, typename Points>
class BasicMeshEditor {
 public:
  enum class Forced { kDone, kBlocked };

  // A mesh with its points, ready to be changed; all have a vertex, or so many.
  BasicMeshEditor(Mesh mesh, Points points) : mesh_(std::move(mesh)), points_(std::move(points)) {
    for (const Vertex v : vertices()) count_ += mesh_.is_alive(v);
  }
  BasicMeshEditor(Mesh mesh, Points points, std::int32_t count)
      : mesh_(std::move(mesh)), points_(std::move(points)), count_(count) {}

  const Mesh& mesh() const { return mesh_; }
  std::int32_t slots() const { return points_.slots(); }
  Ids<Vertex> vertices() const { return Ids<Vertex>(slots()); }  // those that are gone, too
  std::int32_t count() const { return count_; }                  // of vertices
  Point point(Vertex v) const { return points_[v]; }
  const Points& points() const { return points_; }

  // Make every edge Delaunay that is not fixed, of a mesh that was not so.
  void legalize_all() {
    for (const Triangle t : mesh_.triangles()) changed_.push_back(t);
    legalize_changed();
  }

  // ------------------------------------------------------------------- points

  // A number for a vertex that is put in later.
  Vertex add_slot() {
    mesh_.add_vertices(1);
    return points_.add({});
  }
  // The number of the last slot, which holds no vertex, is free again.
  void drop_last_slot() {
    mesh_.drop_last_vertex();
    points_.drop_last();
  }

  // Where p lies; the walk there begins at an edge that may be near.
  MeshLocation locate(Point p, HalfEdge near) {
    return PointSearch(mesh_, points_, count_, state_).locate(p, near, [] { return kGhost; });
  }

  // The same from the last change or from a landmark.
  MeshLocation locate(Point p) {
    const auto find_landmark = [this, p] { return landmark_near(p); };
    return PointSearch(mesh_, points_, count_, state_).locate(p, last_, find_landmark);
  }

  // The vertex at p, which is `slot` if there was none; a fixed edge through p is split.
  Vertex insert(Point p, Vertex slot) { return insert_at(locate(p), p, slot); }

  // The same where it is known in which triangle or on which edge p lies. A point that is only near
  // the edge will do, if the triangles on both sides are turned the right way with it.
  Vertex insert_at(MeshLocation at, Point p, Vertex slot) {
    using Where = MeshLocation::Where;
    if (at.where == Where::kAtVertex) return mesh_.from(at.edge);
    points_.put(slot, p);
    ++count_;
    if (at.where == Where::kOnEdge) {
      fixed_splits_ += mesh_.is_fixed(at.edge);
      for (const HalfEdge e : mesh_.split_edge(at.edge, slot).edge) {
        put_off(e);
        put_off(Mesh::after(e));  // Delaunay if p is on the edge, and perhaps not if only near it
      }
    } else {
      const auto around = mesh_.split_triangle(triangle_of(at.edge), slot);
      for (const HalfEdge e : around.edge) put_off(e);
      if (at.where == Where::kOutside) widen_hull(p);
    }
    last_ = mesh_.leaving(slot);
    if (at.where == Where::kInside && !is_watched_) {
      legalize_star();
    } else {
      legalize();
    }
    return slot;
  }

  // Fill the convex hull of a surface whose boundary is fixed, and mark the triangles that are made
  // for it. False if that cannot be done, because the boundary meets itself, or could be by more
  // work only; then nothing further is to be done with the mesh.
  bool close_hull() {
    std::vector<Triangle> made;
    if (!HullClosing(mesh_, points_).close(made)) return false;
    changed_ = made;
    legalize_changed();
    for (const Triangle t : made) mesh_.mark(t);
    return true;
  }

  // From now on remember every triangle that is made or changed, or no longer.
  void watch(bool is_watched = true) { is_watched_ = is_watched; }
  void take_touched(std::vector<Triangle>& taken) {
    taken.clear();
    taken.swap(touched_);
  }

  // Whether the surface would still have a triangle without v.
  bool can_remove(Vertex v) const {
    if (count_ <= 3) return false;
    std::int32_t degree = 0;
    for (const HalfEdge e : mesh_.around(v)) {
      const Vertex a = mesh_.to(mesh_.previous_leaving(e)), b = mesh_.to(e), c = mesh_.apex(e);
      const bool is_outer = a == kGhost || b == kGhost || c == kGhost;
      if (!is_outer && turn(a, b, c) != 0) return true;
      ++degree;
    }
    return degree < count_;  // else all others are in line
  }

  bool has_fixed_edge(Vertex v) const {
    for (const HalfEdge e : mesh_.around(v)) {
      if (mesh_.is_fixed(e)) return true;
    }
    return false;
  }

  // v has no fixed edges, and the surface is one without it.
  void remove(Vertex v) {
    --count_;
    // Whoever watches goes through the triangles that flips make, in their order.
    if (!is_watched_ && star_.find(mesh_, points_, v)) {
      last_ = half_edge(star_.fill(mesh_, v), 0);
      return;
    }
    cut_ears(v);
    const std::int32_t degree = degree_of(v);
    if (degree == 3 && !is_on_hull(v)) {
      changed_.push_back(mesh_.merge_three(v));
    } else if (const HalfEdge flat = degree == 4 ? flat_diagonal(v) : kNoHalfEdge;
               flat != kNoHalfEdge) {
      const HalfEdge diagonal = mesh_.merge_four(v, flat);
      changed_.push_back(triangle_of(diagonal));
      changed_.push_back(triangle_of(mesh_.twin(diagonal)));
    } else {
      const HalfEdge e = leaving_to_ghost(v);
      changed_.push_back(triangle_of(mesh_.twin(mesh_.before(e))));
      mesh_.merge_into_ghost(v, e);
    }
    last_ = half_edge(changed_.back(), 0);
    legalize_changed();
  }

  // -------------------------------------------------------------------- edges

  // Fix the edges from a to b; `visit(v)` is called for every vertex on the way, b last. Nothing
  // further is done where an edge that is fixed already is in the way.
  template <typename Visit>
  Forced force(Vertex a, Vertex b, Visit&& visit) {
    while (a != b) {
      const HalfEdge edge = make_edge(a, b);
      if (edge == kNoHalfEdge) return Forced::kBlocked;
      mesh_.fix(edge, true);
      a = mesh_.to(edge);
      last_ = edge;
      legalize();
      visit(a);
    }
    return Forced::kDone;
  }

  // Call `visit(from, to, is_fixed)` for every edge that the way from a to b crosses; an edge that
  // runs along it is passed over.
  template <typename Visit>
  void cross(Vertex a, Vertex b, Visit&& visit) const {
    while (a != b) {
      const HalfEdge e = first_towards(a, b);
      a = mesh_.from(e) == a ? mesh_.to(e) : cross_from(a, b, e, visit);
    }
  }

  // Let the edge between two vertices go; false if there is none that is fixed.
  bool release(Vertex a, Vertex b) {
    const HalfEdge e = edge_between(a, b);
    if (e == kNoHalfEdge || !mesh_.is_fixed(e)) return false;
    mesh_.fix(e, false);
    last_ = e;
    pending_.push_back(e);
    legalize();
    return true;
  }

  // Let all fixed edges go.
  void release_all() {
    for (const Triangle t : mesh_.triangles()) {
      if (mesh_.is_free(t)) continue;
      for (const HalfEdge e : half_edges(t)) {
        if (!mesh_.is_fixed(e)) continue;
        mesh_.fix(e, false);
        last_ = e;
        pending_.push_back(e);
      }
    }
    legalize();
  }

  // Call `visit(from, to)` once for every fixed edge that would not stay if it were not fixed.
  // Only triangles made since the last time are looked at: an edge that was fixed in triangles made
  // before was Delaunay then.
  template <typename Visit>
  void visit_illegal_fixed_edges(Visit&& visit) {
    for (const Triangle t : mesh_.triangles()) {
      if (mesh_.is_free(t)) continue;
      bool is_proven = true;
      for (const HalfEdge e : half_edges(t)) {
        const HalfEdge f = mesh_.twin(e);
        if (!mesh_.is_fixed(e)) continue;
        if (mesh_.is_proven(t) && mesh_.is_proven(triangle_of(f))) continue;
        if (!is_in_far_circle(e)) continue;
        is_proven = false;
        if (e < f) visit(mesh_.from(e), mesh_.to(e));
      }
      if (is_proven) mesh_.set_proven(t);
    }
  }

  // How often a point was put on a fixed edge.
  std::int64_t fixed_splits() const { return fixed_splits_; }

  HalfEdge edge_between(Vertex a, Vertex b) const {
    for (const HalfEdge e : mesh_.around(a)) {
      if (mesh_.to(e) == b) return e;
    }
    return kNoHalfEdge;
  }

  // Ends of the fixed edges at a vertex, counter-clockwise.
  std::vector<Vertex> fixed_neighbors(Vertex v) const {
    std::vector<Vertex> found;
    for (const HalfEdge e : mesh_.around(v)) {
      if (mesh_.is_fixed(e)) found.push_back(mesh_.to(e));
    }
    return found;
  }

  // How far v is from the nearest edge between two of its neighbours, in doubles: nothing that it
  // can see, vertex or fixed edge, is nearer than the edges of its star.
  double clearance(Vertex v) const {
    double least = std::numeric_limits<double>::infinity();
    for (const HalfEdge e : mesh_.around(v)) {
      const Vertex a = mesh_.to(e), b = mesh_.apex(e);
      if (a == kGhost || b == kGhost) continue;
      least = std::min(least, square_to_segment(points_[v], points_[a], points_[b]));
    }
    return std::sqrt(least);
  }

  // The apexes left and right of the edge from a to b; empty if there is none or it is an outer
  // one.
  std::vector<Vertex> apexes_beside(Vertex a, Vertex b) const {
    const HalfEdge e = edge_between(a, b);
    if (e == kNoHalfEdge) return {};
    const Vertex left = mesh_.apex(e), right = mesh_.apex(mesh_.twin(e));
    if (left == kGhost || right == kGhost) return {};
    return {left, right};
  }

 private:
  static double square_to_segment(Point p, Point a, Point b) {
    const double ux = b.x - a.x, uy = b.y - a.y, vx = p.x - a.x, vy = p.y - a.y;
    const double share = std::clamp((ux * vx + uy * vy) / (ux * ux + uy * uy), 0.0, 1.0);
    const double dx = vx - share * ux, dy = vy - share * uy;
    return dx * dx + dy * dy;
  }

  // A vertex that may be near. Landmarks are worth setting up in a large mesh only.
  Vertex landmark_near(Point p) {
    if constexpr (Mesh::kFindsVertices) {
      return mesh_.store().vertex_near(p);
    } else {
      if (slots() < Landmarks::kLeast) return kGhost;
      if (!landmarks_.are_set()) landmarks_.set(mesh_, points_);
      return landmarks_.near(p);
    }
  }

  int turn(Vertex a, Vertex b, Vertex c) const {
    return orientation(points_[a], points_[b], points_[c]);
  }

  // --------------------------------------------------------------- legalizing

  // Flip until every edge is Delaunay that is pending or near one that was flipped.
  void legalize() {
    while (!pending_.empty()) {
      const HalfEdge e = pending_.back();
      pending_.pop_back();
      if (!is_illegal(e)) continue;
      const HalfEdge f = mesh_.twin(e);
      mesh_.flip(e);
      const Triangle t = triangle_of(e), u = triangle_of(f);
      for (const HalfEdge side :
           {half_edge(t, 0), half_edge(t, 2), half_edge(u, 0), half_edge(u, 2)}) {
        put_off(side);
      }
    }
  }

  // The same where the edges that are pending are all opposite a new vertex within a triangle: only
  // such edges can become illegal, and every flip makes two more of them [Lawson 1977].
  void legalize_star() {
    while (!pending_.empty()) {
      const HalfEdge e = pending_.back();
      pending_.pop_back();
      if (!is_illegal(e)) continue;
      const HalfEdge f = mesh_.twin(e);
      mesh_.flip(e);
      pending_.push_back(half_edge(triangle_of(e), 0));
      pending_.push_back(half_edge(triangle_of(f), 2));
    }
  }

  void legalize_changed() {
    for (const Triangle t : changed_) {
      if (mesh_.is_free(t)) continue;
      for (const HalfEdge e : half_edges(t)) put_off(e);
    }
    changed_.clear();
    legalize();
  }

  // The edge is to be looked at, and its triangle is one that was made or changed.
  void put_off(HalfEdge e) {
    pending_.push_back(e);
    if (is_watched_) touched_.push_back(triangle_of(e));
  }

  bool is_illegal(HalfEdge e) const { return !mesh_.is_fixed(e) && is_in_far_circle(e); }

  // Whether the far corner lies in the circle of the triangle at the edge.
  bool is_in_far_circle(HalfEdge e) const {
    const Vertex a = mesh_.apex(e), b = mesh_.from(e), c = mesh_.to(e);
    const Vertex d = mesh_.apex(mesh_.twin(e));
    if (a == kGhost || b == kGhost || c == kGhost || d == kGhost) return false;
    return is_in_circle(points_[a], points_[b], points_[c], points_[d]);
  }

  // ---------------------------------------------------------------- insertion

  // p has been put into a ghost: join it to all hull edges that it sees, on both sides.
  void widen_hull(Point p) {
    const std::size_t ends[2] = {pending_.size() - 3, pending_.size()};
    for (std::size_t i = ends[0]; i < ends[1]; ++i) {
      const HalfEdge e = pending_[i];
      if (mesh_.to(e) == kGhost) widen_counter_clockwise(p, e);
      if (mesh_.from(e) == kGhost) widen_clockwise(p, e);
    }
  }

  // `e` runs from a hull vertex to the ghost, and p is left of it.
  void widen_counter_clockwise(Point p, HalfEdge e) {
    while (true) {
      const HalfEdge f = mesh_.twin(e);
      if (orientation(points_[mesh_.from(e)], points_[mesh_.apex(f)], p) <= 0) return;
      mesh_.flip(e);
      pending_.push_back(half_edge(triangle_of(e), 0));
      e = half_edge(triangle_of(f), 2);
    }
  }

  // `e` runs from the ghost to a hull vertex, and p is left of it.
  void widen_clockwise(Point p, HalfEdge e) {
    while (true) {
      const HalfEdge f = mesh_.twin(e);
      if (orientation(points_[mesh_.apex(f)], points_[mesh_.to(e)], p) <= 0) return;
      mesh_.flip(e);
      pending_.push_back(half_edge(triangle_of(f), 2));
      e = half_edge(triangle_of(e), 0);
    }
  }

  // ------------------------------------------------------------------ removal

  std::int32_t degree_of(Vertex v) const {
    std::int32_t degree = 0;
    for ([[maybe_unused]] const HalfEdge e : mesh_.around(v)) ++degree;
    return degree;
  }

  HalfEdge leaving_to_ghost(Vertex v) const {
    for (const HalfEdge e : mesh_.around(v)) {
      if (mesh_.to(e) == kGhost) return e;
    }
    return kNoHalfEdge;
  }
  bool is_on_hull(Vertex v) const { return leaving_to_ghost(v) != kNoHalfEdge; }

  // Flip edges at v away, an ear of its star each, every other one in turn so that no fan
  // arises, until no ear is left or v has three neighbours.
  void cut_ears(Vertex v) {
    std::int32_t degree = degree_of(v);
    HalfEdge e = mesh_.leaving(v);
    for (std::int32_t misses = 0; misses <= degree && degree > 3;) {
      if (!is_ear(v, e)) {
        e = mesh_.next_leaving(e);
        ++misses;
        continue;
      }
      const HalfEdge f = mesh_.twin(e);
      mesh_.flip(e);
      changed_.push_back(triangle_of(e));
      changed_.push_back(triangle_of(f));
      e = mesh_.next_leaving(mesh_.next_leaving(half_edge(triangle_of(e), 0)));
      --degree;
      misses = 0;
    }
  }

  // Whether the neighbours before and after the end of e can be joined.
  bool is_ear(Vertex v, HalfEdge e) const {
    const Vertex before = mesh_.apex(mesh_.twin(e)), tip = mesh_.to(e);
    const Vertex after = mesh_.apex(e);
    if (before == kGhost || tip == kGhost || after == kGhost) return false;
    return turn(before, tip, after) > 0 && turn(v, before, after) > 0;
  }

  // With four neighbours, one of them perhaps the ghost: the edge to one of two between which v
  // lies.
  HalfEdge flat_diagonal(Vertex v) const {
    HalfEdge e = mesh_.leaving(v);
    for (int i = 0; i < 4; ++i, e = mesh_.next_leaving(e)) {
      const Vertex a = mesh_.to(e), b = mesh_.apex(e);
      const Vertex c = mesh_.apex(mesh_.next_leaving(e));
      if (a == kGhost || b == kGhost || c == kGhost) continue;
      if (turn(a, v, c) == 0 && turn(a, b, c) > 0) return e;
    }
    return kNoHalfEdge;
  }

  // ------------------------------------------------------------------ forcing

  // The edge from a to b, or to the first vertex on the way there; made if need be. None if a
  // fixed edge is in the way.
  HalfEdge make_edge(Vertex a, Vertex b) {
    const HalfEdge start = first_towards(a, b);
    if (mesh_.from(start) == a) return start;
    const HalfEdge beyond = mesh_.twin(start);
    const Vertex ahead = mesh_.apex(beyond);
    if (!mesh_.is_fixed(start) && (ahead == b || turn(a, b, ahead) == 0)) {
      mesh_.flip(start);  // the only edge across
      return half_edge(triangle_of(beyond), 1);
    }
    if (!corridor_.open(mesh_, points_, a, b, start)) return kNoHalfEdge;
    const HalfEdge edge = corridor_.close(mesh_, points_);
    pending_ = corridor_.inner_edges();
    return edge;
  }

  // The edge that leaves a along the way to b, or the first edge across it (from right to left).
  HalfEdge first_towards(Vertex a, Vertex b) const {
    const HalfEdge there = edge_between(a, b);
    if (there != kNoHalfEdge) return there;
    const bool is_forward = lexicographically_before(points_[a], points_[b]);
    int side = side_of(a, b, mesh_.to(mesh_.leaving(a)));
    for (const HalfEdge e : mesh_.around(a)) {
      const Vertex right = mesh_.to(e), left = mesh_.apex(e);
      if (side == 0 && right != kGhost &&
          lexicographically_before(points_[a], points_[right]) == is_forward) {
        return e;
      }
      const int left_side = side_of(a, b, left);
      if (side < 0 && left_side > 0 && right != kGhost && left != kGhost) return mesh_.after(e);
      side = left_side;
    }
    // A vertex sees something in every direction within the hull.
    throw std::logic_error("no edge at a vertex leads towards another");
  }

  // From the first edge across the way from a to b: the vertex on it where the next part begins.
  template <typename Visit>
  Vertex cross_from(Vertex a, Vertex b, HalfEdge e, Visit&& visit) const {
    for (std::uint32_t most = mesh_.triangle_slots(); most > 0; --most) {
      visit(mesh_.from(e), mesh_.to(e), mesh_.is_fixed(e));
      const HalfEdge f = mesh_.twin(e);
      const Vertex ahead = mesh_.apex(f);
      const int side = ahead == b ? 0 : turn(a, b, ahead);
      if (side == 0) return ahead;
      e = side > 0 ? mesh_.after(f) : mesh_.before(f);
    }
    throw std::logic_error("a way through the mesh did not reach its end");
  }

  int side_of(Vertex a, Vertex b, Vertex v) const { return v == kGhost ? 0 : turn(a, b, v); }

  Mesh mesh_;
  Points points_;
  std::int32_t count_ = 0;
  std::int64_t fixed_splits_ = 0;
  HalfEdge last_ = kNoHalfEdge;  // near the last change
  std::uint64_t state_ = 0;      // of the random walk, which never shows in the result
  std::vector<HalfEdge> pending_;
  std::vector<Triangle> changed_;
  Corridor corridor_;
  StarFilling star_;
  Landmarks landmarks_;
  bool is_watched_ = false;
  std::vector<Triangle> touched_;
};

using MeshEditor = BasicMeshEditor<Mesh, MeshPoints>;

}  // namespace tinsmith
