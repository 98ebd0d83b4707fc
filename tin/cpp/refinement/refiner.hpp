// Refiner: points are added to a constrained Delaunay mesh until its triangles are good.
//
// Delaunay refinement after Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional
// mesh generation" (1995) and Chew, "Guaranteed-quality mesh generation for curved surfaces"
// (1993), with the off-centres of Uengoer, "Off-centers: a new type of Steiner points" (2004):
//
//   1. A segment (a fixed edge; every edge of the boundary is one) that a corner beside it
//      encroaches upon, or that is too long, is split. Points put inside the surface before and now
//      within the circle on the segment are taken out first.
//   2. A bad triangle gets a point at its remedy. If a segment is in the way, or the point would
//      encroach upon one, that segment is split instead.
//
// At an input vertex with a small angle, segments are split on circles around it whose radii are
// powers of two, so that both sides are cut alike and do not cut each other on and on (Ruppert). A
// triangle whose shortest edge joins two such segments at one circle, across the mouth of an angle
// below 60 degrees, is left (Miller, Pav and Walkington, "When and why Ruppert's algorithm works",
// 2003), and so is one that only edges much shorter than any of the input could mend: this is why
// it always ends.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <unordered_set>
#include <utility>
#include <vector>

#include "../base/parallel.hpp"
#include "../mesh/mesh_editor.hpp"
#include "triangle_shape.hpp"
#include "work_queue.hpp"

namespace tinsmith {

class Refiner {
 public:
  enum class Ended { kDone, kTooMany, kStopped };

  // A segment from `from` to `to` was split at `middle`.
  struct Split {
    Vertex from, to, middle;
  };

  Refiner(MeshEditor& editor, const RefinementGoal& goal)
      : editor_(editor),
        mesh_(editor.mesh()),
        shape_(goal),
        input_count_(editor.slots()),
        input_segment_of_(editor.slots(), kNoSegment) {
    editor_.legalize_all();
    editor_.watch();
    const double squared_size = std::min(
        {squared_shortest_edge(), goal.largest_area, goal.longest_edge * goal.longest_edge});
    const double floor = std::max(kFloor * std::sqrt(squared_size), kRoom * rounding());
    squared_floor_ = floor * floor;
  }

  Ended run(std::int32_t most_vertices, Team& team) {
    for (const Triangle t : mesh_.triangles()) examine(t);
    const std::int64_t expected = expect_vertices();
    constexpr int kStepsPerQuestion = 4096;
    for (int until_question = kStepsPerQuestion; has_work(); --until_question) {
      if (until_question == 0) {
        tell(expected, team);
        if (!team.keeps_going(0)) return Ended::kStopped;
        until_question = kStepsPerQuestion;
      }
      if (editor_.count() >= most_vertices) return Ended::kTooMany;
      if (!segments_.is_empty()) {
        serve(segments_.pop());
      } else {
        serve(triangles_.pop());
      }
    }
    return Ended::kDone;
  }

  // In order; the halves of a segment come after it.
  const std::vector<Split>& splits() const { return splits_; }

  // Never split the segment between two vertices.
  void keep_whole(Vertex a, Vertex b) { stuck_.insert(key_of(a, b)); }

  // Why a triangle stays that misses the goal.
  enum class Why : std::int32_t { kAngleBetweenSegments, kNoRoom, kSegmentInTheWay };

  // Call `visit(t, why)` for every triangle of the surface that misses the goal.
  template <typename Visit>
  void visit_left(Visit&& visit) const {
    for (const Triangle t : mesh_.triangles()) {
      if (!is_surface(t)) continue;
      const TurnedTriangle turned = turned_of(t);
      if (shape_.is_large(turned) || shape_.has_small_angle(turned)) visit(t, why_left(t, turned));
    }
  }

 private:
  static constexpr std::int32_t kNoSegment = -1;

  // No edge is made shorter by more than this than the shortest one at the beginning, or than the
  // size asked for. Where the angles of the input are not small, a least angle of 20.7 degrees
  // never needs it.
  static constexpr double kFloor = 1.0 / 64.0;

  // So many times the rounding of coordinates an edge must be long, or there is no telling angles.
  static constexpr double kRoom = 1024.0;

