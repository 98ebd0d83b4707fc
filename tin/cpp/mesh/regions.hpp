// Regions: the parts of a triangulation between barrier edges.
#pragma once

#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

struct Regions {
  std::vector<std::int32_t> region_of;  // each triangle's region
  std::vector<std::int32_t> largest;    // each region's largest triangle, the first among equals
};

// Triangles as three corners and three neighbours each; `is_barrier` tells of the edge opposite
// each corner; `xy` holds the vertices.
inline Regions find_regions(const Point* xy, const std::int32_t* corners,
                            const std::int32_t* neighbors, const bool* is_barrier,
                            std::int32_t count) {
  constexpr std::int32_t kNoRegion = -1;
  Regions found;
  found.region_of.assign(count, kNoRegion);
  std::vector<std::int32_t> open;
  const auto area = [&](std::int32_t t) {
    const std::int32_t* const c = corners + 3 * std::int64_t{t};
    const Point a = xy[c[0]];
    const double bx = xy[c[1]].x - a.x, by = xy[c[1]].y - a.y;
    const double cx = xy[c[2]].x - a.x, cy = xy[c[2]].y - a.y;
    return bx * cy - by * cx;
  };
  for (std::int32_t first = 0; first < count; ++first) {
    if (found.region_of[first] != kNoRegion) continue;
    const auto region = static_cast<std::int32_t>(found.largest.size());
    std::int32_t largest = first;
    double largest_area = area(first);
    open.assign(1, first);
    found.region_of[first] = region;
    while (!open.empty()) {
      const std::int32_t t = open.back();
      open.pop_back();
      const double size = area(t);
      if (size > largest_area || (size == largest_area && t < largest)) {
        largest = t;
        largest_area = size;
      }
      for (std::int64_t i = 3 * std::int64_t{t}; i < 3 * std::int64_t{t} + 3; ++i) {
        const std::int32_t next = neighbors[i];
        if (next == kNoNeighbor || is_barrier[i] || found.region_of[next] != kNoRegion) continue;
        found.region_of[next] = region;
        open.push_back(next);
      }
    }
    found.largest.push_back(largest);
  }
  return found;
}

}  // namespace tinsmith
