// Insertion: the same triangulation by local change, one point at a time, for points so uneven
// that a grid does not help the growth.
//
// A new point alters only its domain of influence: the triangles whose circle holds it. They are
// removed and the hole is filled with a fan about the point. Ties are decided by the point set
// alone (is_in_circle), so the result is the growth's. The order of insertion only sets the speed:
// random rounds, each twice as large as the one before and sorted along a Hilbert curve, make the
// expected work per point constant for every distribution.
//
// One ghost vertex closes the outside: a ghost triangle stands on every hull edge, and its circle
// is the open half-plane beyond that edge.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "grid.hpp"
#include "ids.hpp"
#include "predicates.hpp"
#include "spatial_order.hpp"

namespace tinsmith {

// Order for insertion: random rounds, each twice as large as the one before, in spatial order.
inline std::vector<std::int32_t> insertion_order(const PointGrid& grid) {
  constexpr std::int32_t kFirstRound = 256;
  std::vector<std::int32_t> order(grid.count());
  std::iota(order.begin(), order.end(), 0);
  std::uint64_t state = 0x9E3779B97F4A7C15u;  // a fixed seed: every run inserts in the same order
  for (std::size_t i = order.size(); i > 1; --i) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    std::swap(order[i - 1], order[state % i]);
  }
  std::vector<Point> places;
  for (auto end = static_cast<std::int32_t>(order.size()); end > 0;) {
    const std::int32_t begin = end > kFirstRound ? end / 2 : 0;
    places.clear();
    for (std::int32_t i = begin; i < end; ++i) {
      places.push_back(grid.point(static_cast<Vertex>(order[i])));
    }
    std::vector<std::int32_t> round = SpatialOrder(places.data(), end - begin).take();
    for (std::int32_t& place : round) place = order[begin + place];
    std::copy(round.begin(), round.end(), order.begin() + begin);
    end = begin;
  }
  return order;
}

// A triangulated sphere: real triangles and ghost triangles, 2n - 2 together.
struct GhostMesh {
  static constexpr std::int32_t kGhost = -1;
  std::vector<std::int32_t> corners;  // 3 a triangle, sweep numbers or kGhost
  std::vector<std::int32_t> twins;    // the same edge as half-edge of the triangle across it

  bool is_ghost(std::int32_t triangle) const {
    return corners[3 * triangle] == kGhost || corners[3 * triangle + 1] == kGhost ||
           corners[3 * triangle + 2] == kGhost;
  }
};

class Insertion {
 public:
  // The points must not all be collinear.
  explicit Insertion(const PointGrid& grid) : sweep_of_(insertion_order(grid)) {
    const std::size_t n = sweep_of_.size();
    points_.reserve(n);
    for (std::int32_t v : sweep_of_) points_.push_back(grid.point(static_cast<Vertex>(v)));
    fan_.assign(n + 1, 0);
    mesh_.corners.reserve(3 * (2 * n - 2));
    mesh_.twins.reserve(3 * (2 * n - 2));
  }

  // Returns false if `keep_going` did.
  template <typename KeepGoing>
  bool run(KeepGoing&& keep_going) {
    constexpr std::size_t kPointsPerQuestion = 4096;
    start();
    for (std::size_t i = 3; i < points_.size(); ++i) {
      if (i % kPointsPerQuestion == 0 && !keep_going()) return false;
      insert(static_cast<std::int32_t>(i));
    }
    for (auto& corner : mesh_.corners) {
      if (corner != GhostMesh::kGhost) corner = sweep_of_[corner];
    }
    return true;
  }

  const GhostMesh& mesh() const { return mesh_; }

 private:
  static constexpr std::int32_t kGhost = GhostMesh::kGhost;

  static std::int32_t next(std::int32_t half_edge) {
    return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
  }
  static std::int32_t previous(std::int32_t half_edge) {
    return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1;
  }
  std::int32_t start_of(std::int32_t half_edge) const { return mesh_.corners[next(half_edge)]; }
  std::int32_t end_of(std::int32_t half_edge) const { return mesh_.corners[previous(half_edge)]; }

  // The first triangle that is none of a line, and a ghost on each of its edges.
  void start() {
    std::size_t third = 2;
    while (orientation(points_[0], points_[1], points_[third]) == 0) ++third;
    std::swap(points_[2], points_[third]);
    std::swap(sweep_of_[2], sweep_of_[third]);
    const bool is_left = orientation(points_[0], points_[1], points_[2]) > 0;
    const std::int32_t a = 0, b = is_left ? 1 : 2, c = is_left ? 2 : 1;
    mesh_.corners = {a, b, c, kGhost, c, b, kGhost, a, c, kGhost, b, a};
    mesh_.twins = {3, 6, 9, 0, 11, 7, 1, 5, 10, 2, 8, 4};
    stamp_.assign(4, 0);
    last_ = 0;
  }

