// A copy of a surface in which neighbours in the plane are neighbours in memory.
//
// Points that came in any order lie anywhere in memory, and so do their triangles: a walk over them
// waits for memory at each step. Here vertices are numbered along Hilbert's curve, and triangles by
// the first of their vertices. A triangle keeps the order of its corners, so that what is computed
// from it is the same to the last bit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../index/hilbert_order.hpp"
#include "surface.hpp"

namespace tinsmith {

class OrderedSurface {
 public:
  // Corners must be sound; a neighbour that is no triangle becomes none. Without neighbours (null)
  // there are none here either.
  explicit OrderedSurface(const Surface& given)
      : points_(scratch_array<double>(3 * std::size_t(given.point_count))),
        corners_(scratch_array<std::int32_t>(3 * std::size_t{given.triangle_count})),
        neighbors_(scratch_array<std::int32_t>(
            given.neighbors == nullptr ? 0 : 3 * std::size_t{given.triangle_count})),
        given_vertices_(scratch_array<Vertex>(given.point_count)),
        given_(scratch_array<Triangle>(given.triangle_count)),
        point_count_(given.point_count),
        triangle_count_(given.triangle_count) {
    const ScratchArray<Vertex> vertices = order_points(given);
    const ScratchArray<Triangle> ordered = order_triangles(given, vertices.get());
    for (const Triangle t : Ids<Triangle>(triangle_count_)) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Vertex v = vertices[number(given.vertex(given_number(t), k))];
        corners_[entry_of(t, k)] = number(v);
      }
      if (given.neighbors != nullptr) join(t, given, ordered.get());
    }
  }

  Surface surface() const {
    return {points_.get(), corners_.get(), neighbors_.get(), point_count_, triangle_count_};
  }
  // What the caller calls a triangle, and a vertex.
  Triangle given_number(Triangle t) const { return given_[number(t)]; }
  Vertex given_number(Vertex v) const { return given_vertices_[number(v)]; }
  // The number here of each of the caller's triangles.
  ScratchArray<Triangle> numbers() const {
    auto numbers = scratch_array<Triangle>(triangle_count_);
    for (const Triangle t : Ids<Triangle>(triangle_count_)) numbers[number(given_number(t))] = t;
    return numbers;
  }
  // The caller's flags of corners, three a triangle, as they stand here.
  ScratchArray<bool> order_flags(const bool* given) const {
    auto flags = scratch_array<bool>(3 * std::size_t{triangle_count_});
    for (const Triangle t : Ids<Triangle>(triangle_count_)) {
      std::copy_n(given + entry_of(given_number(t), 0), 3, flags.get() + entry_of(t, 0));
    }
    return flags;
  }

 private:
  // Returns the new number of each point.
  ScratchArray<Vertex> order_points(const Surface& given) {
    const HilbertOrder order(point_count_, [&](std::int32_t i) { return given.point(Vertex{i}); });
    auto vertices = scratch_array<Vertex>(point_count_);
    for (const Vertex v : Ids<Vertex>(point_count_)) {
      const Vertex its = Vertex{order[number(v)]};
      std::copy_n(given.row(its), 3, points_.get() + 3 * static_cast<std::size_t>(number(v)));
      given_vertices_[number(v)] = its;
      vertices[number(its)] = v;
    }
    return vertices;
  }

  // By their first vertices (counting sort). Returns the new number of each triangle.
  ScratchArray<Triangle> order_triangles(const Surface& given, const Vertex* vertices) {
    auto first = scratch_array<Vertex>(triangle_count_);
    auto end = scratch_array<std::uint32_t>(std::size_t(point_count_));
    std::fill(end.get(), end.get() + point_count_, 0u);
    for (const Triangle t : Ids<Triangle>(triangle_count_)) {
      const auto corner = [&](std::uint32_t k) { return vertices[number(given.vertex(t, k))]; };
      first[number(t)] = std::min({corner(0), corner(1), corner(2)});
      ++end[number(first[number(t)])];
    }
    std::uint32_t total = 0;
    for (std::int32_t i = 0; i < point_count_; ++i) total += std::exchange(end[i], total);
    auto ordered = scratch_array<Triangle>(triangle_count_);
    for (const Triangle t : Ids<Triangle>(triangle_count_)) {
      const Triangle place{end[number(first[number(t)])]++};
      ordered[number(t)] = place;
      given_[number(place)] = t;
    }
    return ordered;
  }

  void join(Triangle t, const Surface& given, const Triangle* ordered) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Triangle beyond = given.neighbor(given_number(t), k);
      neighbors_[entry_of(t, k)] =
          given.is_triangle(beyond) ? index_of(ordered[number(beyond)]) : kNoNeighbor;
    }
  }

  ScratchArray<double> points_;
  ScratchArray<std::int32_t> corners_, neighbors_;
  ScratchArray<Vertex> given_vertices_;  // the caller's number of each vertex
  ScratchArray<Triangle> given_;         // and of each triangle
  std::int32_t point_count_;
  std::uint32_t triangle_count_;
};

}  // namespace tinsmith
