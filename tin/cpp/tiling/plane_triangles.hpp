// Triangles as arrays over places in the plane.
#pragma once

#include <cstddef>
#include <cstdint>

#include "../base/ids.hpp"
#include "../base/point.hpp"

namespace tinsmith {

struct PlaneTriangles {
  const Point* places;
  const std::int32_t* corners;    // three a triangle
  const std::int32_t* neighbors;  // likewise, kNoNeighbor outside; null where nobody asks
  std::int32_t place_count;
  std::uint32_t count;

  Vertex vertex(Triangle t, std::uint32_t k) const { return Vertex{corners[entry_of(t, k)]}; }
  Point corner(Triangle t, std::uint32_t k) const {
    return places[static_cast<std::size_t>(number(vertex(t, k)))];
  }
  Triangle neighbor(Triangle t, std::uint32_t k) const {
    return triangle_numbered(neighbors[entry_of(t, k)]);
  }
  bool is_triangle(Triangle t) const { return number(t) < count; }
};

}  // namespace tinsmith