  void insert(std::int32_t p) {
    collect_cavity(p, find_conflict(points_[p]));
    fill_cavity(p);
  }

  // Walk towards p across edges that separate it, to a triangle that must go.
  std::int32_t find_conflict(Point p) {
    std::int32_t triangle = last_;
    while (true) {
      const std::int32_t across = edge_towards(triangle, p);
      if (across < 0) return triangle;
      triangle = mesh_.twins[across] / 3;
      if (mesh_.is_ghost(triangle)) return triangle;
    }
  }

  std::int32_t edge_towards(std::int32_t triangle, Point p) const {
    for (std::int32_t edge = 3 * triangle; edge < 3 * triangle + 3; ++edge) {
      if (orientation(points_[start_of(edge)], points_[end_of(edge)], p) < 0) return edge;
    }
    return -1;
  }

  bool is_in_conflict(std::int32_t triangle, Point p) const {
    const std::int32_t* corner = &mesh_.corners[3 * triangle];
    for (int k = 0; k < 3; ++k) {
      if (corner[k] == kGhost) {
        return is_beyond(points_[corner[(k + 1) % 3]], points_[corner[(k + 2) % 3]], p);
      }
    }
    return is_in_circle(points_[corner[0]], points_[corner[1]], points_[corner[2]], p);
  }

  // Left of the hull edge (seen from outside), or on it between its ends.
  static bool is_beyond(Point from, Point to, Point p) {
    const int side = orientation(from, to, p);
    if (side != 0) return side > 0;
    const bool is_forward = lexicographically_before(from, to);
    return lexicographically_before(is_forward ? from : to, p) &&
           lexicographically_before(p, is_forward ? to : from);
  }

  // Triangles in conflict are connected; rim_ gets the edges around them, seen from outside.
  void collect_cavity(std::int32_t p, std::int32_t first) {
    cavity_.assign(1, first);
    rim_.clear();
    stamp_[first] = p;
    for (std::size_t i = 0; i < cavity_.size(); ++i) {
      for (std::int32_t edge = 3 * cavity_[i]; edge < 3 * cavity_[i] + 3; ++edge) {
        const std::int32_t twin = mesh_.twins[edge];
        const std::int32_t other = twin / 3;
        if (stamp_[other] == p) continue;
        if (is_in_conflict(other, points_[p])) {
          stamp_[other] = p;
          cavity_.push_back(other);
        } else {
          rim_.push_back({twin, start_of(edge), end_of(edge)});
        }
      }
    }
  }

  // A fan of triangles (p, from, to) in the places of the removed ones and two new places.
  void fill_cavity(std::int32_t p) {
    while (cavity_.size() < rim_.size()) {
      cavity_.push_back(static_cast<std::int32_t>(stamp_.size()));
      stamp_.push_back(0);
      mesh_.corners.resize(mesh_.corners.size() + 3);
      mesh_.twins.resize(mesh_.twins.size() + 3);
    }
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      const std::int32_t triangle = cavity_[i];
      std::int32_t* corner = &mesh_.corners[3 * triangle];
      corner[0] = p;
      corner[1] = rim_[i].from;
      corner[2] = rim_[i].to;
      join(3 * triangle, rim_[i].outer);
      fan_[rim_[i].from + 1] = triangle;
      if (rim_[i].from != kGhost && rim_[i].to != kGhost) last_ = triangle;
    }
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      join(3 * cavity_[i] + 1, 3 * fan_[rim_[i].to + 1] + 2);
    }
  }

  void join(std::int32_t a, std::int32_t b) {
    mesh_.twins[a] = b;
    mesh_.twins[b] = a;
  }

  struct RimEdge {
    std::int32_t outer;  // the edge as half-edge of the triangle that stays
    std::int32_t from, to;
  };

  std::vector<std::int32_t> sweep_of_;  // by order of insertion
  std::vector<Point> points_;           // likewise
  GhostMesh mesh_;
  std::vector<std::int32_t> stamp_;  // the last point in whose cavity a triangle was
  std::vector<std::int32_t> fan_;    // the new triangle that starts at a vertex (ghost first)
  std::vector<std::int32_t> cavity_;
  std::vector<RimEdge> rim_;
  std::int32_t last_ = 0;
};

}  // namespace tinsmith
