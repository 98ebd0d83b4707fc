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
#include "../predicates/expansion.hpp"
#include "../predicates/predicates.hpp"

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

  // Of several places at exactly the same distance the westernmost, of several of these the
  // southernmost, and there the lowest: whatever the numbers of triangles. The edge that was found
  // for a point near by may be given, for a quick start.
  BoundaryPlace find(Point p, HalfEdge near = kNoHalfEdge) const {
    Candidate best;
    const auto look_at = [&](HalfEdge edge) {
      if (edge == best.place.edge) return;
      const Candidate one = candidate_on(p, edge);
      if (best.place.edge == kNoHalfEdge || comes_before(p, one, best)) best = one;
    };
    look_at(near == kNoHalfEdge ? edges_.front() : near);
    const auto may_be_nearer = [&](const Box& box, std::int64_t) {
      const double x = std::max({box.west - p.x, p.x - box.east, 0.0});
      const double y = std::max({box.south - p.y, p.y - box.north, 0.0});
      return x * x + y * y <= best.square + best.error;
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
    double error = 0.0;                                       // at most, of the square
    Vertex corner = kNoVertex;                                // that is nearest, beyond doubt
    double elevation = 0.0;
  };

  // Where the rounded distances do not tell, the exact ones do.
  bool comes_before(Point p, const Candidate& a, const Candidate& b) const {
    if (std::abs(a.square - b.square) > a.error + b.error) return a.square < b.square;
    if (a.corner != kNoVertex && a.corner == b.corner) return a.place.edge < b.place.edge;
    const Point from = point_of(start_of(a.place.edge)), to = point_of(end_of(a.place.edge));
    const double size = std::max({std::abs(p.x - from.x), std::abs(p.y - from.y),
                                  std::abs(to.x - from.x), std::abs(to.y - from.y)});
    const int exponent = -std::ilogb(size > 0.0 ? size : 1.0);
    const ExactOffset own = exact_offset(p, a.place.edge, exponent);
    const ExactOffset other = exact_offset(p, b.place.edge, exponent);
    const auto compare = [&](const auto& left, const auto& right) {
      return (left * other.divisor - right * own.divisor).sign();
    };
    int order = compare(own.square, other.square);
    if (order == 0) order = compare(own.x, other.x);
    if (order == 0) order = compare(own.y, other.y);
    if (order != 0) return order < 0;
    return a.elevation != b.elevation ? a.elevation < b.elevation : a.place.edge < b.place.edge;
  }

  // From a point to the nearest place of an edge: x / divisor, y / divisor; the distance squared is
  // square / divisor. All differences are times a power of two, so that no product underflows.
  struct ExactOffset {
    Expansion<64> x, y;
    Expansion<512> square;
    Expansion<16> divisor;
  };

  ExactOffset exact_offset(Point p, HalfEdge e, int exponent) const {
    const auto difference = [exponent](double u, double v) {
      const TwoDoubles exact = exact_difference(u, v);
      return expand({std::ldexp(exact.high, exponent), std::ldexp(exact.low, exponent)});
    };
    const Point a = point_of(start_of(e)), b = point_of(end_of(e));
    const auto east = difference(b.x, a.x), north = difference(b.y, a.y);
    const auto x = difference(p.x, a.x), y = difference(p.y, a.y);
    const auto along = x * east + y * north;
    const auto length = east * east + north * north;
    const bool is_before = along.sign() <= 0, is_behind = (along - length).sign() >= 0;
    ExactOffset found;
    if (is_before || is_behind) {
      const Point corner = is_before ? a : b;
      const auto u = difference(corner.x, p.x), v = difference(corner.y, p.y);
      found.x = widen<64>(u);
      found.y = widen<64>(v);
      found.square = widen<512>(u * u + v * v);
      found.divisor = widen<16>(expand(1.0));
    } else {
      const auto left = east * y - north * x;
      found.x = left * north;
      found.y = -(left * east);
      found.square = left * left;
      found.divisor = length;
    }
    return found;
  }

  Point point_of(Vertex v) const { return surface_.point(v); }
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
    const double along = (p.x - a.x) * east + (p.y - a.y) * north;
    const double length = east * east + north * north;
    const double ratio = along / length;
    const double share = std::min(std::max(ratio, 0.0), 1.0);
    const bool is_late = share > 0.5;
    const Vertex near = is_late ? end : start;
    const Point from = surface_.point(near);
    const double part = is_late ? share - 1.0 : share;
    const double x = p.x - from.x - part * east, y = p.y - from.y - part * north;
    const double rise = surface_.elevation(end) - surface_.elevation(start);
    const double size =
        std::abs(p.x - a.x) + std::abs(p.y - a.y) + std::abs(east) + std::abs(north);
    const double off = kRoundingsOfOffset * kUnitRoundoff * size;
    const bool is_before = along<-off * size, is_behind = along - length> off * size;
    return {{e, share},
            x * x + y * y,
            off * (2.0 * (std::abs(x) + std::abs(y)) + 2.0 * off),
            is_before   ? start
            : is_behind ? end
                        : kNoVertex,
            surface_.elevation(near) + part * rise};
  }

  static constexpr double kRoundingsOfOffset = 16.0;  // in x and in y, at most

  Surface surface_;
  std::vector<HalfEdge> edges_;  // without a triangle beyond, in spatial order
  BoxTree tree_;
};

}  // namespace tinsmith
