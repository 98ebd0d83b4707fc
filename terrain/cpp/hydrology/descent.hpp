// Drops followed down a surface, as far as doubles can tell where they go.
//
// terrain/hydrology/descent.py does the same for any drops, and with fractions where doubles cannot
// tell; what is "undecided" here is left to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/base/range.hpp"
#include "falling_surface.hpp"
#include "filling.hpp"
#include "steepness.hpp"

namespace tinsmith::hydrology {

// As descent.py numbers them.
enum class End : std::int8_t { kMoving, kPit, kFlat, kBoundary };

// At a vertex, or on an edge: about to enter its triangle, to follow it to the target, or ended.
struct Drop {
  Vertex vertex = kNoVertex;
  Place place{kNoHalfEdge, 0.0};
  Vertex target = kNoVertex;
  End end = End::kMoving;

  bool runs_on() const { return vertex == kNoVertex && target == kNoVertex && end == End::kMoving; }
};

// Steepest descent from a vertex: along an edge, or down a triangle.
struct Exit {
  Vertex vertex = kNoVertex;
  Triangle triangle = kNoTriangle;
  bool leaves = false;  // water leaves the surface there
};

class Descent {
 public:
  Descent(const FallingSurface& falls, const Base* bases, const Filling& filling)
      : falls_(falls), bases_(bases), filling_(filling) {}

  // A drop that comes to an edge from within a triangle.
  Drop arrive(Place at) const {
    Drop drop;
    drop.place = at;
    if (at.share == 0.0 || at.share == 1.0) {
      drop.vertex = at.share == 0.0 ? falls_.start(at.edge) : falls_.end(at.edge);
      return drop;
    }
    const HalfEdge beyond = falls_.across(at.edge);
    if (beyond == kNoHalfEdge) {
      drop.end = End::kBoundary;
    } else if (falls_.sign(beyond) < 0) {
      drop.place = {beyond, 1.0 - at.share};
    } else if (stops(at.edge, beyond)) {
      drop.end = End::kFlat;
    } else {
      drop.target = choose_end(at.edge);
    }
    return drop;
  }

  // Through a triangle to another edge; nothing if undecided.
  std::optional<Drop> cross(Place from) const {
    const std::optional<Place> out = follow(from);
    if (!out) return {};
    const Place to{out->edge, round_share(out->share)};
    if (!is_lower(to, from)) return {};
    return arrive(to);
  }

 private:
  // Relative error of an elevation between two vertices, as doubles have it.
  static constexpr double kRounding = 16 * 0x1p-53;
  // Shares of an edge that differ by less are compared in fractions.
  static constexpr double kClose = 1e-9;

  bool stops(HalfEdge e, HalfEdge beyond) const {
    if (filling_.is_there()) return false;
    return falls_.elevation(falls_.start(e)) == falls_.elevation(falls_.end(e)) ||
           falls_.is_level(triangle_of(beyond));
  }

  // To which end of an edge water runs.
  Vertex choose_end(HalfEdge e) const {
    const Vertex start = falls_.start(e), end = falls_.end(e);
    if (filling_.is_there() && filling_.level(start) == filling_.level(end)) {
      return filling_.choose_way(start, end);
    }
    return falls_.elevation(start) < falls_.elevation(end) ? start : end;
  }

  // Where one edge drains, all fall lines go there; where two do, the fall line through the corner
  // between them parts the others.
  std::optional<Place> follow(Place from) const {
    const Base& base = bases_[number(triangle_of(from.edge))];
    if (!base.drains && !(std::fabs(from.share - base.split) > kClose)) return {};
    return base.follow(from);
  }

  bool is_lower(Place after, Place before) const {
    const auto [high, size] = interpolate(before);
    const auto [low, other] = interpolate(after);
    return high - low > kRounding * std::max(size, other);
  }

  struct Elevation {
    double value, size;
  };
  Elevation interpolate(Place at) const {
    const double low = falls_.elevation(falls_.start(at.edge));
    const double high = falls_.elevation(falls_.end(at.edge));
    return {low + at.share * (high - low), std::max(std::fabs(low), std::fabs(high))};
  }

  const FallingSurface& falls_;
  const Base* bases_;
  const Filling& filling_;
};

// Which way water leaves vertices. Edges are compared exactly where doubles cannot tell; where a
// triangle is as steep, nothing is chosen here. Triangles are read as they lie in memory, by each
// thread all of them for its own vertices: so one order holds at every vertex.
class ExitTable {
 public:
  // Ask the team whether it was stopped.
  ExitTable(const FallingSurface& falls, const Filling& filling, const bool* is_boundary,
            Team& team)
      : falls_(falls),
        filling_(filling),
        is_boundary_(is_boundary),
        ways_(scratch_array<Ways>(falls.surface.point_count)) {
    std::fill_n(ways_.get(), falls.surface.point_count, Ways{});
    team.run([&](int part) {
      Pulse pulse(team, part);
      const Range own = part_of(falls.surface.point_count, part, team.size());
      for (const Triangle t : Ids<Triangle>(falls.surface.triangle_count)) {
        if (!pulse.goes_on()) return;
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::int32_t v = number(falls.surface.vertex(t, k));
          if (own.begin <= v && v < own.end) list_ways(half_edge(t, k));
        }
      }
    });
  }

  // Nothing if undecided.
  std::optional<Exit> find(Vertex v) const {
    if (filling_.is_there() && filling_.next(v) != kNoVertex) return Exit{filling_.next(v)};
    const Ways& ways = ways_[number(v)];
    if (ways.is_spoilt) return {};
    if (ways.slope > 0.0 && ways.rival >= ways.slope - kClose * ways.slope) return {};
    const bool leaves = is_boundary_[number(v)] && (ways.slope == 0.0 || ways.drains);
    return Exit{leaves ? kNoVertex : ways.vertex, ways.triangle, leaves};
  }

