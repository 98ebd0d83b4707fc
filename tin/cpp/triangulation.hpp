// The main path: index the points, find the hull, grow, number by the caller's rows.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "grid.hpp"
#include "growth.hpp"
#include "hull.hpp"
#include "ids.hpp"

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

// Delaunay triangulation of one or more rows. No triangles if all points are collinear.
template <typename KeepGoing>
Triangulation triangulate(const PointRows& rows, KeepGoing&& keep_going) {
  Triangulation result;
  const PointGrid grid(rows);
  result.kept_row = grid.kept_row();
  result.distinct_count = grid.count();
  if (grid.count() < 3 || !keep_going()) {
    result.is_complete = grid.count() < 3;
    return result;
  }
  const std::vector<Vertex> hull = HullFinder(grid).find();
  if (hull.empty()) return result;
  const auto on_hull = static_cast<std::int64_t>(hull.size());
  result.triangle_count = Growth::triangle_count(grid.count(), on_hull);
  result.corners.reset(new std::int32_t[3 * result.triangle_count]);
  result.neighbors.reset(new std::int32_t[3 * result.triangle_count]);
  Growth growth(grid, hull, {result.corners.get(), result.neighbors.get()});
  result.is_complete = growth.run(keep_going);
  result.counts = growth.counts();
  if (result.is_complete) number_by_rows(result, grid);
  return result;
}

}  // namespace tinsmith
