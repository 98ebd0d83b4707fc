// The elevation of the surface at a vertex, as it would be without that vertex.
//
// What a vertex leaves behind is the polygon of its neighbours, which is triangulated anew
// (Devillers, "On deletion in Delaunay triangulations", 1999). Of that triangulation one triangle
// is needed, the one that holds the place. All neighbours are seen from there, so no line hides
// any of them, and the triangle is the one whose circle holds none of them. It is found from any
// triangle of neighbours that holds the place: while one lies in its circle the edge or triangle
// that it takes part in is flipped, which only lowers the lifted plane there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../base/pulse.hpp"
#include "../base/range.hpp"
#include "../location/surface.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// A corner of each vertex as the half-edge opposite; kNoHalfEdge for one that no triangle has.
inline ScratchArray<HalfEdge> find_corners(const Surface& surface) {
  auto corners = scratch_array<HalfEdge>(static_cast<std::size_t>(surface.point_count));
  for (const Vertex v : Ids<Vertex>(surface.point_count)) corners[number(v)] = kNoHalfEdge;
  for (std::size_t i = 0; i < std::size_t{3} * surface.triangle_count; ++i) {
    corners[surface.corners[i]] = half_edge_at(i);
  }
  return corners;
}

// Lowest and highest elevation of the neighbours of each vertex, and the square of the distance to
// the nearest, three numbers each; infinite where there is none.
inline void measure_neighbors(const Surface& surface, double* found) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < static_cast<std::size_t>(surface.point_count); ++i) {
    found[3 * i] = kFar;
    found[3 * i + 1] = -kFar;
    found[3 * i + 2] = kFar;
  }
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Vertex ends[2] = {surface.vertex(t, k), surface.vertex(t, corner_after(k))};
      const Point a = surface.point(ends[0]), b = surface.point(ends[1]);
      const double square = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
      for (int side = 0; side < 2; ++side) {
        double* const own = found + 3 * static_cast<std::size_t>(number(ends[side]));
        const double z = surface.elevation(ends[1 - side]);
        own[0] = std::min(own[0], z);
        own[1] = std::max(own[1], z);
        own[2] = std::min(own[2], square);
      }
    }
  }
}

// An elevation between others, and the mean of the squared distances to these by their weights:
// half of it times the curvature of the ground is how much the elevation is off.
struct Interpolated {
  double elevation, moment;
};

class LeaveOneOut {
 public:
  LeaveOneOut(const Surface& surface, const HalfEdge* corners)
      : surface_(surface), corners_(corners) {}

  // The neighbours of a vertex: of one on the boundary from its first edge to its last.
  void list_neighbors(Vertex v, std::vector<std::int32_t>& neighbors) const {
    const HalfEdge first = corners_[number(v)];
    if (first == kNoHalfEdge) return;
    const HalfEdge start = turn_back(first);
    HalfEdge e = start, last = start;
    do {
      neighbors.push_back(vertex_at(e, corner_after(corner_of(e))));
      last = e;
      e = surface_.next_about(e, Surface::Turn::kCounterClockwise);
    } while (e != start && e != kNoHalfEdge);
    if (e == kNoHalfEdge) neighbors.push_back(vertex_at(last, corner_before(corner_of(last))));
  }

