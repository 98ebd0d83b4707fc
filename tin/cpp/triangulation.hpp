// The main path: index the points, find the hull, grow, number by the caller's rows.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "canonical.hpp"
#include "grid.hpp"
#include "growth.hpp"
#include "hull.hpp"
#include "ids.hpp"
#include "insertion.hpp"

namespace tinsmith {

struct Triangulation {
  std::unique_ptr<std::int32_t[]> corners;    // 3 a triangle, by vertex
  std::unique_ptr<std::int32_t[]> neighbors;  // 3 a triangle, kNoNeighbor outside
  std::int64_t triangle_count = 0;
  std::vector<std::int32_t> kept_row;  // empty if all rows are kept
  std::int64_t distinct_count = 0;
  SearchCounts counts;
  bool is_complete = true;  // false if asked to stop
};

// The vertex number of each kept row: rows counted without the repeated ones.
inline std::vector<std::int32_t> vertex_at_row(const std::vector<std::int32_t>& kept_row) {
  std::vector<std::int32_t> vertex(kept_row.size());
  std::int32_t next = 0;
  for (std::size_t row = 0; row < kept_row.size(); ++row) {
    const bool is_kept = kept_row[row] == static_cast<std::int32_t>(row);
    vertex[row] = is_kept ? next++ : kNoNeighbor;
  }
  return vertex;
}

inline void number_by_rows(Triangulation& result, const PointGrid& grid) {
  std::int32_t* corners = result.corners.get();
  const std::int64_t size = 3 * result.triangle_count;
  const std::vector<std::int32_t> vertex = vertex_at_row(result.kept_row);
  for (std::int64_t i = 0; i < size; ++i) {
    const std::int32_t row = number(grid.row_of(static_cast<Vertex>(corners[i])));
    corners[i] = vertex.empty() ? row : vertex[row];
  }
}

enum class Method { kAutomatic, kGrowth, kInsertion };

template <typename KeepGoing>
bool insert_all(Triangulation& result, const PointGrid& grid, KeepGoing&& keep_going) {
  Insertion insertion(grid);
  if (!insertion.run(keep_going)) return false;
  CanonicalOrder(grid, insertion.mesh()).write({result.corners.get(), result.neighbors.get()});
  return true;
}

// Growth, or insertion where its searches cost too much; the result is the same.
template <typename KeepGoing>
bool build(Triangulation& result, const PointGrid& grid, const std::vector<Vertex>& hull,
           Method method, KeepGoing&& keep_going) {
  if (method != Method::kInsertion) {
    Growth growth(grid, hull, {result.corners.get(), result.neighbors.get()});
    const bool is_bounded = method == Method::kAutomatic;
    const Growth::Outcome outcome = growth.run(keep_going, is_bounded);
    result.counts = growth.counts();
    if (outcome != Growth::Outcome::kTooCostly) return outcome == Growth::Outcome::kComplete;
  }
  return insert_all(result, grid, keep_going);
}

// Delaunay triangulation of one or more rows. No triangles if all points are collinear.
template <typename KeepGoing>
Triangulation triangulate(const PointRows& rows, Method method, KeepGoing&& keep_going) {
  Triangulation result;
  const PointGrid grid(rows);
  result.kept_row = grid.kept_row();
  result.distinct_count = grid.count();
  if (grid.count() < 3) return result;
  const std::vector<Vertex> hull = HullFinder(grid).find();
  if (hull.empty()) return result;
  const auto on_hull = static_cast<std::int64_t>(hull.size());
  result.triangle_count = Growth::triangle_count(grid.count(), on_hull);
  result.corners.reset(new std::int32_t[3 * result.triangle_count]);
  result.neighbors.reset(new std::int32_t[3 * result.triangle_count]);
  result.is_complete = build(result, grid, hull, method, keep_going);
  if (result.is_complete) number_by_rows(result, grid);
  return result;
}

}  // namespace tinsmith
