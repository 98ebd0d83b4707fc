// Local change: the constrained Delaunay triangulation of points and fixed edges, kept so while
// points come and go and edges are fixed and released.
//
// Every change makes any valid triangulation of the part that it touches, and then flips edges
// that are not Delaunay until none is left. Ties are decided by the points alone (is_in_circle),
// so the result is a function of the points and the fixed edges, not of the way to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../predicates/predicates.hpp"
#include "corridor.hpp"
#include "landmarks.hpp"
#include "mesh.hpp"
#include "mesh_walk.hpp"

namespace tinsmith {

class MeshEditor {
 public:
  enum class Forced { kDone, kBlocked };

  // A mesh with its points, ready to be changed.
  MeshEditor(Mesh mesh, MeshPoints points)
      : mesh_(std::move(mesh)), points_(std::move(points)) {
    for (std::size_t v = 0; v < points_.size(); ++v) {
      count_ += mesh_.is_alive(static_cast<std::int32_t>(v));
    }
  }

  const Mesh& mesh() const { return mesh_; }
  std::int32_t slots() const { return static_cast<std::int32_t>(points_.size()); }
  std::int32_t count() const { return count_; }  // of vertices
  Point point(std::int32_t v) const { return points_[v]; }

  // Make every edge Delaunay that is not fixed, of a mesh that was not so.
  void legalize_all() {
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t) changed_.push_back(t);
    legalize_changed();
  }

  // ------------------------------------------------------------------- points

  // A number for a vertex that is put in later.
  std::int32_t add_slot() {
    points_.push_back({});
    mesh_.add_vertices(1);
    return slots() - 1;
  }

  // The vertex at p, which is `slot` if there was none; a fixed edge through p is split.
  std::int32_t insert(Point p, std::int32_t slot) {
    return insert_at(MeshWalk(mesh_, points_, count_, state_).locate(p, last_, landmark_near(p)), p,
                     slot);
  }

  // The same where it is known in which triangle or on which edge p lies. A point that is only near
  // the edge will do, if the triangles on both sides are turned the right way with it.
  std::int32_t insert_at(MeshLocation at, Point p, std::int32_t slot) {
    using Where = MeshLocation::Where;
    if (at.where == Where::kAtVertex) return mesh_.from(at.edge);
    points_[slot] = p;
    ++count_;
    if (at.where == Where::kOnEdge) {
      fixed_splits_ += mesh_.is_fixed(at.edge);
      for (const MeshEdge e : mesh_.split_edge(at.edge, slot).edge) {
        put_off(e);
        put_off(Mesh::after(e));  // Delaunay if p is on the edge, and perhaps not if only near it
      }
    } else {
      const auto around = mesh_.split_triangle(triangle_of(at.edge), slot);
      for (const MeshEdge e : around.edge) put_off(e);
      if (at.where == Where::kOutside) widen_hull(p);
    }
    last_ = mesh_.leaving(slot);
    legalize();
    return slot;
  }

  // From now on remember every triangle that is made or changed.
  void watch() { is_watched_ = true; }
  void take_touched(std::vector<std::uint32_t>& taken) {
    taken.clear();
    taken.swap(touched_);
  }

  // Whether the surface would still have a triangle without v.
  bool can_remove(std::int32_t v) const {
    if (count_ <= 3) return false;
    std::int32_t degree = 0;
    bool is_straight = true;
    const MeshEdge first = mesh_.leaving(v);
    MeshEdge e = first;
    do {
      const std::int32_t a = mesh_.to(mesh_.previous_leaving(e)), b = mesh_.to(e);
      const std::int32_t c = mesh_.corner(e);
      is_straight &= a == kGhost || b == kGhost || c == kGhost || turn(a, b, c) == 0;
      ++degree;
      e = mesh_.next_leaving(e);
    } while (e != first);
    return !is_straight || degree < count_;
  }

  bool has_fixed_edge(std::int32_t v) const {
    const MeshEdge first = mesh_.leaving(v);
    MeshEdge e = first;
    do {
      if (mesh_.is_fixed(e)) return true;
      e = mesh_.next_leaving(e);
    } while (e != first);
    return false;
  }