  // The elevation at a vertex without it; NaN where the place lies outside of the surface of the
  // others, or on its boundary where that is not straight.
  Interpolated interpolate_without(Vertex v) {
    const HalfEdge corner = corners_[number(v)];
    if (corner == kNoHalfEdge) return {kNone, kNone};
    const Point p = surface_.point(v);
    if (!gather_ring(corner)) return interpolate_on_boundary(p);
    Holder holder = find_holder(p);
    while (improve(p, holder)) continue;
    const std::size_t corners[3] = {holder.a, holder.b, holder.c};
    const auto weights = CornerWeights::at(p, at(holder.a), at(holder.b), at(holder.c));
    double elevations[3], moment = 0.0;
    for (int k = 0; k < 3; ++k) {
      elevations[k] = ring_[corners[k]].z;
      moment += weights.of[k] * square_to(p, at(corners[k]));
    }
    return {weights.mean_of(elevations), moment / weights.total()};
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  struct Holder {  // a triangle of neighbours that holds the place, counter-clockwise
    std::size_t a, b, c;
  };

  std::int32_t vertex_at(HalfEdge corner, std::uint32_t k) const {
    return number(surface_.vertex(triangle_of(corner), k));
  }

  // The corner behind which the boundary lies, clockwise; the same if there is none.
  HalfEdge turn_back(HalfEdge first) const {
    HalfEdge start = first;
    for (HalfEdge e = first; e != kNoHalfEdge;) {
      start = e;
      e = surface_.next_about(e, Surface::Turn::kClockwise);
      if (e == first) return first;
    }
    return start;
  }

  Point at(std::size_t i) const { return ring_[i].at; }

  void add(HalfEdge corner, std::uint32_t k) {
    const Vertex w = surface_.vertex(triangle_of(corner), k);
    ring_.push_back(surface_.surface_point(w));
  }

  // The neighbours counter-clockwise; false if the vertex is on the boundary.
  bool gather_ring(HalfEdge first) {
    using Turn = Surface::Turn;
    ring_.clear();
    HalfEdge corner = first;
    do {
      add(corner, corner_after(corner_of(corner)));
      corner = surface_.next_about(corner, Turn::kCounterClockwise);
    } while (corner != first && corner != kNoHalfEdge);
    if (corner == first) return true;
    HalfEdge end = first;
    for (HalfEdge e = first; e != kNoHalfEdge;
         e = surface_.next_about(e, Turn::kCounterClockwise)) {
      end = e;
    }
    const HalfEdge start = turn_back(first);
    ring_.clear();
    add(start, corner_after(corner_of(start)));
    add(end, corner_before(corner_of(end)));
    return false;
  }

  // On a straight part of the boundary the edge between both neighbours takes its place.
  Interpolated interpolate_on_boundary(Point p) const {
    const Point a = at(0), b = at(1);
    const double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
    if (orientation(a, b, p) != 0 || ax * bx + ay * by >= 0.0) return {kNone, kNone};
    const double to_a = std::hypot(ax, ay), to_b = std::hypot(bx, by);
    const double share = to_a / (to_a + to_b);
    return {(1.0 - share) * ring_[0].z + share * ring_[1].z, to_a * to_b};
  }

  static double square_to(Point p, Point q) {
    return (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
  }

  bool holds(Point p, const Holder& t) const {
    return orientation(at(t.a), at(t.b), p) >= 0 && orientation(at(t.b), at(t.c), p) >= 0 &&
           orientation(at(t.c), at(t.a), p) >= 0;
  }

  // The line from the first neighbour through the place leaves between two others.
  Holder find_holder(Point p) const {
    std::size_t last = 1;
    while (last + 2 < ring_.size() && orientation(at(0), p, at(last + 1)) <= 0) ++last;
    return {0, last, last + 1};
  }

  // Flip towards the first neighbour that lies in the circle; false if there is none.
  bool improve(Point p, Holder& t) const {
    for (std::size_t d = 0; d < ring_.size(); ++d) {
      if (d == t.a || d == t.b || d == t.c) continue;
      if (!is_in_circle(at(t.a), at(t.b), at(t.c), at(d))) continue;
      flip_towards(p, t, d);
      return true;
    }
    return false;
  }

  void flip_towards(Point p, Holder& t, std::size_t d) const {
    for (int turn = 0; turn < 3; ++turn) {
      if (orientation(at(t.a), at(t.b), at(d)) <= 0) {  // beyond the edge from a to b
        t = orientation(at(t.c), at(d), p) > 0 ? Holder{t.c, d, t.b} : Holder{t.c, t.a, d};
        return;
      }
      t = {t.b, t.c, t.a};
    }
    for (const Holder& part : {Holder{t.a, t.b, d}, Holder{t.b, t.c, d}, Holder{t.c, t.a, d}}) {
      if (holds(p, part)) {
        t = part;
        return;
      }
    }
  }

  const Surface& surface_;
  const HalfEdge* corners_;
  std::vector<SurfacePoint> ring_;
};

// At some vertices. Check `team.is_stopped()` afterwards.
inline void leave_one_out(const Surface& surface, const HalfEdge* corners,
                          const std::int32_t* vertices, std::int32_t count, Interpolated* found,
                          Team& team) {
  team.run([&](int part) {
    LeaveOneOut local(surface, corners);
    Pulse pulse(team, part);
    const Range range = part_of(count, part, team.size());
    for (std::int32_t i = range.begin; i < range.end && pulse.goes_on(); ++i) {
      found[i] = local.interpolate_without(Vertex{vertices[i]});
    }
  });
}

}  // namespace tinsmith
