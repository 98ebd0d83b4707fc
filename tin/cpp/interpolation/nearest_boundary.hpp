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

  // Of several at the same distance, as doubles compare, that on the smallest edge. The edge that
  // was found for a point near by may be given, for a quick start.
  BoundaryPlace find(Point p, HalfEdge near = kNoHalfEdge) const {
    BoundaryPlace best;
    double least = std::numeric_limits<double>::infinity();
    const auto look_at = [&](HalfEdge edge) {
      const double share = nearest_share(p, edge);
      const double away = distance(p, edge, share);
      if (away < least || (away == least && edge < best.edge)) {
        least = away;
        best = {edge, share};
      }
    };
    look_at(near == kNoHalfEdge ? edges_.front() : near);
    const auto may_be_nearer = [&](const Box& box, std::int64_t) {
      const double x = std::max({box.west - p.x, p.x - box.east, 0.0});
      const double y = std::max({box.south - p.y, p.y - box.north, 0.0});
      return x * x + y * y <= least;
    };
    tree_.visit_leaves_if(may_be_nearer, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = begin; i < end; ++i) look_at(edges_[i]);
      return false;
    });
    return best;
  }

 private:
  Point start_of(HalfEdge e) const {
    return surface_.corner(triangle_of(e), corner_after(corner_of(e)));
  }
  Point end_of(HalfEdge e) const {
    return surface_.corner(triangle_of(e), corner_before(corner_of(e)));
  }
  Box box_of(HalfEdge e) const { return Box::of(start_of(e), end_of(e)); }

  double nearest_share(Point p, HalfEdge e) const {
    const Point a = start_of(e), b = end_of(e);
    const double x = b.x - a.x, y = b.y - a.y;
    const double share = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
    return std::min(std::max(share, 0.0), 1.0);
  }

  double distance(Point p, HalfEdge e, double share) const {
    const Point a = start_of(e), b = end_of(e);
    // From the nearer end, so that both ends are met exactly.
    const bool is_late = share > 0.5;
    const Point from = is_late ? b : a;
    const double part = is_late ? share - 1.0 : share;
    const double x = p.x - from.x - part * (b.x - a.x), y = p.y - from.y - part * (b.y - a.y);
    return x * x + y * y;
  }

  Surface surface_;
  std::vector<HalfEdge> edges_;  // without a triangle beyond, in spatial order
  BoxTree tree_;
};

}  // namespace tinsmith
