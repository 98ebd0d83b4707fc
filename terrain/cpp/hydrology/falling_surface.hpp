// A surface and how its triangles fall, as terrain/hydrology/falls.py finds it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/location/surface.hpp"

namespace tinsmith::hydrology {

// On an edge, at a share of it from its start; the edge as the triangle on its left has it.
struct Place {
  HalfEdge edge;
  double share;
};

// Shares of an edge from either end are exact as multiples of 2^-53.
inline double round_share(double share) { return 1.0 - (1.0 - share); }

// From 0 to 1; what is no number stays so.
inline double clip_share(double share) { return std::min(std::max(share, 0.0), 1.0); }

// The edge of a triangle that all its fall lines meet, so that shares of it name them: the only one
// that water leaves across, or else the only one that it enters across.
//
//             apex
//            /  | \          share 0 at the start of the base, 1 at its end; the fall line
//           /   |  \         through the apex meets it at `split`
//     start ----|--- end
struct Base {
  double split;
  std::uint8_t corner;  // opposite the base
  bool drains;          // water leaves across the base

  bool is_at(HalfEdge e) const { return corner_of(e) == corner; }

  // Where the fall line through a place on an edge of the triangle meets the base, or from the base
  // the side.
  Place follow(Place from) const { return is_at(from.edge) ? to_side(from) : to_base(from); }

  // Which part of the triangle's area lies before a share of the base.
  double part_before(double share) const {
    if (share >= 1.0) return 1.0;
    if (share <= 0.0) return 0.0;
    const double rest = 1.0 - share;
    return share < split ? share * share / split : 1.0 - rest * rest / (1.0 - split);
  }

 private:
  Place to_side(Place from) const {
    const bool is_before = from.share < split;
    const std::uint32_t side = is_before ? corner_before(corner) : corner_after(corner);
    const double share = is_before ? 1.0 - from.share / split : (1.0 - from.share) / (1.0 - split);
    return {half_edge(triangle_of(from.edge), side), std::isnan(share) ? 0.0 : clip_share(share)};
  }

  Place to_base(Place from) const {
    const bool is_first = corner_of(from.edge) == corner_before(corner);
    const double share = is_first ? split * (1.0 - from.share) : 1.0 - from.share * (1.0 - split);
    return {half_edge(triangle_of(from.edge), corner), clip_share(share)};
  }
};

struct FallingSurface {
  Surface surface;
  const std::int8_t* signs;  // three a triangle: 1 where water leaves it across the edge, -1 enters
  const double* values;      // likewise, how much leaves, in proportion

  int sign(HalfEdge e) const { return signs[entry_of(e)]; }
  bool is_level(Triangle t) const {
    const std::int8_t* const own = signs + entry_of(t, 0);
    return own[0] == 0 && own[1] == 0 && own[2] == 0;
  }
  int count_drains(Triangle t) const {
    const std::int8_t* const own = signs + entry_of(t, 0);
    return (own[0] > 0) + (own[1] > 0) + (own[2] > 0);
  }

  Vertex start(HalfEdge e) const {
    return surface.vertex(triangle_of(e), corner_after(corner_of(e)));
  }
  Vertex end(HalfEdge e) const {
    return surface.vertex(triangle_of(e), corner_before(corner_of(e)));
  }
  double elevation(Vertex v) const { return surface.elevation(v); }

  // The same edge as the triangle beyond has it, kNoHalfEdge at the boundary.
  HalfEdge across(HalfEdge e) const {
    const Triangle other = surface.neighbor(triangle_of(e), corner_of(e));
    if (!surface.is_triangle(other)) return kNoHalfEdge;
    return half_edge(other, corner_before(surface.corner_at(other, end(e))));
  }

  // Where the fall line through the corner opposite meets an edge.
  double split(HalfEdge e) const {
    const std::size_t first = entry_of(triangle_of(e), 0);
    const double part = -values[first + corner_before(corner_of(e))];
    return round_share(clip_share(part / values[entry_of(e)]));
  }

  // That of a level triangle means nothing.
  Base base(Triangle t) const {
    const std::int8_t* const own = signs + entry_of(t, 0);
    const bool drains = count_drains(t) < 2;
    const std::int8_t* const edge =
        drains ? std::max_element(own, own + 3) : std::min_element(own, own + 3);
    const auto corner = static_cast<std::uint8_t>(edge - own);
    return {split(half_edge(t, corner)), corner, drains};
  }
};

}  // namespace tinsmith::hydrology
