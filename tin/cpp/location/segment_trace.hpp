// Which triangles does a straight segment run through, and where does it cross their edges?
//
// Every triangle that the segment meets says where the segment comes in and goes out:
//
//             . c .             in:  on edge a-b, or at a vertex, or the segment's first end
//           .    /  .           out: on edge b-c, or at a vertex, or its second end
//     A ---.----/----.--- B
//         a ...b                Both by the exact signs of the corners beside A-B, and of A and B
//                               beside the edges.
//
// What one triangle calls its way out the next one calls its way in, so ways join to runs. Runs are
// apart from each other (holes, several parts), and are sorted along the segment. So no order of
// triangles is looked at, no neighbours are asked for, and a boundary of any shape is met.
//
// A crossing, its elevation and its ratio are the true ones rounded once: the same for a segment and
// its reverse, and for both triangles at an edge.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "../constraints/intersection_point.hpp"
#include "../constraints/segments.hpp"
#include "../predicates/double_double.hpp"
#include "locator.hpp"

namespace tinsmith {

// Places along segments where something changes, and both ends of each segment.
struct TraceBreaks {
  std::vector<Point> places;
  std::vector<double> elevations;       // NaN where there is no surface
  std::vector<double> ratios;           // 0 at the first end, 1 at the second
  std::vector<Vertex> vertices;         // that are there, else kNoVertex
  std::vector<std::int32_t> edges;      // crossed, or on which an end lies, else -1
  std::vector<std::int32_t> triangles;  // through which the segment goes on, -1 outside
  std::vector<std::int32_t> along;      // edge along which it goes on, else -1
  // Edges stand as 3 * triangle + corner opposite, of their smaller triangle.

  std::size_t size() const { return places.size(); }
  void resize(std::size_t count) {
    places.resize(count);
    elevations.resize(count);
    ratios.resize(count);
    vertices.resize(count);
    edges.resize(count);
    triangles.resize(count);
    along.resize(count);
  }
};

class SegmentTrace {
 public:
  // The locator must outlive the trace.
  explicit SegmentTrace(const Locator& locator) : locator_(locator), surface_(locator.surface()) {}

  // Append the breaks of one segment, whose ends are apart. False if triangles that it meets lie
  // over each other.
  bool append(Point a, Point b, TraceBreaks& breaks) {
    a_ = a;
    b_ = b;
    is_ascending_ = lexicographically_before(a, b);
    ways_.clear();
    touches_.clear();
    locator_.visit_near(Band(a, b, 0.0), [&](Triangle t) { meet(t); });
    gather_spots();
    return join_ways() && write(breaks);
  }

 private:
  static constexpr std::int32_t kNone = -1;
  static constexpr double kNoElevation = std::numeric_limits<double>::quiet_NaN();

  // Of a vertex (its number, twice), an edge (both its vertices), or an end of the segment.
  using Key = std::uint64_t;
  static constexpr Key kFirstEnd = UINT64_MAX - 1;
  static constexpr Key kSecondEnd = UINT64_MAX;

  struct Touch {
    Key key;
    Triangle triangle;
    Vertex vertex;
    HalfEdge edge;
  };
  struct Way {
    Key from, to;
    Triangle triangle;
    HalfEdge along;
  };
  struct Spot {
    Key key;
    Triangle triangle;  // the smallest
    Vertex vertex;
    HalfEdge edge;
    Point place;
    double ratio, elevation;
    std::int32_t way;  // that goes on from here
    bool is_reached;   // by a way
  };

  // A vertex or an edge of a triangle that the line through A-B meets, and which side of it A and
  // B are: +1 where the spot is after the end, 0 there, -1 before it.
  struct Feature {
    Vertex vertex;
    HalfEdge edge;
    Key key;
    int from_a, from_b;
  };

  // ------------------------------------------------------------------ one triangle

  void meet(Triangle t) {
    int side[3];
    for (std::uint32_t k = 0; k < 3; ++k) side[k] = orientation(a_, b_, surface_.corner(t, k));
    const int zeros = (side[0] == 0) + (side[1] == 0) + (side[2] == 0);
    const int sum = side[0] + side[1] + side[2];
    if (zeros == 0 && (sum == 3 || sum == -3)) return;
    if (zeros == 3) return;  // no area
    if (zeros == 2) return run_along(t, side);
    if (zeros == 1 && sum != 0) return touch_corner(t, side);
    run_through(t, side);
  }

  static std::uint32_t corner_on_line(const int (&side)[3]) {
    return side[0] == 0 ? 0 : side[1] == 0 ? 1 : 2;
  }

