// Refinement of a surface as arrays: what a refiner did, numbered without gaps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/ids.hpp"
#include "../mesh/checked_mesh.hpp"
#include "../mesh/mesh_arrays.hpp"
#include "refiner.hpp"

namespace tinsmith {

// Triangles of the surface in canonical order: that of the triangulation of the whole hull. Edges of
// the boundary are fixed.
struct RefinedSurface {
  StreamedArray<std::int32_t> corners, neighbors;
  StreamedArray<bool> fixed;
  std::uint32_t triangle_count = 0;
};

// New vertices are numbered after the given ones.
struct Refined {
  std::vector<Point> points;         // of the new vertices
  std::vector<Vertex> splits;        // of segments: from, to, middle
  std::vector<std::int32_t> misses;  // triangles that miss the goal: three corners, why
  std::int64_t triangle_count = 0;
  Refiner::Ended ended = Refiner::Ended::kDone;
  // None if the hull cannot be filled around the surface, as where the rounded boundary meets
  // itself.
  std::optional<RefinedSurface> surface;
};

namespace detail {

// The vertices of a surface in the order in which its triangles come: near ones are near in memory.
// What is made of the surface does not depend on how vertices are numbered.
class TriangleOrder {
 public:
  TriangleOrder(const PointRows& rows, const GivenTriangles& given)
      : given_(given), inner_(static_cast<std::size_t>(rows.count), kNoVertex) {
    outer_.reserve(inner_.size());
    const std::size_t size = 3 * static_cast<std::size_t>(given.count);
    corners_.reserve(size);
    for (std::size_t i = 0; i < size; ++i) corners_.push_back(number(inner_of(given.corners[i])));
    n_used_ = outer_.size();
    for (std::int32_t v = 0; v < rows.count; ++v) inner_of(v);  // those in no triangle
    for (const Vertex v : outer_) points_.push_back(rows[number(v)]);
  }

  bool has_idle_vertices() const { return n_used_ < outer_.size(); }
  Vertex outer(Vertex inner) const { return outer_[static_cast<std::size_t>(number(inner))]; }
  Vertex inner(Vertex outer) const {
    if (number(outer) < 0 || static_cast<std::size_t>(number(outer)) >= inner_.size()) {
      throw std::invalid_argument("there is no such vertex");
    }
    return inner_[static_cast<std::size_t>(number(outer))];
  }

  MeshEditor editor() const {
    const PointRows rows{&points_.data()->x, static_cast<std::int64_t>(points_.size()), 2};
    return editor_of(rows, {corners_.data(), given_.neighbors, given_.fixed, given_.count});
  }

 private:
  Vertex inner_of(std::int32_t outer) {
    Vertex& inner = inner_[static_cast<std::size_t>(outer)];
    if (inner == kNoVertex) {
      inner = Vertex{static_cast<std::int32_t>(outer_.size())};
      outer_.push_back(Vertex{outer});
    }
    return inner;
  }

  const GivenTriangles& given_;
  std::vector<Vertex> inner_, outer_;
  std::vector<std::int32_t> corners_;
  std::vector<Point> points_;
  std::size_t n_used_ = 0;
};

// Whether every triangle is counter-clockwise.
inline bool are_turned_right(const MeshEditor& editor) {
  const Mesh& mesh = editor.mesh();
  for (const Triangle t : mesh.triangles()) {
    if (mesh.is_free(t) || mesh.is_ghost(t)) continue;
    const auto& c = mesh[t].corner;
    if (orientation(editor.point(c[0]), editor.point(c[1]), editor.point(c[2])) <= 0) return false;
  }
  return true;
}

// Leave out the marked triangles; the new boundary is fixed.
inline RefinedSurface without_marked(MeshArrays made) {
  const std::uint32_t count = made.triangle_count;
  std::vector<std::int32_t> number_of(count);
  std::int32_t kept = 0;
  for (std::uint32_t t = 0; t < count; ++t) number_of[t] = made.marked[t] ? kNoNeighbor : kept++;
  for (std::size_t from = 0, to = 0; from < 3 * std::size_t{count}; ++from) {
    if (made.marked[from / 3]) continue;
    const std::int32_t across = made.neighbors[from];
    const std::int32_t neighbor = across == kNoNeighbor ? kNoNeighbor : number_of[across];
    made.corners[to] = made.corners[from];
    made.neighbors[to] = neighbor;
    made.fixed[to] = made.fixed[from] || neighbor == kNoNeighbor;
    ++to;
  }
  return {std::move(made.corners), std::move(made.neighbors), std::move(made.fixed),
          static_cast<std::uint32_t>(kept)};
}

}  // namespace detail

// Segments between the pairs `kept_whole` are not split.
inline Refined refine(const PointRows& rows, const GivenTriangles& given,
                      const RefinementGoal& goal, const VertexPairs& kept_whole,
                      std::int32_t most_vertices, Team& team) {
  const detail::TriangleOrder order(rows, given);
  MeshEditor editor = order.editor();
  const bool can_close = !order.has_idle_vertices() && detail::are_turned_right(editor);
  const std::int32_t n_given = editor.slots();
  Refiner refiner(editor, goal);
  for (std::size_t i = 0; i < kept_whole.count; ++i) {
    refiner.keep_whole(order.inner(kept_whole.from(i)), order.inner(kept_whole.to(i)));
  }
  Refined refined;
  refined.ended = refiner.run(most_vertices, team);
  const Mesh& mesh = editor.mesh();
  std::vector<Vertex> number_of(editor.slots());
  for (const Vertex v : editor.vertices()) {
    const bool is_given = number(v) < n_given;
    number_of[number(v)] = is_given
                               ? order.outer(v)
                               : Vertex{n_given + static_cast<std::int32_t>(refined.points.size())};
    if (!is_given && mesh.is_alive(v)) refined.points.push_back(editor.point(v));
  }
  for (const Refiner::Split& split : refiner.splits()) {
    for (const Vertex v : {split.from, split.to, split.middle}) {
      refined.splits.push_back(number_of[number(v)]);
    }
  }
  for (const Triangle t : mesh.triangles()) {
    refined.triangle_count += !mesh.is_free(t) && !mesh.is_ghost(t);
  }
  refiner.visit_left([&](Triangle t, Refiner::Why why) {
    for (const Vertex v : mesh[t].corner) refined.misses.push_back(number(number_of[number(v)]));
    refined.misses.push_back(static_cast<std::int32_t>(why));
  });
  if (refined.ended != Refiner::Ended::kDone || !can_close || !editor.close_hull()) return refined;
  RefinedSurface surface = detail::without_marked(MeshArrays(editor, team, true));
  // Arrays number given vertices as they are here, and new ones as in `points`.
  for (std::size_t i = 0; i < 3 * std::size_t{surface.triangle_count}; ++i) {
    const std::int32_t v = surface.corners[i];
    if (v < n_given) surface.corners[i] = number(order.outer(Vertex{v}));
  }
  refined.surface = std::move(surface);
  return refined;
}

}  // namespace tinsmith