  double rounding() const {
    double largest = 0.0;
    for (const Vertex v : Ids<Vertex>(input_count_)) {
      largest = std::max({largest, std::abs(point(v).x), std::abs(point(v).y)});
    }
    return largest * std::numeric_limits<double>::epsilon();
  }

  // ------------------------------------------------------------------ progress

  // How many vertices a mesh of such triangles has, about.
  std::int64_t expect_vertices() const {
    double twice_area = 0.0;
    for (const Triangle t : mesh_.triangles()) {
      if (!is_surface(t)) continue;
      const auto& c = mesh_[t].corner;
      twice_area += std::abs(detail::twice_area(point(c[0]), point(c[1]), point(c[2])));
    }
    const double count = twice_area / (4.0 * shape_.usual_area());  // a vertex has two triangles
    return static_cast<std::int64_t>(std::clamp(count, 0.0, 1e15));
  }

  // The work that waits is a lower bound of what is left.
  void tell(std::int64_t expected, Team& team) {
    const auto waiting = static_cast<std::int64_t>(segments_.size() + triangles_.size());
    const std::int64_t made = editor_.count() - input_count_;
    team.expect(std::max(made + waiting, expected - input_count_));
    team.advance(made - told_);
    told_ = made;
  }

  std::int32_t input_segment_of(Vertex v) const { return input_segment_of_[number(v)]; }
  bool has_work() const { return !segments_.is_empty() || !triangles_.is_empty(); }
  Point point(Vertex v) const { return editor_.point(v); }

  double squared_shortest_edge() const {
    double least = INFINITY;
    for (const Triangle t : mesh_.triangles()) {
      if (!is_surface(t)) continue;
      for (const HalfEdge e : half_edges(t)) {
        least = std::min(least, squared_distance(point(mesh_.from(e)), point(mesh_.to(e))));
      }
    }
    return least;
  }

  bool is_surface(Triangle t) const { return !mesh_.is_free(t) && !mesh_.is_ghost(t); }

  // ------------------------------------------------------------------ finding

  void examine_touched() {
    editor_.take_touched(touched_);
    examine_in_order();
  }

  void examine_star(Vertex v) {
    touched_.clear();
    for (const HalfEdge e : mesh_.around(v)) touched_.push_back(triangle_of(e));
    examine_in_order();
  }

  void examine_in_order() {
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    for (const Triangle t : touched_) examine(t);
  }

  void examine(Triangle t) {
    if (!is_surface(t)) return;
    bool is_segment_split = false;
    for (const HalfEdge e : half_edges(t)) {
      if (mesh_.is_fixed(e) && !is_stuck(e) && must_split(e)) {
        put_off(e, false);
        is_segment_split = true;
      }
    }
    if (is_segment_split) return;  // the triangle goes with the segment
    const TurnedTriangle turned = turned_of(t);
    if (is_bad(t, turned) && !is_given_up(t)) put_off(t, turned);
  }

  bool is_given_up(Triangle t) const {
    if (given_up_.empty()) return false;
    const auto& c = mesh_[t].corner;
    return given_up_.count(key_of({t, {c[0], c[1], c[2]}})) > 0;
  }

  bool must_split(HalfEdge e) const {
    const Point a = point(mesh_.from(e)), b = point(mesh_.to(e));
    if (shape_.is_long(a, b)) return true;
    for (const HalfEdge side : {e, mesh_.twin(e)}) {
      const Vertex c = mesh_.apex(side);
      if (c != kGhost && encroaches(point(c), a, b)) return true;
    }
    return false;
  }

  // A corner that as good as lies on the segment is not one that splitting could get rid of.
  bool encroaches(Point c, Point a, Point b) const {
    return shape_.encroaches(c, a, b) && squared_height(c, a, b) >= squared_floor_;
  }

  void put_off(HalfEdge e, bool is_ordered) {
    const Vertex a = mesh_.from(e), b = mesh_.to(e);
    segments_.push(rank_of_long(squared_distance(point(a), point(b))), {e, a, b, is_ordered});
  }

  TurnedTriangle turned_of(Triangle t) const {
    const auto& c = mesh_[t].corner;
    return TurnedTriangle::of({point(c[0]), point(c[1]), point(c[2])});
  }

  void put_off(Triangle t, const TurnedTriangle& turned) {
    const auto& c = mesh_[t].corner;
    triangles_.push(rank_of_short(squared_distance(turned.p, turned.q)), {t, {c[0], c[1], c[2]}});
  }