 private:
  // Slopes that differ by less, relative to the steepest, are compared in fractions.
  static constexpr double kClose = 1e-9;
  // Relative error of a product of two differences.
  static constexpr double kRounding = 4 * 0x1p-53;
  static constexpr double kLeastSlope = std::numeric_limits<double>::denorm_min();

  // The steepest way from a vertex: along an edge, or down a triangle.
  struct Ways {
    double slope = 0.0;
    double rival = 0.0;  // the slope of the next one
    Vertex vertex = kNoVertex;
    Triangle triangle = kNoTriangle;
    bool drains = false;     // the edge is of the boundary, and its triangle drains across it
    bool is_spoilt = false;  // the slope of one is not known
  };

  // Of the corner opposite an edge: the edge on one side of the triangle, at the boundary that on
  // the other side, and the triangle.
  void list_ways(HalfEdge opposite) {
    const Triangle t = triangle_of(opposite);
    const std::uint32_t k = corner_of(opposite);
    const HalfEdge first = half_edge(t, corner_before(k)), last = half_edge(t, corner_after(k));
    const Vertex v = falls_.surface.vertex(t, k);
    list_edge(v, falls_.start(opposite), first);
    if (is_outside(last)) list_edge(v, falls_.end(opposite), last);
    if (falls_.sign(opposite) > 0 && falls_.sign(last) < 0 && falls_.sign(first) < 0) {
      list_triangle(v, t);
    }
  }

  void list_edge(Vertex v, Vertex end, HalfEdge e) {
    if (!(falls_.elevation(end) < falls_.elevation(v)) || !is_dry(end, v)) return;
    Ways& ways = ways_[number(v)];
    const double slope = measure(v, end);
    if (!(is_close(ways, slope) ? is_better(v, end, ways) : take(ways, slope))) return;
    ways.slope = std::max(ways.slope, slope);
    ways.vertex = end;
    ways.triangle = kNoTriangle;
    ways.drains = falls_.sign(e) > 0 && is_outside(e);
  }

  void list_triangle(Vertex v, Triangle t) {
    if (!is_dry(lowest_corner(t), v)) return;
    Ways& ways = ways_[number(v)];
    const double slope = measure(t);
    if (!(slope > 0.0)) ways.is_spoilt = true;
    if (!take(ways, slope)) return;
    ways.vertex = kNoVertex;
    ways.triangle = t;
    ways.drains = false;
  }

  // Whether doubles cannot tell an edge from the steepest one so far.
  static bool is_close(const Ways& ways, double slope) {
    const double steepest = std::max(ways.slope, slope);
    return ways.vertex != kNoVertex && std::min(ways.slope, slope) >= steepest - kClose * steepest;
  }

  // Whether an edge is steeper than the steepest one so far, or as steep and of smaller azimuth.
  bool is_better(Vertex v, Vertex end, const Ways& ways) const {
    const int compared = compare_slopes(falls_.surface, v, end, ways.vertex);
    return compared > 0 || (compared == 0 && is_before(falls_.surface, v, end, ways.vertex));
  }

  // Whether a slope is the steepest so far.
  static bool take(Ways& ways, double slope) {
    if (!(slope > ways.slope)) {
      ways.rival = std::max(ways.rival, slope);
      return false;
    }
    ways.rival = ways.slope;
    ways.slope = slope;
    return true;
  }

  bool is_outside(HalfEdge e) const {
    return !falls_.surface.is_triangle(falls_.surface.neighbor(triangle_of(e), corner_of(e)));
  }

  // Water stands lower than a vertex, if any does.
  bool is_dry(Vertex beyond, Vertex v) const {
    return !filling_.is_there() || filling_.level(beyond) < falls_.elevation(v);
  }

  Vertex lowest_corner(Triangle t) const {
    std::uint32_t lowest = 0;
    for (std::uint32_t k = 1; k < 3; ++k) {
      if (falls_.surface.elevation(t, k) < falls_.surface.elevation(t, lowest)) lowest = k;
    }
    return falls_.surface.vertex(t, lowest);
  }

  double measure(Vertex start, Vertex end) const {
    const double* const p = falls_.surface.row(start);
    const double* const q = falls_.surface.row(end);
    // Of a fall that underflows there is still a descent.
    return std::max(-(q[2] - p[2]) / std::hypot(q[0] - p[0], q[1] - p[1]), kLeastSlope);
  }

  // 0 if rounding spoils it.
  double measure(Triangle t) const {
    const double* const a = falls_.surface.row(falls_.surface.vertex(t, 0));
    const double* const b = falls_.surface.row(falls_.surface.vertex(t, 1));
    const double* const c = falls_.surface.row(falls_.surface.vertex(t, 2));
    double normal[3];
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double left = (b[i] - a[i]) * (c[j] - a[j]), right = (b[j] - a[j]) * (c[i] - a[i]);
      normal[k] = left - right;
      const double size = std::fabs(left) + std::fabs(right);
      if (std::fabs(left - right) * kClose < size * kRounding) return 0.0;
    }
    const double slope = std::hypot(normal[0], normal[1]) / normal[2];
    return std::isfinite(slope) ? slope : 0.0;
  }

  const FallingSurface& falls_;
  const Filling& filling_;
  const bool* is_boundary_;
  ScratchArray<Ways> ways_;  // of vertices
};

}  // namespace tinsmith::hydrology
