// Regions: the parts of a triangulation between barrier edges.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "../base/ids.hpp"
#include "../location/surface.hpp"

namespace tinsmith {

struct Regions {
  std::vector<std::int32_t> region_of;  // each triangle's region
  std::vector<Triangle> largest;        // each region's largest triangle, the first among equals
};

class RegionSearch {
 public:
  // `is_barrier` tells of the edge opposite each corner.
  RegionSearch(const Surface& surface, const bool* is_barrier)
      : surface_(surface), is_barrier_(is_barrier) {}

  Regions find() {
    found_.region_of.assign(surface_.triangle_count, kNoRegion);
    for (const Triangle t : Ids<Triangle>(surface_.triangle_count)) {
      if (found_.region_of[number(t)] == kNoRegion) found_.largest.push_back(spread_from(t));
    }
    return std::move(found_);
  }

 private:
  static constexpr std::int32_t kNoRegion = -1;

  // Number the region that a triangle belongs to; returns its largest triangle.
  Triangle spread_from(Triangle first) {
    Triangle largest = first;
    double largest_area = area(first);
    reach(first);
    while (!open_.empty()) {
      const Triangle t = open_.back();
      open_.pop_back();
      const double size = area(t);
      if (size > largest_area || (size == largest_area && t < largest)) {
        largest = t;
        largest_area = size;
      }
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Triangle next = surface_.neighbor(t, k);
        if (next == kNoTriangle || is_barrier_[entry_of(t, k)]) continue;
        if (found_.region_of[number(next)] == kNoRegion) reach(next);
      }
    }
    return largest;
  }

  void reach(Triangle t) {
    found_.region_of[number(t)] = static_cast<std::int32_t>(found_.largest.size());
    open_.push_back(t);
  }

  // Doubled, in doubles.
  double area(Triangle t) const {
    const Point a = surface_.corner(t, 0), b = surface_.corner(t, 1), c = surface_.corner(t, 2);
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  Surface surface_;
  const bool* is_barrier_;
  Regions found_;
  std::vector<Triangle> open_;
};

}  // namespace tinsmith