  bool is_bad(Triangle t, const TurnedTriangle& turned) const {
    if (shape_.is_large(turned)) return true;
    return shape_.has_small_angle(turned) && !is_angle_given(t, turned.corner_of_apex);
  }

  Why why_left(Triangle t, const TurnedTriangle& turned) const {
    if (!is_bad(t, turned)) return Why::kAngleBetweenSegments;
    const Point p = shape_.remedy(turned);
    const double squared_radius = squared_distance(p, turned.p);
    if (!std::isfinite(squared_radius) || squared_radius < squared_floor_) return Why::kNoRoom;
    const bool is_in_the_way = is_given_up(t) || walk(t, p).is_blocked;
    return is_in_the_way ? Why::kSegmentInTheWay : Why::kNoRoom;
  }

  // Whether the small angle is one between segments that meet, seen from their own vertex or, on
  // one of the circles around it, from elsewhere.
  bool is_angle_given(Triangle t, int corner_of_apex) const {
    const auto corner = static_cast<std::uint32_t>(corner_of_apex);
    const HalfEdge base = half_edge(t, corner);
    if (mesh_.is_fixed(Mesh::after(base)) && mesh_.is_fixed(Mesh::before(base))) return true;
    const std::int32_t s = input_segment_of(mesh_.from(base)), u = input_segment_of(mesh_.to(base));
    if (s == kNoSegment || u == kNoSegment || s == u) return false;
    for (const Vertex common : input_segments_[s]) {
      if (common != input_segments_[u][0] && common != input_segments_[u][1]) continue;
      const double one = squared_distance(point(common), point(mesh_.from(base)));
      const double other = squared_distance(point(common), point(mesh_.to(base)));
      const double dot = dot_product(point(common), point(mesh_.from(base)), point(mesh_.to(base)));
      if (std::abs(one - other) <= kSameCircle * one && dot > kSmallAngle * one) return true;
    }
    return false;
  }

  static constexpr double kSameCircle = 0.001;  // far beyond rounding, far below a power of two
  static constexpr double kSmallAngle = 0.5;    // cosine: wider ones do no harm [Ruppert 1995]

  // ----------------------------------------------------------------- segments

  void serve(const SegmentWork& work) {
    if (!is_segment(work.edge, work.from, work.to)) return;
    if (work.is_ordered || must_split(work.edge)) {
      split(work.edge);
    } else {  // what was beside it is gone, and its triangles were left to it
      for (const HalfEdge side : {work.edge, mesh_.twin(work.edge)}) examine(triangle_of(side));
    }
  }

  bool is_segment(HalfEdge e, Vertex a, Vertex b) const {
    return !mesh_.is_free(triangle_of(e)) && mesh_.from(e) == a && mesh_.to(e) == b &&
           mesh_.is_fixed(e) && !is_stuck(e);
  }

  // False if there is no room for a point on the segment.
  bool split(HalfEdge e) {
    e = without_free_points(e);
    const Vertex a = mesh_.from(e), b = mesh_.to(e);
    const Point m = place_of_split(e);
    if (!has_room(e, m)) {
      stuck_.insert(key_of(a, b));
      examine_touched();
      for (const HalfEdge side : {e, mesh_.twin(e)}) examine(triangle_of(side));
      return false;
    }
    const std::int32_t segment = input_segment_along(a, b);
    const Vertex slot = editor_.add_slot();
    editor_.insert_at({MeshLocation::Where::kOnEdge, e}, m, slot);
    input_segment_of_.push_back(segment);
    is_free_.push_back(false);
    splits_.push_back({a, b, slot});
    examine_touched();
    return true;
  }

  // Remove points put inside the surface that lie in the circle on the segment; returns the
  // segment's edge as it is then.
  HalfEdge without_free_points(HalfEdge e) {
    const Vertex a = mesh_.from(e), b = mesh_.to(e);
    for (int side = 0; side < 2; ++side, e = mesh_.twin(e)) {
      while (is_free_within(mesh_.apex(e), a, b)) {
        const HalfEdge other_side = mesh_.twin(e);  // which stays as it is
        editor_.remove(mesh_.apex(e));
        e = mesh_.twin(other_side);
      }
    }
    return e;
  }

