// The place of the boundary that is nearest to a point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "../base/box.hpp"
#include "../index/box_tree.hpp"
#include "../index/hilbert_order.hpp"
#include "../location/locator.hpp"

namespace tinsmith {

struct BoundaryPlace {
  HalfEdge edge = kNoHalfEdge;
  double share = 0.0;  // of the way along the edge
};

class NearestBoundary {
 public:
  // The surface's arrays must outlive it.
  explicit NearestBoundary(const Surface& surface) : surface_(surface) {
    std::vector<HalfEdge> found;
    for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (!surface.is_triangle(surface.neighbor(t, k))) found.push_back(half_edge(t, k));
      }
    }
    if (found.empty()) throw std::invalid_argument("the surface has no boundary");
    const auto count = static_cast<std::int32_t>(found.size());
    const HilbertOrder order(count, [&](std::int32_t i) { return box_of(found[i]).center(); });
    for (std::int32_t i = 0; i < count; ++i) edges_.push_back(found[order[i]]);
    tree_ = BoxTree(count, [this](std::int32_t i) { return box_of(edges_[i]); });
  }

  // The edge nearest to each of many points, which are finite, as 3 * triangle + corner, and the
  // share of the way along it. False if asked to stop.
  template <typename KeepGoing>
  bool find_all(const Point* points, std::int32_t count, std::int32_t* edges, double* shares,
                KeepGoing&& keep_going) const {
    constexpr std::int32_t kPointsPerQuestion = 4096;
    const HilbertOrder order(points, count);
    HalfEdge last = kNoHalfEdge;
    for (std::int32_t i = 0; i < count; ++i) {
      if (i % kPointsPerQuestion == 0 && !keep_going()) return false;
      const BoundaryPlace place = find(points[order[i]], last);
      last = place.edge;
      edges[order[i]] = static_cast<std::int32_t>(entry_of(place.edge));
      shares[order[i]] = place.share;
    }
    return true;
  }

  // Of several places at the same distance, as doubles compare, the westernmost, of several of these
  // the southernmost, and there the lowest: whatever the numbers of triangles. The edge that was found
  // for a point near by may be given, for a quick start.
  BoundaryPlace find(Point p, HalfEdge near = kNoHalfEdge) const {
    Candidate best;
    const auto look_at = [&](HalfEdge edge) {
      const Candidate one = candidate_on(p, edge);
      if (one.comes_before(best)) best = one;
    };
    look_at(near == kNoHalfEdge ? edges_.front() : near);
    const auto may_be_nearer = [&](const Box& box, std::int64_t) {
      const double x = std::max({box.west - p.x, p.x - box.east, 0.0});
      const double y = std::max({box.south - p.y, p.y - box.north, 0.0});
      return x * x + y * y <= best.square;
    };
    tree_.visit_leaves_if(may_be_nearer, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = begin; i < end; ++i) look_at(edges_[i]);
      return false;
    });
    return best.place;
  }

 private:
  struct Candidate {
    BoundaryPlace place;
    double square = std::numeric_limits<double>::infinity();  // of the distance
    Point at{};
    double elevation = 0.0;

    bool comes_before(const Candidate& other) const {
      if (square != other.square) return square < other.square;
      if (at.x != other.at.x) return at.x < other.at.x;
      if (at.y != other.at.y) return at.y < other.at.y;
      return elevation != other.elevation ? elevation < other.elevation
                                          : place.edge < other.place.edge;
    }
  };

  Vertex start_of(HalfEdge e) const {
    return surface_.vertex(triangle_of(e), corner_after(corner_of(e)));
  }
  Vertex end_of(HalfEdge e) const {
    return surface_.vertex(triangle_of(e), corner_before(corner_of(e)));
  }
  Box box_of(HalfEdge e) const {
    return Box::of(surface_.point(start_of(e)), surface_.point(end_of(e)));
  }

  // From the nearer end, so that both ends are met exactly.
  Candidate candidate_on(Point p, HalfEdge e) const {
    const Vertex start = start_of(e), end = end_of(e);
    const Point a = surface_.point(start), b = surface_.point(end);
    const double east = b.x - a.x, north = b.y - a.y;
    const double ratio = ((p.x - a.x) * east + (p.y - a.y) * north) / (east * east + north * north);
    const double share = std::min(std::max(ratio, 0.0), 1.0);
    const bool is_late = share > 0.5;
    const Vertex near = is_late ? end : start;
    const Point from = surface_.point(near);
    const double part = is_late ? share - 1.0 : share;
    const double x = p.x - from.x - part * east, y = p.y - from.y - part * north;
    const double rise = surface_.elevation(end) - surface_.elevation(start);
    return {{e, share},
            x * x + y * y,
            {from.x + part * east, from.y + part * north},
            surface_.elevation(near) + part * rise};
  }

  Surface surface_;
  std::vector<HalfEdge> edges_;  // without a triangle beyond, in spatial order
  BoxTree tree_;
};

}  // namespace tinsmith
