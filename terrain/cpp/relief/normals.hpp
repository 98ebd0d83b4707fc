// Upward normals of triangles, as long as twice their areas, and their sums at vertices.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/range.hpp"
#include "../../../tin/cpp/location/surface.hpp"
#include "vertex_neighbors.hpp"

namespace tinsmith {

// The corner that comes first by its coordinates.
inline std::uint32_t first_corner(const Surface& surface, Triangle t) {
  std::uint32_t first = 0;
  for (std::uint32_t k = 1; k < 3; ++k) {
    if (lexicographically_before(surface.corner(t, k), surface.corner(t, first))) first = k;
  }
  return first;
}

// Three numbers for each triangle, whichever of its corners is named first. Returns, in ascending order, the slivers among them: triangles
// so thin that the products of their sides cancel, and doubles do not tell their normals. Check
// `team.is_stopped()` afterwards.
inline std::vector<std::int32_t> compute_normals(const Surface& surface, double* normals,
                                                 Team& team) {
  constexpr double kSliver = 0x1p-20;  // of the area in the squared size
  constexpr std::uint32_t kBetweenQuestions = 1u << 16;
  std::vector<std::vector<std::int32_t>> slivers(static_cast<std::size_t>(team.size()));
  team.run([&](int part) {
    const Range range = part_of(surface.triangle_count, part, team.size());
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      if (i % kBetweenQuestions == 0 && !team.keeps_going(part)) return;
      const Triangle t = triangle_numbered(i);
      const std::uint32_t first = first_corner(surface, t);
      const double* const row[3] = {surface.row(surface.vertex(t, first)),
                                    surface.row(surface.vertex(t, corner_after(first))),
                                    surface.row(surface.vertex(t, corner_before(first)))};
      double u[3], v[3];
      for (int axis = 0; axis < 3; ++axis) {
        u[axis] = row[1][axis] - row[0][axis];
        v[axis] = row[2][axis] - row[0][axis];
      }
      double* const normal = normals + entry_of(t, 0);
      normal[0] = u[1] * v[2] - u[2] * v[1];
      normal[1] = u[2] * v[0] - u[0] * v[2];
      normal[2] = u[0] * v[1] - u[1] * v[0];
      const double size =
          std::max(std::fabs(u[0]), std::fabs(u[1])) * std::max(std::fabs(v[0]), std::fabs(v[1]));
      if (!(normal[2] > kSliver * size)) slivers[part].push_back(i);
    }
  });
  std::vector<std::int32_t> all;
  for (const auto& some : slivers) all.insert(all.end(), some.begin(), some.end());
  return all;
}

// Adds numbers up, the larger ones first: the sum depends on what they are, not on their order, and
// numbers and their opposites cancel out.
inline double sum_by_size(std::vector<double>& values) {
  std::sort(values.begin(), values.end(), [](double a, double b) {
    const double size = std::fabs(a), other = std::fabs(b);
    return size > other || (size == other && a > b);
  });
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum;
}

// The sums of the normals of the triangles at each vertex, three numbers each, whatever the order of
// triangles. Check `team.is_stopped()` afterwards.
inline void sum_at_vertices(const Surface& surface, const double* normals, double* sums,
                            Team& team) {
  constexpr std::int32_t kBetweenQuestions = 1 << 16;
  const VertexTriangles around(surface);
  team.run([&](int part) {
    std::vector<double> values;
    const Range range = part_of(surface.point_count, part, team.size());
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      if (i % kBetweenQuestions == 0 && !team.keeps_going(part)) return;
      const Vertex v{i};
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        values.clear();
        for (const Triangle* t = around.begin(v); t != around.end(v); ++t) {
          values.push_back(normals[entry_of(*t, axis)]);
        }
        sums[3 * static_cast<std::size_t>(i) + axis] = sum_by_size(values);
      }
    }
  });
}

}  // namespace tinsmith