  void touch_corner(Triangle t, const int (&side)[3]) {
    const Feature corner = vertex_feature(t, corner_on_line(side));
    if (corner.from_a >= 0 && corner.from_b <= 0) add_touch(t, corner);
  }

  // The edge whose third corner is left of A-B goes the same way as the segment.
  void run_along(Triangle t, const int (&side)[3]) {
    const std::uint32_t third = side[0] != 0 ? 0 : side[1] != 0 ? 1 : 2;
    const bool is_same_way = side[third] > 0;
    const std::uint32_t first = is_same_way ? corner_after(third) : corner_before(third);
    const std::uint32_t second = is_same_way ? corner_before(third) : corner_after(third);
    add_way(t, vertex_feature(t, first), vertex_feature(t, second), half_edge(t, third));
  }

  // The line comes in over the edge from its left to its right, and goes out over the other.
  void run_through(Triangle t, const int (&side)[3]) {
    Feature in{}, out{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t next = corner_after(k);
      if (side[k] > 0 && side[next] < 0) in = edge_feature(t, k, true);
      if (side[k] < 0 && side[next] > 0) out = edge_feature(t, k, false);
      if (side[k] == 0) (side[next] > 0 ? out : in) = vertex_feature(t, k);
    }
    add_way(t, in, out, kNoHalfEdge);
  }

  Feature vertex_feature(Triangle t, std::uint32_t corner) const {
    const Vertex v = surface_.vertex(t, corner);
    const Point p = surface_.point(v);
    return {v, kNoHalfEdge, key_of(v, v), order(a_, p), order(b_, p)};
  }

  // Edge from corner k to the next, with the triangle on its left.
  Feature edge_feature(Triangle t, std::uint32_t k, bool is_in) const {
    const std::uint32_t next = corner_after(k);
    const Vertex u = surface_.vertex(t, k), v = surface_.vertex(t, next);
    const Point p = surface_.point(u), q = surface_.point(v);
    const int at_a = orientation(p, q, a_), at_b = orientation(p, q, b_);
    return {kNoVertex, half_edge(t, corner_before(k)), key_of(std::min(u, v), std::max(u, v)),
            is_in ? -at_a : at_a, is_in ? -at_b : at_b};
  }

  static Key key_of(Vertex smaller, Vertex larger) {
    return static_cast<Key>(number(smaller)) << 32 | static_cast<Key>(number(larger));
  }
  static Vertex smaller_of(Key key) { return Vertex{static_cast<std::int32_t>(key >> 32)}; }
  static Vertex larger_of(Key key) { return Vertex{static_cast<std::int32_t>(key & UINT32_MAX)}; }

  // Of points on the line: +1 if q comes after p, -1 before.
  int order(Point p, Point q) const {
    if (p == q) return 0;
    return lexicographically_before(p, q) == is_ascending_ ? 1 : -1;
  }

  // What of the way from `in` to `out` lies within the segment.
  void add_way(Triangle t, const Feature& in, const Feature& out, HalfEdge along) {
    if (in.from_b > 0 || out.from_a < 0) return;
    if (in.from_b == 0 || out.from_a == 0) {
      add_touch(t, in.from_b == 0 ? in : out);
      return;
    }
    const Feature inner{kNoVertex, along, 0, 0, 0};
    const Key from = in.from_a < 0 ? add_end(t, inner, kFirstEnd) : add_touch(t, in);
    const Key to = out.from_b > 0 ? add_end(t, inner, kSecondEnd) : add_touch(t, out);
    ways_.push_back({from, to, t, along});
  }

  Key add_end(Triangle t, const Feature& feature, Key end) {
    touches_.push_back({end, t, feature.vertex, feature.edge});
    return end;
  }

  Key add_touch(Triangle t, const Feature& feature) {
    if (feature.from_a == 0) return add_end(t, feature, kFirstEnd);
    if (feature.from_b == 0) return add_end(t, feature, kSecondEnd);
    return add_end(t, feature, feature.key);
  }

  // ------------------------------------------------------------------ all of them

  // One spot for all touches with one key.
  void gather_spots() {
    std::sort(touches_.begin(), touches_.end(), [](const Touch& s, const Touch& t) {
      return s.key < t.key || (s.key == t.key && s.triangle < t.triangle);
    });
    spots_.clear();
    for (const Touch& touch : touches_) {
      if (spots_.empty() || spots_.back().key != touch.key) {
        spots_.push_back(
            {touch.key, touch.triangle, touch.vertex, touch.edge, {}, 0.0, 0.0, kNone, false});
        continue;
      }
      Spot& spot = spots_.back();
      spot.vertex = std::max(spot.vertex, touch.vertex);
      if (spot.edge == kNoHalfEdge) spot.edge = touch.edge;
    }
    for (Spot& spot : spots_) {
      if (spot.vertex != kNoVertex) spot.edge = kNoHalfEdge;
      measure(spot);
    }
  }

