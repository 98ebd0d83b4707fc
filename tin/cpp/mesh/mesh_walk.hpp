// Walking through a mesh to the triangle that holds a place.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "../base/arrays.hpp"
#include "../insertion/straight_walk.hpp"
#include "../predicates/predicates.hpp"
#include "mesh.hpp"

namespace tinsmith {

using MeshPoints = ScratchVector<Point>;  // by slot; one without a vertex holds anything

struct MeshLocation {
  enum class Where { kInside, kOnEdge, kAtVertex, kOutside };
  Where where;
  MeshEdge edge;  // of the triangle; the edge; one that leaves the vertex; of the ghost
};

// One walk: exact, and no longer than a few times what the distance asks for.
class MeshWalk {
 public:
  // `state` of the random choices, which never show in the result.
  MeshWalk(const Mesh& mesh, const MeshPoints& points, std::int32_t vertex_count,
           std::uint64_t& state)
      : mesh_(mesh), points_(points), count_(vertex_count), state_(state) {}

  // `last` is an edge that may be near, or kNoMeshEdge; `landmark` a vertex that may be, or kGhost.
  MeshLocation locate(Point p, MeshEdge last, std::int32_t landmark) {
    MeshEdge e = nearest_start(p, last, landmark);
    if (mesh_.is_ghost(triangle_of(e))) e = real_side(triangle_of(e));
    const std::uint32_t start = triangle_of(e);
    std::uint32_t t = start;
    std::uint32_t entry = kNoPlace;
    for (int steps = most_steps(); steps > 0; --steps) {
      const std::uint32_t place = place_beyond(p, t, entry);
      if (place == kNoPlace) return location_in(p, t);
      const MeshEdge across = mesh_.twin(mesh_edge(t, place));
      if (mesh_.corner(across) == kGhost) return {MeshLocation::Where::kOutside, across};
      t = triangle_of(across);
      entry = place_of(across);
    }
    return locate_straight(p, start);
  }

 private:
  static constexpr std::uint32_t kNoPlace = 3;

  // The walk begins at the last change, at the landmark, or at the nearest of a few vertices drawn
  // at random: as many as make the walk from there as short as the drawing.
  MeshEdge nearest_start(Point p, MeshEdge last, std::int32_t landmark) {
    MeshEdge best = last;
    if (best == kNoMeshEdge || mesh_.is_free(triangle_of(best))) best = first_edge();
    double nearest = distance_to(p, best);
    if (nearest <= kShortWalk * square_of(best)) return best;
    if (landmark != kGhost && mesh_.is_alive(landmark)) {
      const MeshEdge there = mesh_.leaving(landmark);
      return distance_to(p, there) < nearest ? there : best;
    }
    const auto draws = static_cast<std::int32_t>(0.5 * std::cbrt(static_cast<double>(count_)));
    for (std::int32_t i = 0; i < draws; ++i) {
      const auto v = static_cast<std::int32_t>(random() % points_.size());
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
  double distance_to(Point p, MeshEdge e) const {
    const std::int32_t v = mesh_.from(e) == kGhost ? mesh_.to(e) : mesh_.from(e);
    return square(points_[v], p);
  }
  double square_of(MeshEdge e) const {
    const std::int32_t a = mesh_.from(e), b = mesh_.to(e);
    return a == kGhost || b == kGhost ? 0.0 : square(points_[a], points_[b]);
  }
  static double square(Point p, Point q) {
    const double dx = q.x - p.x, dy = q.y - p.y;
    return dx * dx + dy * dy;
  }

  MeshEdge first_edge() const {
    std::uint32_t t = 0;
    while (mesh_.is_free(t)) ++t;
    return mesh_edge(t, 0);
  }

  // An edge of the triangle on the other side of a ghost's hull edge.
  MeshEdge real_side(std::uint32_t ghost) const {
    std::uint32_t place = 0;
    while (mesh_[ghost].corner[place] != kGhost) ++place;
    return mesh_[ghost].twin[place];
  }

  // From a start within a share of the landmarks' cells a walk takes some dozen steps, from one of
  // the drawn vertices a few times the cube root of all; one that takes more has strayed among
  // slivers.
  int most_steps() const { return 100 + static_cast<int>(8.0 * std::cbrt(static_cast<double>(count_))); }

  MeshLocation locate_straight(Point p, std::uint32_t start) const {
    const auto triangle_at = [this](std::uint32_t t) -> const GhostTriangle& { return mesh_[t]; };
    const auto point_at = [this](std::int32_t vertex) { return points_[vertex]; };
    const std::uint32_t t = StraightWalk(triangle_at, point_at).find(p, start);
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (mesh_[t].corner[k] == kGhost) return outside_or_on(p, mesh_edge(t, k));
    }
    return location_in(p, t);
  }

  // p is beyond the hull edge of a ghost, or on it.
  MeshLocation outside_or_on(Point p, MeshEdge ghost) const {
    const bool is_on = orientation(points_[mesh_.from(ghost)], points_[mesh_.to(ghost)], p) == 0;
    if (is_on) return location_in(p, triangle_of(mesh_.twin(ghost)));
    return {MeshLocation::Where::kOutside, ghost};
  }

  // The place of an edge that has p on its other side, or kNoPlace. The edges are tried from a
  // random one on: among fixed edges a walk in fixed order could go round and round.
  std::uint32_t place_beyond(Point p, std::uint32_t t, std::uint32_t entry) {
    std::uint32_t place = static_cast<std::uint32_t>(random() % 3);
    for (int i = 0; i < 3; ++i, place = place_after(place)) {
      if (place == entry) continue;
      const MeshEdge e = mesh_edge(t, place);
      if (orientation(points_[mesh_.from(e)], points_[mesh_.to(e)], p) < 0) return place;
    }
    return kNoPlace;
  }

  // p is in the triangle or on its rim.
  MeshLocation location_in(Point p, std::uint32_t t) const {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (points_[mesh_[t].corner[k]] == p) return {MeshLocation::Where::kAtVertex, mesh_edge(t, place_before(k))};
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      const MeshEdge e = mesh_edge(t, k);
      if (orientation(points_[mesh_.from(e)], points_[mesh_.to(e)], p) == 0) {
        return {MeshLocation::Where::kOnEdge, e};
      }
    }
    return {MeshLocation::Where::kInside, mesh_edge(t, 0)};
  }

  std::uint64_t random() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX
    return state_ >> 33;
  }

  const Mesh& mesh_;
  const MeshPoints& points_;
  std::int32_t count_;
  std::uint64_t& state_;
};

}  // namespace tinsmith