  bool is_free_within(Vertex c, Vertex a, Vertex b) const {
    return c != kGhost && is_free(c) && dot_product(point(c), point(a), point(b)) < 0.0;
  }
  bool is_free(Vertex v) const {
    return number(v) >= input_count_ && is_free_[number(v) - input_count_];
  }

  // Halfway; from a vertex where another segment makes an angle, at a power of two.
  Point place_of_split(HalfEdge e) const {
    const Point a = point(mesh_.from(e)), b = point(mesh_.to(e));
    const bool is_angle_at_a = is_beside_segment(Mesh::before(e), Mesh::after(mesh_.twin(e)));
    const bool is_angle_at_b = is_beside_segment(Mesh::after(e), Mesh::before(mesh_.twin(e)));
    if (is_angle_at_a == is_angle_at_b) return midpoint(a, b);
    return is_angle_at_a ? on_circle(a, b) : on_circle(b, a);
  }

  bool is_beside_segment(HalfEdge left, HalfEdge right) const {
    return is_segment_of_surface(left) || is_segment_of_surface(right);
  }
  bool is_segment_of_surface(HalfEdge e) const {
    return !mesh_.is_ghost(triangle_of(e)) && mesh_.is_fixed(e);
  }

  // Between a third and two thirds of the way.
  static Point on_circle(Point center, Point end) {
    const double length = std::sqrt(squared_distance(center, end));
    const double radius = std::exp2(std::floor(std::log2(length / 1.5)));
    const double share = radius / length;
    return {center.x + share * (end.x - center.x), center.y + share * (end.y - center.y)};
  }

  // Whether m, rounded, makes triangles on both sides that are turned the right way.
  bool has_room(HalfEdge e, Point m) const {
    const Point a = point(mesh_.from(e)), b = point(mesh_.to(e));
    if (squared_distance(a, m) < squared_floor_ || squared_distance(m, b) < squared_floor_) {
      return false;
    }
    for (const HalfEdge side : {e, mesh_.twin(e)}) {
      if (mesh_.apex(side) == kGhost) continue;
      const Point from = point(mesh_.from(side)), to = point(mesh_.to(side));
      const Point c = point(mesh_.apex(side));
      if (orientation(from, m, c) <= 0 || orientation(m, to, c) <= 0) return false;
    }
    return true;
  }

  // The segment of the input that the one from a to b is a part of.
  std::int32_t input_segment_along(Vertex a, Vertex b) {
    if (input_segment_of(a) != kNoSegment) return input_segment_of(a);
    if (input_segment_of(b) != kNoSegment) return input_segment_of(b);
    input_segments_.push_back({a, b});
    return static_cast<std::int32_t>(input_segments_.size() - 1);
  }

  bool is_stuck(HalfEdge e) const {
    return !stuck_.empty() && stuck_.count(key_of(mesh_.from(e), mesh_.to(e))) > 0;
  }
  static std::uint64_t key_of(Vertex a, Vertex b) {
    return static_cast<std::uint64_t>(number(std::min(a, b))) << 32 |
           static_cast<std::uint32_t>(number(std::max(a, b)));
  }

  // ---------------------------------------------------------------- triangles

  void serve(const TriangleWork& work) {
    const Triangle t = work.triangle;
    if (!is_triangle(work)) return;
    const TurnedTriangle turned = turned_of(t);
    const Point p = shape_.remedy(turned);
    const double squared_radius = squared_distance(p, turned.p);
    if (!std::isfinite(squared_radius) || squared_radius < squared_floor_) return;
    const Found found = walk(t, p);
    if (found.is_blocked) {
      if (!is_stuck(found.at.edge) && split(found.at.edge) && is_triangle(work)) examine(t);
    } else if (found.at.where != MeshLocation::Where::kAtVertex && !insert(found.at, p)) {
      given_up_.insert(key_of(work));
      examine_touched();
    }
  }

  bool is_triangle(const TriangleWork& work) const {
    return is_surface(work.triangle) &&
           std::equal(work.vertex, work.vertex + 3, mesh_[work.triangle].corner);
  }

  using TriangleKey = std::array<Vertex, 3>;
  static TriangleKey key_of(const TriangleWork& work) {
    TriangleKey key{work.vertex[0], work.vertex[1], work.vertex[2]};
    std::sort(key.begin(), key.end());
    return key;
  }