  std::int32_t find(Key key) const {
    const auto at = std::lower_bound(spots_.begin(), spots_.end(), key,
                                     [](const Spot& spot, Key k) { return spot.key < k; });
    return static_cast<std::int32_t>(at - spots_.begin());
  }

  // Both triangles at an edge have a way along it; the smaller one's is kept.
  bool join_ways() {
    std::sort(ways_.begin(), ways_.end(), [](const Way& v, const Way& w) {
      return v.from < w.from || (v.from == w.from && v.triangle < w.triangle);
    });
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      const Way& way = ways_[i];
      if (i > 0 && ways_[i - 1].from == way.from) {
        if (ways_[i - 1].to != way.to || way.along == kNoHalfEdge) return false;
        continue;
      }
      Spot& next = spots_[find(way.to)];
      if (next.is_reached) return false;
      next.is_reached = true;
      spots_[find(way.from)].way = static_cast<std::int32_t>(i);
    }
    return true;
  }

  bool write(TraceBreaks& breaks) {
    heads_.clear();
    for (std::size_t i = 0; i < spots_.size(); ++i) {
      if (!spots_[i].is_reached) heads_.push_back(static_cast<std::int32_t>(i));
    }
    std::sort(heads_.begin(), heads_.end(),
              [&](std::int32_t i, std::int32_t j) { return compare(spots_[i], spots_[j]) < 0; });
    const bool has_first = !heads_.empty() && spots_[heads_.front()].key == kFirstEnd;
    if (!has_first) add(breaks, outside(a_, 0.0), nullptr);
    const Spot* last = nullptr;
    for (const std::int32_t head : heads_) {
      if (last != nullptr && compare(*last, spots_[head]) > 0) return false;
      last = add_run(breaks, spots_[head]);
    }
    if (last == nullptr || last->key != kSecondEnd) add(breaks, outside(b_, 1.0), nullptr);
    return true;
  }

  const Spot* add_run(TraceBreaks& breaks, const Spot& head) {
    const Spot* spot = &head;
    for (; spot->way != kNone; spot = &spots_[find(ways_[spot->way].to)]) {
      add(breaks, *spot, &ways_[spot->way]);
    }
    add(breaks, *spot, nullptr);
    return spot;
  }

  static Spot outside(Point place, double ratio) {
    return {0, kNoTriangle, kNoVertex, kNoHalfEdge, place, ratio, kNoElevation, kNone, false};
  }

  static void add(TraceBreaks& breaks, const Spot& spot, const Way* way) {
    breaks.places.push_back({spot.place.x + 0.0, spot.place.y + 0.0});  // no -0.0
    breaks.elevations.push_back(spot.elevation + 0.0);
    breaks.ratios.push_back(spot.ratio);
    breaks.vertices.push_back(spot.vertex);
    breaks.edges.push_back(as_entry(spot.edge));
    breaks.triangles.push_back(index_of(way == nullptr ? kNoTriangle : way->triangle));
    breaks.along.push_back(as_entry(way == nullptr ? kNoHalfEdge : way->along));
  }
  static std::int32_t as_entry(HalfEdge e) {
    return e == kNoHalfEdge ? kNone : static_cast<std::int32_t>(entry_of(e));
  }

  // ------------------------------------------------------------------ measures

  // evaluate(part, whole) of the share of A-B that comes before a spot within it, exactly.
  template <typename Evaluate>
  auto with_ratio(const Spot& spot, Evaluate&& evaluate) const {
    if (spot.vertex != kNoVertex) {
      const Point v = surface_.point(spot.vertex);
      const bool is_wide = std::fabs(b_.x - a_.x) >= std::fabs(b_.y - a_.y);
      return is_wide ? evaluate(expand(exact_difference(v.x, a_.x)),
                                expand(exact_difference(b_.x, a_.x)))
                     : evaluate(expand(exact_difference(v.y, a_.y)),
                                expand(exact_difference(b_.y, a_.y)));
    }
    const Point p = surface_.point(smaller_of(spot.key));
    const Point q = surface_.point(larger_of(spot.key));
    const auto at_a = detail::exact_twice_area(p, q, a_);
    return evaluate(at_a, at_a - detail::exact_twice_area(p, q, b_));
  }