  // v has no fixed edges, and the surface is one without it.
  void remove(std::int32_t v) {
    --count_;
    cut_ears(v);
    const std::int32_t degree = degree_of(v);
    if (degree == 3 && !is_on_hull(v)) {
      changed_.push_back(mesh_.merge_three(v));
    } else if (const MeshEdge flat = degree == 4 ? flat_diagonal(v) : kNoMeshEdge;
               flat != kNoMeshEdge) {
      const MeshEdge diagonal = mesh_.merge_four(v, flat);
      changed_.push_back(triangle_of(diagonal));
      changed_.push_back(triangle_of(mesh_.twin(diagonal)));
    } else {
      const MeshEdge e = leaving_to_ghost(v);
      changed_.push_back(triangle_of(mesh_.twin(mesh_.before(e))));
      mesh_.merge_into_ghost(v, e);
    }
    last_ = mesh_edge(changed_.back(), 0);
    legalize_changed();
  }

  // -------------------------------------------------------------------- edges

  // Fix the edges from a to b; `visit(v)` is called for every vertex on the way, b last. Nothing
  // further is done where an edge that is fixed already is in the way.
  template <typename Visit>
  Forced force(std::int32_t a, std::int32_t b, Visit&& visit) {
    while (a != b) {
      const MeshEdge edge = make_edge(a, b);
      if (edge == kNoMeshEdge) return Forced::kBlocked;
      mesh_.fix(edge, true);
      a = mesh_.to(edge);
      last_ = edge;
      legalize();
      visit(a);
    }
    return Forced::kDone;
  }

  // Call `visit(from, to, is_fixed)` for every edge that the way from a to b crosses; an edge that runs along
  // it is passed over.
  template <typename Visit>
  void cross(std::int32_t a, std::int32_t b, Visit&& visit) const {
    while (a != b) {
      MeshEdge e = first_towards(a, b);
      if (mesh_.from(e) == a) {
        a = mesh_.to(e);
        continue;
      }
      for (int side = 1; side != 0;) {
        visit(mesh_.from(e), mesh_.to(e), mesh_.is_fixed(e));
        const MeshEdge f = mesh_.twin(e);
        const std::int32_t ahead = mesh_.corner(f);
        side = ahead == b ? 0 : turn(a, b, ahead);
        if (side == 0) a = ahead;
        e = side > 0 ? mesh_.after(f) : mesh_.before(f);
      }
    }
  }

  // Let the edge between two vertices go; false if there is none that is fixed.
  bool release(std::int32_t a, std::int32_t b) {
    const MeshEdge e = edge_between(a, b);
    if (e == kNoMeshEdge || !mesh_.is_fixed(e)) return false;
    mesh_.fix(e, false);
    last_ = e;
    pending_.push_back(e);
    legalize();
    return true;
  }

