// Walking through a mesh to the triangle that holds a point.
//
// Jump-and-walk (Muecke, Saias and Zhu, "Fast randomized point location without preprocessing in
// two- and three-dimensional Delaunay triangulations", 1999); the walk is the stochastic one of
// the visibility walks, with the straight one behind it.
#pragma once

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "../base/ids.hpp"
#include "../insertion/straight_walk.hpp"
#include "../location/visibility_walk.hpp"
#include "../predicates/predicates.hpp"
#include "mesh.hpp"
#include "mesh_points.hpp"

namespace tinsmith {

struct MeshLocation {
  enum class Where { kInside, kOnEdge, kAtVertex, kOutside };
  Where where;
  HalfEdge edge;  // of the triangle; the edge; one that leaves the vertex; of the ghost
};

// Of a point that a triangle holds, perhaps on its boundary.
template <typename AnyMesh, typename PointAt>
MeshLocation location_in(const AnyMesh& mesh, PointAt&& point_at, Triangle t, Point p) {
  for (const HalfEdge e : half_edges(t)) {
    if (point_at(mesh.apex(e)) == p) return {MeshLocation::Where::kAtVertex, Mesh::before(e)};
  }
  for (const HalfEdge e : half_edges(t)) {
    if (orientation(point_at(mesh.from(e)), point_at(mesh.to(e)), p) == 0) {
      return {MeshLocation::Where::kOnEdge, e};
    }
  }
  return {MeshLocation::Where::kInside, half_edge(t, 0)};
}

// One walk: exact, and no longer than a few times what the distance asks for.
template <typename AnyMesh, typename Points>
class PointSearch {
 public:
  // `state` of the random choices, which never show in the result.
  PointSearch(const AnyMesh& mesh, const Points& points, std::int32_t vertex_count,
              std::uint64_t& state)
      : mesh_(mesh), points_(points), count_(vertex_count), state_(state) {}

  // `last` is an edge that may be near, or kNoHalfEdge; if it is not, find_landmark() is a vertex
  // that may be, or kGhost.
  template <typename FindLandmark>
  MeshLocation locate(Point p, HalfEdge last, FindLandmark&& find_landmark) {
    HalfEdge e = nearest_start(p, last, find_landmark);
    if (mesh_.is_ghost(triangle_of(e))) e = real_side(triangle_of(e));
    const Triangle start = triangle_of(e);
    bool is_outside = false;
    const HalfEdge end = walk_towards(unentered(start), most_steps(), [&](HalfEdge entry) {
      if (is_outside) return entry;
      const HalfEdge beyond = entry_beyond(p, entry);
      is_outside = beyond != entry && mesh_.apex(beyond) == kGhost;
      return beyond;
    });
    if (end == kNoHalfEdge) return locate_straight(p, start);
    if (is_outside) return {MeshLocation::Where::kOutside, end};
    return location_in(p, triangle_of(end));
  }

 private:
  // The walk begins at the last change, at the landmark, or at the nearest of a few vertices drawn
  // at random: as many as make the walk from there as short as the drawing.
  template <typename FindLandmark>
  HalfEdge nearest_start(Point p, HalfEdge last, FindLandmark&& find_landmark) {
    HalfEdge best = last;
    if (best == kNoHalfEdge || mesh_.is_free(triangle_of(best))) best = first_edge();
    double nearest = distance_to(p, best);
    if (nearest <= kShortWalk * square_of(best)) return best;
    const Vertex landmark = find_landmark();
    if (landmark != kGhost && mesh_.is_alive(landmark)) {
      const HalfEdge there = mesh_.leaving(landmark);
      return distance_to(p, there) < nearest ? there : best;
    }
    const auto draws = static_cast<std::int32_t>(0.5 * std::cbrt(static_cast<double>(count_)));
    for (std::int32_t i = 0; i < draws; ++i) {
      const Vertex v{
          static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(points_.slots()))};
      if (!mesh_.is_alive(v)) continue;
      const double distance = distance_to(p, mesh_.leaving(v));
      if (distance < nearest) {
        nearest = distance;
        best = mesh_.leaving(v);
      }
    }
    return best;
  }