  void measure(Spot& spot) const {
    if (spot.key >= kFirstEnd) {
      spot.place = spot.key == kFirstEnd ? a_ : b_;
      spot.ratio = spot.key == kFirstEnd ? 0.0 : 1.0;
      spot.elevation = locator_.elevation_at(spot.place, spot.triangle);
      return;
    }
    if (spot.vertex == kNoVertex) return measure_crossing(spot);
    spot.place = surface_.point(spot.vertex);
    spot.elevation = surface_.elevation(spot.vertex);
    spot.ratio = exact_ratio(spot);
  }

  double exact_ratio(const Spot& spot) const {
    return with_ratio(spot, [](const auto& part, const auto& whole) {
      return detail::rounded_quotient(part, whole);
    });
  }

  // The distances of the edge's ends from A-B divide the edge, those of A and B from the edge A-B.
  void measure_crossing(Spot& spot) const {
    const Vertex u = smaller_of(spot.key), v = larger_of(spot.key);
    const Point p = surface_.point(u), q = surface_.point(v);
    const double low = surface_.elevation(u), high = surface_.elevation(v);
    const detail::AreaEstimate at_p(a_, b_, p), at_q(a_, b_, q);
    Point& place = spot.place;
    if (!detail::divide_between(at_p, at_q, q.x, p.x, place.x) ||
        !detail::divide_between(at_p, at_q, q.y, p.y, place.y)) {
      place = intersection_point(a_, b_, p, q);
    }
    if (!detail::divide_between({p, q, a_}, {p, q, b_}, 1.0, 0.0, spot.ratio)) {
      spot.ratio = exact_ratio(spot);
    }
    if (!is_in_exact_range(low) || !is_in_exact_range(high)) {
      spot.elevation = locator_.elevation_at(place, spot.triangle);
    } else if (!detail::divide_between(at_p, at_q, high, low, spot.elevation)) {
      const auto s = detail::exact_twice_area(a_, b_, p);
      const auto t = detail::exact_twice_area(a_, b_, q);
      spot.elevation = detail::rounded_quotient(s * high - t * low, s - t);
    }
  }

  // +1 if s comes after t along the segment, -1 before. Rounded ratios are in order, unless equal.
  int compare(const Spot& s, const Spot& t) const {
    if (s.ratio != t.ratio) return s.ratio > t.ratio ? 1 : -1;
    const bool s_is_end = s.key >= kFirstEnd, t_is_end = t.key >= kFirstEnd;
    if (s_is_end || t_is_end) {
      const int at_first = (t.key == kFirstEnd) - (s.key == kFirstEnd);
      return at_first != 0 ? at_first : (s.key == kSecondEnd) - (t.key == kSecondEnd);
    }
    return with_ratio(s, [&](const auto& s_part, const auto& s_whole) {
      return with_ratio(t, [&](const auto& t_part, const auto& t_whole) {
        return (s_part * t_whole - t_part * s_whole).sign() * s_whole.sign() * t_whole.sign();
      });
    });
  }

  const Locator& locator_;
  const Surface surface_;
  Point a_{}, b_{};
  bool is_ascending_ = true;
  std::vector<Touch> touches_;
  std::vector<Way> ways_;
  std::vector<Spot> spots_;
  std::vector<std::int32_t> heads_;
};

// The breaks of segments one after the other, up to the first for which there are none.
struct TracedSegments {
  TraceBreaks breaks;
  std::vector<std::int64_t> offsets{0};  // where those of each segment begin, and the end

  std::int64_t count() const { return static_cast<std::int64_t>(offsets.size()) - 1; }
};

// Incomplete if asked to stop.
template <typename KeepGoing>
TracedSegments trace_segments(const Locator& locator, const Point* starts, const Point* ends,
                              std::int64_t count, KeepGoing&& keep_going) {
  constexpr std::int64_t kSegmentsPerQuestion = 64;
  TracedSegments traced;
  SegmentTrace trace(locator);
  for (std::int64_t i = 0; i < count; ++i) {
    if (i % kSegmentsPerQuestion == 0 && !keep_going()) break;
    if (starts[i] == ends[i]) throw std::invalid_argument("ends of a segment must be apart");
    const std::size_t before = traced.breaks.size();
    if (!trace.append(starts[i], ends[i], traced.breaks)) {
      traced.breaks.resize(before);
      break;
    }
    traced.offsets.push_back(static_cast<std::int64_t>(traced.breaks.size()));
  }
  return traced;
}

}  // namespace tinsmith
