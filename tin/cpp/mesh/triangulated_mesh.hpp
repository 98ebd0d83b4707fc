// A mesh of a triangulation that was made for it (Options::is_for_mesh): what was inserted is taken
// as it is, ghosts included, with no arrays between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "../base/ids.hpp"
#include "../triangulation.hpp"
#include "given_triangles.hpp"
#include "mesh_arrays.hpp"
#include "mesh_editor.hpp"

namespace tinsmith {

namespace detail {

inline Mesh mesh_of_inserted(const Triangulation& made, std::int32_t vertex_count) {
  Mesh mesh;
  const std::size_t vertices = std::size_t{0} + vertex_count + room_for(vertex_count);
  mesh.reserve(vertices, 2 * vertices);
  mesh.add_vertices(vertex_count);
  mesh.add_all(made.inserted_count, [&](Triangle t, GhostTriangle& triangle) {
    triangle = made.inserted[number(t)];
    return std::uint8_t{0};
  });
  return mesh;
}

}  // namespace detail

// Ready to be changed; the triangulation has triangles. Vertices are numbered by kept rows.
inline MeshEditor editor_of_triangulation(const PointRows& rows, const Triangulation& made) {
  const auto vertices = static_cast<std::int32_t>(made.distinct_count);
  MeshPoints points;
  points.reserve(std::size_t{0} + vertices + room_for(vertices));
  for (std::int32_t row = 0; row < rows.count; ++row) {
    if (made.kept_row.empty() || made.kept_row[row] == row) points.add(rows[row]);
  }
  if (made.inserted_count > 0) {
    return MeshEditor(detail::mesh_of_inserted(made, vertices), std::move(points));
  }
  const GivenTriangles given{made.corners.get(), made.neighbors.get(), nullptr,
                             static_cast<std::int32_t>(made.triangle_count)};
  return MeshEditor(mesh_of(given, vertices, room_for(vertices)), std::move(points));
}

}  // namespace tinsmith