  static constexpr double kShortWalk = 64.0;  // as a square: eight edges

  // Squares, of the distance to the edge's start and of its length.
  double distance_to(Point p, HalfEdge e) const {
    const Vertex v = mesh_.from(e) == kGhost ? mesh_.to(e) : mesh_.from(e);
    return square(points_[v], p);
  }
  double square_of(HalfEdge e) const {
    const Vertex a = mesh_.from(e), b = mesh_.to(e);
    return a == kGhost || b == kGhost ? 0.0 : square(points_[a], points_[b]);
  }
  static double square(Point p, Point q) {
    const double dx = q.x - p.x, dy = q.y - p.y;
    return dx * dx + dy * dy;
  }

  HalfEdge first_edge() const {
    for (const Triangle t : mesh_.triangles()) {
      if (!mesh_.is_free(t)) return half_edge(t, 0);
    }
    throw std::logic_error("a mesh without triangles holds no point");
  }

  // An edge of the triangle on the other side of a ghost's hull edge.
  HalfEdge real_side(Triangle ghost) const {
    for (const HalfEdge e : half_edges(ghost)) {
      if (mesh_.apex(e) == kGhost) return mesh_.twin(e);
    }
    throw std::logic_error("a triangle without the ghost is no ghost");
  }

  // From a start within a share of the landmarks' cells a walk takes some dozen steps, from one of
  // the drawn vertices a few times the cube root of all; one that takes more has strayed among
  // slivers.
  std::uint32_t most_steps() const {
    return 100 + static_cast<std::uint32_t>(8.0 * std::cbrt(static_cast<double>(count_)));
  }

  MeshLocation locate_straight(Point p, Triangle start) const {
    const auto triangle_at = [this](Triangle t) -> const GhostTriangle& {
      return mesh_.complete(t);
    };
    const auto point_at = [this](Vertex v) { return points_[v]; };
    const Triangle t = StraightWalk(triangle_at, point_at, mesh_.triangle_slots()).find(p, start);
    for (const HalfEdge e : half_edges(t)) {
      if (mesh_.apex(e) == kGhost) return outside_or_on(p, e);
    }
    return location_in(p, t);
  }

  // p is beyond the hull edge of a ghost, or on it.
  MeshLocation outside_or_on(Point p, HalfEdge ghost) const {
    const bool is_on = orientation(points_[mesh_.from(ghost)], points_[mesh_.to(ghost)], p) == 0;
    if (is_on) return location_in(p, triangle_of(mesh_.twin(ghost)));
    return {MeshLocation::Where::kOutside, ghost};
  }

  // Across an edge that has p on its other side, or the same entry. The edges are tried from a
  // random one on: among fixed edges a walk in fixed order could go round and round.
  HalfEdge entry_beyond(Point p, HalfEdge entry) {
    std::uint32_t corner = static_cast<std::uint32_t>(random() % 3);
    for (int i = 0; i < 3; ++i, corner = corner_after(corner)) {
      const HalfEdge e = half_edge(triangle_of(entry), corner);
      if (e == entry) continue;
      if (orientation(points_[mesh_.from(e)], points_[mesh_.to(e)], p) < 0) return mesh_.twin(e);
    }
    return entry;
  }

  MeshLocation location_in(Point p, Triangle t) const {
    return tinsmith::location_in(mesh_, [this](Vertex v) { return points_[v]; }, t, p);
  }

  std::uint64_t random() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX
    return state_ >> 33;
  }

  const AnyMesh& mesh_;
  const Points& points_;
  std::int32_t count_;
  std::uint64_t& state_;
};

}  // namespace tinsmith
