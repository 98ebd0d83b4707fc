// The triangles of a surface by their corners in the plane: a hash table with linear probing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "../../../tin/cpp/location/ordered_surface.hpp"
#include "facet.hpp"

namespace tinsmith::earthwork {

class EqualTriangles {
 public:
  explicit EqualTriangles(const OrderedSurface& copy)
      : copy_(copy), slots_(slot_count(copy.surface().triangle_count), kNoTriangle) {
    for (const Triangle t : Ids<Triangle>(copy.surface().triangle_count)) {
      std::size_t slot = first_slot(Facet::of(copy.surface(), t));
      while (slots_[slot] != kNoTriangle) slot = following(slot);
      slots_[slot] = t;
    }
  }

  // The triangle of the copy with the same corners, kNoTriangle if there is none.
  Triangle find(const Facet& wanted) const {
    for (std::size_t slot = first_slot(wanted); slots_[slot] != kNoTriangle;
         slot = following(slot)) {
      const Facet found = Facet::of(copy_.surface(), slots_[slot]);
      if (std::equal(found.corner, found.corner + 3, wanted.corner)) return slots_[slot];
    }
    return kNoTriangle;
  }

 private:
  // A power of two, twice the triangles or more.
  static std::size_t slot_count(std::size_t triangles) {
    std::size_t count = 2;
    while (count < 2 * triangles + 1) count *= 2;
    return count;
  }

  std::size_t following(std::size_t slot) const { return (slot + 1) & (slots_.size() - 1); }

  // The multiplier is that of SplitMix64 (Steele, Lea and Flood, 2014).
  std::size_t first_slot(const Facet& facet) const {
    std::uint64_t hash = 0;
    for (const Point p : facet.corner) {
      for (const double c : {p.x, p.y}) {
        std::uint64_t bits;
        std::memcpy(&bits, &c, sizeof bits);
        hash = (hash ^ bits) * 0xbf58476d1ce4e5b9;
        hash ^= hash >> 31;
      }
    }
    return static_cast<std::size_t>(hash) & (slots_.size() - 1);
  }

  const OrderedSurface& copy_;
  std::vector<Triangle> slots_;
};

}  // namespace tinsmith::earthwork
