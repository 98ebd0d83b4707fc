// Edges that interpolation does not look across, and the triangulation that is Delaunay but for
// them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../location/locator.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// The triangle across an edge is looked at: there is one, and the edge is no barrier. Without
// barriers all edges are open.
inline bool is_open(const Surface& surface, const bool* barriers, Triangle t, std::uint32_t k) {
  return (barriers == nullptr || !barriers[entry_of(t, k)]) &&
         surface.is_triangle(surface.neighbor(t, k));
}

// The triangles of a surface after Lawson's flips of every open edge that is not locally Delaunay:
// the constrained Delaunay triangulation of the vertices, with barriers and the boundary as
// constraints.
//
// C. L. Lawson, "Software for C1 surface interpolation" (1977).
class FlippedTriangles {
 public:
  // No triangles if nothing has to be flipped. False if asked to stop.
  template <typename KeepGoing>
  bool build(const Surface& given, const bool* given_barriers, KeepGoing&& keep_going) {
    given_ = given;
    for (const Triangle t : Ids<Triangle>(given.triangle_count)) {
      if (number(t) % kBetweenQuestions == 0 && !keep_going()) return false;
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (is_open(given, given_barriers, t, k) && t < given.neighbor(t, k) &&
            is_illegal(given, t, k)) {
          pending_.push_back(half_edge(t, k));
        }
      }
    }
    if (pending_.empty()) return true;
    const std::size_t entries = std::size_t{3} * given.triangle_count;
    corners_.assign(given.corners, given.corners + entries);
    neighbors_.assign(given.neighbors, given.neighbors + entries);
    barriers_.assign(given_barriers, given_barriers + entries);
    return flip_pending(keep_going);
  }

  bool is_flipped() const { return !corners_.empty(); }
  Surface surface() const {
    Surface flipped = given_;
    flipped.corners = corners_.data();
    flipped.neighbors = neighbors_.data();
    return flipped;
  }
  const bool* barriers() const { return reinterpret_cast<const bool*>(barriers_.data()); }

 private:
  static constexpr std::uint32_t kBetweenQuestions = 1u << 16;

  // A neighbour that does not name this triangle as its own neighbour is left alone.
  static bool is_illegal(const Surface& surface, Triangle t, std::uint32_t k) {
    const Triangle other = surface.neighbor(t, k);
    const std::uint32_t j = surface.corner_facing(other, t);
    if (surface.neighbor(other, j) != t) return false;
    return in_circle(surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2),
                     surface.corner(other, j)) > 0;
  }

  template <typename KeepGoing>
  bool flip_pending(KeepGoing&& keep_going) {
    std::uint32_t flips = 0;
    while (!pending_.empty()) {
      if (++flips % kBetweenQuestions == 0 && !keep_going()) return false;
      const HalfEdge edge = pending_.back();
      pending_.pop_back();
      const Triangle t = triangle_of(edge);
      const std::uint32_t k = corner_of(edge);
      const Surface now = surface();
      if (is_open(now, barriers(), t, k) && is_illegal(now, t, k)) flip(t, k);
    }
    return true;
  }

  // Triangles (a, b, c) and (d, c, b) become (a, b, d) and (a, d, c).
  //
  //          c                 c
  //        / | \             /   \.
  //      a   |   d    ->   a ----- d
  //        \ | /             \   /
  //          b                 b
  void flip(Triangle left, std::uint32_t a) {
    const Triangle right = surface().neighbor(left, a);
    const std::uint32_t d = surface().corner_facing(right, left);
    const std::uint32_t b = corner_after(a), c = corner_before(a);
    const Side ab = side(left, c), ca = side(left, b);
    const Side dc = side(right, corner_before(d)), bd = side(right, corner_after(d));
    const Vertex at_a = surface().vertex(left, a), at_b = surface().vertex(left, b);
    const Vertex at_c = surface().vertex(left, c), at_d = surface().vertex(right, d);
    set_triangle(left, {at_a, at_b, at_d}, bd, {right, false}, ab);
    set_triangle(right, {at_a, at_d, at_c}, dc, ca, {left, false});
    rename(bd.beyond, right, left);
    rename(ca.beyond, left, right);
    for (const std::uint32_t k : {0u, 2u}) pending_.push_back(half_edge(left, k));
    for (const std::uint32_t k : {0u, 1u}) pending_.push_back(half_edge(right, k));
  }

  struct Side {
    Triangle beyond;
    bool is_barrier;
  };
  struct Corners {
    Vertex first, second, third;
  };

  Side side(Triangle t, std::uint32_t k) const {
    return {surface().neighbor(t, k), barriers_[entry_of(t, k)] != 0};
  }

  // The sides lie opposite the first, second and third corner.
  void set_triangle(Triangle t, Corners corners, Side first, Side second, Side third) {
    const Vertex vertices[3] = {corners.first, corners.second, corners.third};
    const Side sides[3] = {first, second, third};
    for (std::uint32_t k = 0; k < 3; ++k) {
      corners_[entry_of(t, k)] = number(vertices[k]);
      neighbors_[entry_of(t, k)] = index_of(sides[k].beyond);
      barriers_[entry_of(t, k)] = sides[k].is_barrier;
    }
  }

  void rename(Triangle t, Triangle from, Triangle to) {
    if (!given_.is_triangle(t)) return;
    const std::uint32_t k = surface().corner_facing(t, from);
    if (surface().neighbor(t, k) == from) neighbors_[entry_of(t, k)] = index_of(to);
  }

  Surface given_{};
  std::vector<std::int32_t> corners_, neighbors_;
  std::vector<unsigned char> barriers_;  // of bool's size: vector<bool> has no array
  std::vector<HalfEdge> pending_;
};

}  // namespace tinsmith