  // Call `visit(from, to)` once for every fixed edge that would not stay if it were not fixed.
  // Only triangles made since the last time are looked at: an edge that was fixed in triangles made
  // before was Delaunay then.
  template <typename Visit>
  void visit_illegal_fixed_edges(Visit&& visit) {
    for (std::uint32_t t = 0; t < mesh_.triangle_slots(); ++t) {
      if (mesh_.is_free(t)) continue;
      bool is_proven = true;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const MeshEdge e = mesh_edge(t, k), f = mesh_.twin(e);
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

  MeshEdge edge_between(std::int32_t a, std::int32_t b) const {
    const MeshEdge first = mesh_.leaving(a);
    MeshEdge e = first;
    do {
      if (mesh_.to(e) == b) return e;
      e = mesh_.next_leaving(e);
    } while (e != first);
    return kNoMeshEdge;
  }

  // Ends of the fixed edges at a vertex, counter-clockwise.
  std::vector<std::int32_t> fixed_neighbors(std::int32_t v) const {
    std::vector<std::int32_t> found;
    const MeshEdge first = mesh_.leaving(v);
    MeshEdge e = first;
    do {
      if (mesh_.is_fixed(e)) found.push_back(mesh_.to(e));
      e = mesh_.next_leaving(e);
    } while (e != first);
    return found;
  }

  // How far v is from the nearest edge between two of its neighbours, in doubles: nothing that it
  // can see, vertex or fixed edge, is nearer than the edges of its star.
  double clearance(std::int32_t v) const {
    double least = std::numeric_limits<double>::infinity();
    const MeshEdge first = mesh_.leaving(v);
    MeshEdge e = first;
    do {
      const std::int32_t a = mesh_.to(e), b = mesh_.corner(e);
      if (a != kGhost && b != kGhost) {
        least = std::min(least, square_to_segment(points_[v], points_[a], points_[b]));
      }
      e = mesh_.next_leaving(e);
    } while (e != first);
    return std::sqrt(least);
  }

  // The corners left and right of the edge from a to b; empty if there is none or it is an outer
  // one.
  std::vector<std::int32_t> corners_beside(std::int32_t a, std::int32_t b) const {
    const MeshEdge e = edge_between(a, b);
    if (e == kNoMeshEdge) return {};
    const std::int32_t left = mesh_.corner(e), right = mesh_.corner(mesh_.twin(e));
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

  // Worth setting up in a large mesh only.
  std::int32_t landmark_near(Point p) {
    if (slots() < Landmarks::kDrawn) return kGhost;
    if (!landmarks_.are_set()) landmarks_.set(mesh_, points_);
    return landmarks_.near(p);
  }

  int turn(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return orientation(points_[a], points_[b], points_[c]);
  }

  // --------------------------------------------------------------- legalizing

  // Flip until every edge is Delaunay that is pending or near one that was flipped.
  void legalize() {
    while (!pending_.empty()) {
      const MeshEdge e = pending_.back();
      pending_.pop_back();
      if (!is_illegal(e)) continue;
      const MeshEdge f = mesh_.twin(e);
      mesh_.flip(e);
      const std::uint32_t t = triangle_of(e), u = triangle_of(f);
      for (const MeshEdge side : {mesh_edge(t, 0), mesh_edge(t, 2), mesh_edge(u, 0), mesh_edge(u, 2)}) {
        put_off(side);
      }
    }
  }

  void legalize_changed() {
    for (const std::uint32_t t : changed_) {
      if (mesh_.is_free(t)) continue;
      for (std::uint32_t k = 0; k < 3; ++k) put_off(mesh_edge(t, k));
    }
    changed_.clear();
    legalize();
  }

  // The edge is to be looked at, and its triangle is one that was made or changed.
  void put_off(MeshEdge e) {
    pending_.push_back(e);
    if (is_watched_) touched_.push_back(triangle_of(e));
  }

  bool is_illegal(MeshEdge e) const { return !mesh_.is_fixed(e) && is_in_far_circle(e); }

  // Whether the far corner lies in the circle of the triangle at the edge.
  bool is_in_far_circle(MeshEdge e) const {
    const std::int32_t a = mesh_.corner(e), b = mesh_.from(e), c = mesh_.to(e);
    const std::int32_t d = mesh_.corner(mesh_.twin(e));
    if (a == kGhost || b == kGhost || c == kGhost || d == kGhost) return false;
    return is_in_circle(points_[a], points_[b], points_[c], points_[d]);
  }

  // ---------------------------------------------------------------- insertion

  // p has been put into a ghost: join it to all hull edges that it sees, on both sides.
  void widen_hull(Point p) {
    const std::size_t ends[2] = {pending_.size() - 3, pending_.size()};
    for (std::size_t i = ends[0]; i < ends[1]; ++i) {
      const MeshEdge e = pending_[i];
      if (mesh_.to(e) == kGhost) widen_counter_clockwise(p, e);
      if (mesh_.from(e) == kGhost) widen_clockwise(p, e);
    }
  }

  // `e` runs from a hull vertex to the ghost, and p is left of it.
  void widen_counter_clockwise(Point p, MeshEdge e) {
    while (true) {
      const MeshEdge f = mesh_.twin(e);
      if (orientation(points_[mesh_.from(e)], points_[mesh_.corner(f)], p) <= 0) return;
      mesh_.flip(e);
      pending_.push_back(mesh_edge(triangle_of(e), 0));
      e = mesh_edge(triangle_of(f), 2);
    }
  }

  // `e` runs from the ghost to a hull vertex, and p is left of it.
  void widen_clockwise(Point p, MeshEdge e) {
    while (true) {
      const MeshEdge f = mesh_.twin(e);
      if (orientation(points_[mesh_.corner(f)], points_[mesh_.to(e)], p) <= 0) return;
      mesh_.flip(e);
      pending_.push_back(mesh_edge(triangle_of(f), 2));
      e = mesh_edge(triangle_of(e), 0);
    }
  }

  // ------------------------------------------------------------------ removal

  std::int32_t degree_of(std::int32_t v) const {
    std::int32_t degree = 0;
    const MeshEdge first = mesh_.leaving(v);
    MeshEdge e = first;
    do {
      ++degree;
      e = mesh_.next_leaving(e);
    } while (e != first);
    return degree;
  }

  MeshEdge leaving_to_ghost(std::int32_t v) const {
    const MeshEdge first = mesh_.leaving(v);
    MeshEdge e = first;
    do {
      if (mesh_.to(e) == kGhost) return e;
      e = mesh_.next_leaving(e);
    } while (e != first);
    return kNoMeshEdge;
  }
  bool is_on_hull(std::int32_t v) const { return leaving_to_ghost(v) != kNoMeshEdge; }

  // Flip edges at v away, an ear of its star each, every other one in turn so that no fan
  // arises, until no ear is left or v has three neighbours.
  void cut_ears(std::int32_t v) {
    std::int32_t degree = degree_of(v);
    MeshEdge e = mesh_.leaving(v);
    for (std::int32_t misses = 0; misses <= degree && degree > 3;) {
      if (!is_ear(v, e)) {
        e = mesh_.next_leaving(e);
        ++misses;
        continue;
      }
      const MeshEdge f = mesh_.twin(e);
      mesh_.flip(e);
      changed_.push_back(triangle_of(e));
      changed_.push_back(triangle_of(f));
      e = mesh_.next_leaving(mesh_.next_leaving(mesh_edge(triangle_of(e), 0)));
      --degree;
      misses = 0;
    }
  }

  // Whether the neighbours before and after the end of e can be joined.
  bool is_ear(std::int32_t v, MeshEdge e) const {
    const std::int32_t before = mesh_.corner(mesh_.twin(e)), tip = mesh_.to(e);
    const std::int32_t after = mesh_.corner(e);
    if (before == kGhost || tip == kGhost || after == kGhost) return false;
    return turn(before, tip, after) > 0 && turn(v, before, after) > 0;
  }

  // With four neighbours, one of them perhaps the ghost: the edge to one of two between which v
  // lies.
  MeshEdge flat_diagonal(std::int32_t v) const {
    MeshEdge e = mesh_.leaving(v);
    for (int i = 0; i < 4; ++i, e = mesh_.next_leaving(e)) {
      const std::int32_t a = mesh_.to(e), b = mesh_.corner(e);
      const std::int32_t c = mesh_.corner(mesh_.next_leaving(e));
      if (a == kGhost || b == kGhost || c == kGhost) continue;
      if (turn(a, v, c) == 0 && turn(a, b, c) > 0) return e;
    }
    return kNoMeshEdge;
  }

  // ------------------------------------------------------------------ forcing

  // The edge from a to b, or to the first vertex on the way there; made if need be. None if a
  // fixed edge is in the way.
  MeshEdge make_edge(std::int32_t a, std::int32_t b) {
    const MeshEdge start = first_towards(a, b);
    if (mesh_.from(start) == a) return start;
    const MeshEdge beyond = mesh_.twin(start);
    const std::int32_t ahead = mesh_.corner(beyond);
    if (!mesh_.is_fixed(start) && (ahead == b || turn(a, b, ahead) == 0)) {
      mesh_.flip(start);  // the only edge across
      return mesh_edge(triangle_of(beyond), 1);
    }
    if (!corridor_.open(mesh_, points_.data(), a, b, start)) return kNoMeshEdge;
    const MeshEdge edge = corridor_.close(mesh_, points_.data());
    pending_ = corridor_.inner_edges();
    return edge;
  }

  // The edge that leaves a along the way to b, or the first edge across it (from right to left).
  MeshEdge first_towards(std::int32_t a, std::int32_t b) const {
    const MeshEdge there = edge_between(a, b);
    if (there != kNoMeshEdge) return there;
    const bool is_forward = lexicographically_before(points_[a], points_[b]);
    const MeshEdge first = mesh_.leaving(a);
    MeshEdge e = first;
    int side = side_of(a, b, mesh_.to(e));
    do {
      const std::int32_t right = mesh_.to(e), left = mesh_.corner(e);
      if (side == 0 && right != kGhost &&
          lexicographically_before(points_[a], points_[right]) == is_forward) {
        return e;
      }
      const int left_side = side_of(a, b, left);
      if (side < 0 && left_side > 0 && right != kGhost && left != kGhost) return mesh_.after(e);
      e = mesh_.next_leaving(e);
      side = left_side;
    } while (e != first);
    return e;  // not reached: a sees something in every direction within the hull
  }

  int side_of(std::int32_t a, std::int32_t b, std::int32_t v) const {
    return v == kGhost ? 0 : turn(a, b, v);
  }

  Mesh mesh_;
  MeshPoints points_;
  std::int32_t count_ = 0;
  std::int64_t fixed_splits_ = 0;
  MeshEdge last_ = kNoMeshEdge;  // near the last change
  std::uint64_t state_ = 0;      // of the random walk, which never shows in the result
  std::vector<MeshEdge> pending_;
  std::vector<std::uint32_t> changed_;
  Corridor corridor_;
  Landmarks landmarks_;
  bool is_watched_ = false;
  std::vector<std::uint32_t> touched_;
};

}  // namespace tinsmith