  // Put a point in, unless it would encroach upon segments: then they are split instead. False if
  // neither can be; triangles around may have been made anew.
  bool insert(const MeshLocation& at, Point p) {
    const Vertex slot = editor_.add_slot();
    input_segment_of_.push_back(kNoSegment);
    is_free_.push_back(true);
    // Nothing but the triangles around the vertex changes if it is put within one.
    const bool is_inside = at.where == MeshLocation::Where::kInside;
    editor_.watch(!is_inside);
    editor_.insert_at(at, p, slot);
    editor_.watch();
    const std::vector<HalfEdge> beyond = beyond_encroached(slot);
    if (beyond.empty()) {
      is_inside ? examine_star(slot) : examine_touched();
      return true;
    }
    editor_.remove(slot);
    for (const HalfEdge e : beyond) {
      if (is_stuck(e)) return false;
    }
    for (const HalfEdge e : beyond) put_off(mesh_.twin(e), true);
    examine_touched();
    return true;
  }

  // Segments that a vertex sees under too large an angle, as seen from beyond them: so they are
  // still called when the vertex is gone.
  std::vector<HalfEdge> beyond_encroached(Vertex v) const {
    std::vector<HalfEdge> found;
    for (const HalfEdge e : mesh_.around(v)) {
      const HalfEdge opposite = Mesh::after(e);
      if (mesh_.is_fixed(opposite) &&
          encroaches(point(v), point(mesh_.from(opposite)), point(mesh_.to(opposite)))) {
        found.push_back(mesh_.twin(opposite));
      }
    }
    return found;
  }

  struct Found {
    MeshLocation at;
    bool is_blocked;  // by the segment at.edge
  };

  // From triangle to triangle towards p, across edges that are no segments. Every step goes to a
  // circle of smaller power about p, because such edges are Delaunay: the walk ends.
  Found walk(Triangle t, Point p) const {
    HalfEdge blocking = kNoHalfEdge;
    bool is_within = true;
    const HalfEdge end = walk_towards(unentered(t), mesh_.triangle_slots(), [&](HalfEdge entry) {
      HalfEdge across = blocking = kNoHalfEdge;
      is_within = true;
      for (const HalfEdge e : half_edges(triangle_of(entry))) {
        if (e == entry) continue;  // which has p on this side
        const int side = orientation(point(mesh_.from(e)), point(mesh_.to(e)), p);
        is_within &= side > 0;
        if (side >= 0) continue;
        HalfEdge& kind = mesh_.is_fixed(e) ? blocking : across;
        if (kind == kNoHalfEdge || is_apex_before(e, kind)) kind = e;
      }
      return across == kNoHalfEdge ? entry : mesh_.twin(across);
    });
    if (end == kNoHalfEdge) {
      throw std::logic_error("a walk to the remedy of a triangle did not arrive");
    }
    if (blocking != kNoHalfEdge) return {{MeshLocation::Where::kOnEdge, blocking}, true};
    if (is_within) return {{MeshLocation::Where::kInside, half_edge(triangle_of(end), 0)}, false};
    const auto point_at = [this](Vertex v) { return point(v); };
    const MeshLocation at = location_in(mesh_, point_at, triangle_of(end), p);
    return {at, at.where == MeshLocation::Where::kOnEdge && mesh_.is_fixed(at.edge)};
  }

  bool is_apex_before(HalfEdge e, HalfEdge f) const {
    return lexicographically_before(point(mesh_.apex(e)), point(mesh_.apex(f)));
  }

  MeshEditor& editor_;
  const Mesh& mesh_;
  ShapeTest shape_;
  std::int32_t input_count_;
  double squared_floor_ = 0.0;
  std::vector<std::int32_t> input_segment_of_;  // of vertices put on segments
  std::vector<std::array<Vertex, 2>>
      input_segments_;         // ends of the input's segments that were split
  std::vector<bool> is_free_;  // of the vertices put in: inside the surface
  std::vector<Split> splits_;
  std::int64_t told_ = 0;                    // of the vertices put in
  std::unordered_set<std::uint64_t> stuck_;  // segments that have no room for a point
  std::vector<Triangle> touched_;
  std::set<TriangleKey> given_up_;  // triangles that cannot be mended
  WorkQueue<SegmentWork> segments_;
  WorkQueue<TriangleWork> triangles_;
};

}  // namespace tinsmith
