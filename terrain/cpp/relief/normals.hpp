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

namespace tinsmith {

// Three numbers for each triangle. Returns, in ascending order, the slivers among them: triangles
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
      const double* row[3];
      for (std::uint32_t k = 0; k < 3; ++k) row[k] = surface.row(surface.vertex(t, k));
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

// The sums of the normals of the triangles at each vertex, three numbers each, by one thread and
// in the order of triangles: so they are the same wherever they are computed.
inline void sum_at_vertices(const Surface& surface, const double* normals, double* sums) {
  std::fill_n(sums, 3 * static_cast<std::size_t>(surface.point_count), 0.0);
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      double* const sum = sums + 3 * static_cast<std::size_t>(number(surface.vertex(t, k)));
      for (std::uint32_t axis = 0; axis < 3; ++axis) sum[axis] += normals[entry_of(t, axis)];
    }
  }
}

}  // namespace tinsmith
