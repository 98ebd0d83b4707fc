// What can be seen of a surface in one pass over its triangles: long edges, peaks and pits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../location/surface.hpp"

namespace tinsmith {

// Tells of the edge opposite each corner whether its squared length in the plane is larger.
inline void find_long_edges(const Surface& surface, double square, bool* is_long) {
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    const Point corners[3] = {surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2)};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Point a = corners[corner_after(k)], b = corners[corner_before(k)];
      const double dx = b.x - a.x, dy = b.y - a.y;
      is_long[entry_of(t, k)] = dx * dx + dy * dy > square;
    }
  }
}

// The vertices further above, or below, all their neighbours than these are apart, ascending.
inline std::vector<std::int32_t> find_peaks_and_pits(const Surface& surface) {
  struct Range {
    double low, high;
  };
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const auto count = static_cast<std::size_t>(surface.point_count);
  auto ranges = scratch_array<Range>(count);
  std::fill(ranges.get(), ranges.get() + count, Range{kFar, -kFar});
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      Range& own = ranges[static_cast<std::size_t>(number(surface.vertex(t, k)))];
      for (const std::uint32_t other : {corner_after(k), corner_before(k)}) {
        const double z = surface.elevation(t, other);
        own = {std::min(own.low, z), std::max(own.high, z)};
      }
    }
  }
  std::vector<std::int32_t> found;
  for (const Vertex v : Ids<Vertex>(surface.point_count)) {
    const Range& own = ranges[static_cast<std::size_t>(number(v))];
    const double z = surface.elevation(v);
    if (std::max(z - own.high, own.low - z) > own.high - own.low) found.push_back(number(v));
  }
  return found;
}

}  // namespace tinsmith
