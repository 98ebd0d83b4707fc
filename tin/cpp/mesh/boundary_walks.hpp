// The boundary edges of triangles, ring by ring, with the inside on the left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../base/ids.hpp"
#include "../location/surface.hpp"

namespace tinsmith {

struct BoundaryWalks {
  std::vector<std::int64_t> edges;  // as entries: 3 * triangle + corner opposite
  std::vector<std::int64_t> offsets{0};
};

// Rings are listed by their first edge. At a vertex where rings touch they are kept apart by turning
// about it through the triangles inside, each of which is passed once about each of its corners.
class BoundaryWalker {
 public:
  // Of the surface its corners and neighbours are looked at, which must be sound.
  explicit BoundaryWalker(const Surface& surface)
      : surface_(surface), is_walked_(std::size_t{3} * surface.triangle_count, false) {}

  // Throws invalid_argument if triangles are not neighbours of their neighbours.
  BoundaryWalks walk() {
    for (const Triangle t : Ids<Triangle>(surface_.triangle_count)) {
      for (const HalfEdge e : half_edges(t)) {
        if (surface_.neighbor(t, corner_of(e)) == kNoTriangle) walk_from(e);
      }
    }
    return std::move(found_);
  }

 private:
  void walk_from(HalfEdge first) {
    if (is_walked_[entry_of(first)]) return;
    for (HalfEdge here = first; !is_walked_[entry_of(here)]; here = find_next(here)) {
      is_walked_[entry_of(here)] = true;
      found_.edges.push_back(static_cast<std::int64_t>(entry_of(here)));
    }
    found_.offsets.push_back(static_cast<std::int64_t>(found_.edges.size()));
  }

  // The boundary edge that begins where one ends.
  HalfEdge find_next(HalfEdge e) const {
    Triangle t = triangle_of(e);
    const Vertex pivot = surface_.vertex(t, corner_before(corner_of(e)));
    std::uint32_t corner = corner_after(corner_of(e));
    for (std::uint32_t turns = 0; turns < surface_.triangle_count; ++turns) {
      const Triangle across = surface_.neighbor(t, corner);
      if (across == kNoTriangle) return half_edge(t, corner);
      t = across;
      corner = corner_before(surface_.corner_at(t, pivot));
    }
    throw std::invalid_argument("triangles must be neighbors of their neighbors");
  }

  Surface surface_;
  std::vector<bool> is_walked_;
  BoundaryWalks found_;
};

}  // namespace tinsmith
