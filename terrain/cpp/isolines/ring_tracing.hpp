// The rings around a plane region whose boundary is known as directed segments, the region on
// their left: segments that run forth and back cancel, and where several rings meet in a point
// each goes on so that the region stays on its left.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/point.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"

namespace tinsmith::isolines {

// A segment of a boundary.
struct BoundarySegment {
  Point from;
  Point to;
};

// A ring without a point that it passes twice; its first point is the first by easting, then
// northing.
struct Ring {
  std::vector<Point> points;
  std::int32_t walk;  // rings that touch, around one connected part, are of one walk
  bool is_exterior;   // counter-clockwise
};

class RingTracer {
 public:
  explicit RingTracer(std::vector<BoundarySegment> segments) : segments_(std::move(segments)) {}

  std::vector<Ring> trace() {
    number_points();
    cancel();
    sort_by_start();
    place_.assign(points_.size(), -1);
    for (std::size_t s = 0; s < edges_.size(); ++s) {
      if (!edges_[s].is_traced) trace_from(s);
    }
    return std::move(rings_);
  }

 private:
  struct Edge {
    std::int32_t from;
    std::int32_t to;
    bool is_traced = false;
  };

  // Every point has a segment that starts there.
  void number_points() {
    points_.reserve(segments_.size());
    for (const BoundarySegment& s : segments_) points_.push_back(s.from);
    std::sort(points_.begin(), points_.end(), lexicographically_before);
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    edges_.reserve(segments_.size());
    for (const BoundarySegment& s : segments_) {
      edges_.push_back({number_of(s.from), number_of(s.to)});
    }
    free_memory(segments_);
  }

  std::int32_t number_of(Point p) const {
    const auto found =
        std::lower_bound(points_.begin(), points_.end(), p, lexicographically_before);
    if (found == points_.end() || !(*found == p)) throw not_closed();
    return static_cast<std::int32_t>(found - points_.begin());
  }

  static std::logic_error not_closed() { return std::logic_error("a boundary does not close"); }

  // Leave out pairs of segments of opposite direction.
  void cancel() {
    const auto low = [](const Edge& e) { return std::min(e.from, e.to); };
    const auto high = [](const Edge& e) { return std::max(e.from, e.to); };
    std::sort(edges_.begin(), edges_.end(), [&](const Edge& a, const Edge& b) {
      return std::make_tuple(low(a), high(a), a.from) < std::make_tuple(low(b), high(b), b.from);
    });
    std::vector<Edge> kept;
    for (std::size_t i = 0, end = 0; i < edges_.size(); i = end) {
      while (end < edges_.size() && low(edges_[end]) == low(edges_[i]) &&
             high(edges_[end]) == high(edges_[i])) {
        ++end;
      }
      std::size_t middle = i;  // before it run the segments that start at the lower number
      while (middle < end && edges_[middle].from == low(edges_[i])) ++middle;
      const std::size_t pairs = std::min(middle - i, end - middle);
      kept.insert(kept.end(), edges_.begin() + std::ptrdiff_t(i + pairs),
                  edges_.begin() + std::ptrdiff_t(end - pairs));
    }
    edges_ = std::move(kept);
  }

  void sort_by_start() {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
      return std::make_pair(a.from, a.to) < std::make_pair(b.from, b.to);
    });
    first_.assign(points_.size() + 1, 0);
    for (const Edge& e : edges_) ++first_[std::size_t(e.from) + 1];
    for (std::size_t v = 0; v < points_.size(); ++v) first_[v + 1] += first_[v];
  }

  // Follow the boundary until it closes. Where it comes to a point again, the way since then is a
  // ring of its own.
  void trace_from(std::size_t start) {
    std::vector<std::size_t> way;
    std::size_t edge = start;
    do {
      edges_[edge].is_traced = true;
      place_[edges_[edge].from] = static_cast<std::int64_t>(way.size());
      way.push_back(edge);
      const std::int64_t since = place_[edges_[edge].to];
      if (since >= 0) cut_ring(way, std::size_t(since));
      edge = following(edge, start);
    } while (edge != start);
    ++walks_;
  }

  void cut_ring(std::vector<std::size_t>& way, std::size_t begin) {
    Ring ring;
    ring.walk = walks_;
    for (std::size_t i = begin; i < way.size(); ++i) {
      ring.points.push_back(points_[edges_[way[i]].from]);
      place_[edges_[way[i]].from] = -1;
    }
    way.resize(begin);
    if (ring.points.size() < 3) return;
    const auto first =
        std::min_element(ring.points.begin(), ring.points.end(), lexicographically_before);
    std::rotate(ring.points.begin(), first, ring.points.end());
    const std::vector<Point>& p = ring.points;
    ring.is_exterior = orientation(p.back(), p[0], p[1]) > 0;
    rings_.push_back(std::move(ring));
  }

  // The segment that goes on from the end of another: the first clockwise from its way back.
  // Every point has as many that end as that start there, so that one is left, or it is the first.
  std::size_t following(std::size_t edge, std::size_t start) const {
    const std::int32_t at = edges_[edge].to;
    std::size_t best = edges_.size();
    for (std::size_t e = first_[at]; e < first_[std::size_t(at) + 1]; ++e) {
      if (edges_[e].is_traced && e != start) continue;
      if (best == edges_.size() || is_before(points_[at], points_[edges_[edge].from],
                                             points_[edges_[e].to], points_[edges_[best].to])) {
        best = e;
      }
    }
    if (best == edges_.size()) throw not_closed();
    return best;
  }

  // Whether, turning clockwise about a point from the direction of `back`, a comes before b.
  static bool is_before(Point about, Point back, Point a, Point b) {
    const int turn_a = turn(about, back, a);
    const int turn_b = turn(about, back, b);
    return turn_a != turn_b ? turn_a < turn_b : orientation(about, a, b) < 0;
  }

  // Clockwise from the direction of `back`: 0 less than half a turn, 1 half, 2 more, 3 all of it.
  static int turn(Point about, Point back, Point p) {
    const int side = orientation(about, back, p);
    if (side != 0) return side < 0 ? 0 : 2;
    return lexicographically_before(about, p) == lexicographically_before(about, back) ? 3 : 1;
  }

  std::vector<BoundarySegment> segments_;
  std::vector<Point> points_;  // each once, by easting, then northing
  std::vector<Edge> edges_;    // by start
  std::vector<std::size_t> first_;
  std::vector<std::int64_t> place_;  // of a point in the way since the start, -1 for none
  std::vector<Ring> rings_;
  std::int32_t walks_ = 0;
};

}  // namespace tinsmith::isolines
