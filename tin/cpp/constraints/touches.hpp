// Which vertices lie on segments?
//
// A vertex touches a segment if it lies in the open interior, exactly. With a distance d > 0 it
// also does if it lies within d of the segment's line, further than d from both ends, and nearer
// to each end than the ends are to each other:
//
//             .  '  .   .  '  .
//           .     .  '.'  .     .        inside both circles about the ends through the other end
//         .( )---------------( ).        (so its foot is inside, and both parts that it splits the
//           .     .  '.'  .     .        segment into are shorter than the segment), but not
//             .  .  '   '  .  .          within d of an end: such a vertex is the end's affair
//
// So splitting segments at what touches them comes to an end: parts only ever get shorter.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "../index/box_tree.hpp"
#include "../index/hilbert_order.hpp"
#include "segment_raster.hpp"
#include "segments.hpp"

namespace tinsmith {

// Whether p is in the open interior of a-b.
inline bool is_on_interior(Point a, Point b, Point p) {
  const bool forward = lexicographically_before(a, p) && lexicographically_before(p, b);
  const bool backward = lexicographically_before(b, p) && lexicographically_before(p, a);
  return (forward || backward) && orientation(a, b, p) == 0;
}

// Whether p touches a-b within `distance` > 0; the same for b-a.
inline bool is_near_interior(Point a, Point b, Point p, double distance) {
  const auto square = [](Point u, Point v) {
    const double dx = v.x - u.x, dy = v.y - u.y;
    return dx * dx + dy * dy;
  };
  const double to_a = square(a, p), to_b = square(b, p), length = square(a, b);
  if (!(to_a <= length && to_b <= length)) return false;  // rounding is monotone
  if (lexicographically_before(b, a)) std::swap(a, b);
  const double area = std::fabs(detail::twice_area(a, b, p));
  if (area == 0.0) return is_on_interior(a, b, p);
  const double near = distance * distance;
  return area <= distance * std::sqrt(length) && to_a > near && to_b > near && to_a < length &&
         to_b < length;
}

inline bool touches_interior(Point a, Point b, Point p, double distance) {
  return distance > 0.0 ? is_near_interior(a, b, p, distance) : is_on_interior(a, b, p);
}

// Pairs (segment, vertex), sorted; incomplete if the team was stopped. The vertices are those of
// the points from `first_vertex` to `vertex_count` - 1 for which `is_asked(vertex)`.
class TouchSearch {
 public:
  TouchSearch(const Segments& segments, Reach reach) : segments_(segments), reach_(reach) {}

  template <typename IsAsked>
  std::vector<Touch> run(Vertex first_vertex, std::int32_t vertex_count, IsAsked&& is_asked,
                         Team& team) {
    gather(first_vertex, vertex_count, is_asked, team);
    std::vector<std::vector<Touch>> found(team.size());
    if (team.is_stopped() || items_.empty()) return {};
    visit_in_blocks(segments_.count, team,
                    [&](int part, std::int32_t i) { search(Segment{i}, found[part]); });
    return sorted_together(found);
  }

 private:
  struct Item {
    Point point;
    Vertex vertex;
  };

  // The vertices that a raster of the segments cannot rule out, in spatial order.
  template <typename IsAsked>
  void gather(Vertex first_vertex, std::int32_t vertex_count, IsAsked&& is_asked, Team& team) {
    const std::int32_t asked = vertex_count - number(first_vertex);
    const SegmentRaster raster(segments_, reach_, asked);
    std::vector<std::vector<Vertex>> kept(team.size());
    team.run([&](int part) {
      const Range range = part_of(asked, part, team.size());
      if (!team.keeps_going(part)) return;
      for (std::int32_t i = range.begin; i < range.end; ++i) {
        const Vertex v{number(first_vertex) + i};
        if (is_asked(v) && raster.may_hold(segments_.point(v))) kept[part].push_back(v);
      }
    });
    std::vector<Vertex> vertices = std::move(kept[0]);
    for (int part = 1; part < team.size(); ++part) {
      vertices.insert(vertices.end(), kept[part].begin(), kept[part].end());
    }
    const auto count = static_cast<std::int32_t>(vertices.size());
    const HilbertOrder order(count, [&](std::int32_t i) { return segments_.point(vertices[i]); });
    items_.resize(count);
    for (std::int32_t i = 0; i < count; ++i) {
      const Vertex v = vertices[order[i]];
      items_[i] = {segments_.point(v), v};
    }
    tree_ = BoxTree(count, [&](std::int32_t i) {
      const Point p = items_[i].point;
      return Box::of(p, p);
    });
  }

  void search(Segment segment, std::vector<Touch>& found) const {
    const Point a = segments_.point(segment, 0), b = segments_.point(segment, 1);
    const Vertex first = segments_.end(segment, 0), second = segments_.end(segment, 1);
    const double distance = reach_.of(a, b);
    const Band band(a, b, distance);
    const auto wanted = [&](const Box& box, std::int64_t) { return band.meets(box); };
    tree_.visit_leaves_if(wanted, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t i = begin; i < end; ++i) {
        const auto& [point, vertex] = items_[i];
        if (vertex == first || vertex == second) continue;
        if (touches_interior(a, b, point, distance)) found.push_back({segment, vertex});
      }
      return false;
    });
  }

  Segments segments_;
  Reach reach_;
  std::vector<Item> items_;
  BoxTree tree_;
};

// The vertex at each of the points, -1 where there is none.
inline std::vector<std::int32_t> vertices_at(const Point* vertices, std::int32_t vertex_count,
                                             const Point* points, std::int32_t point_count) {
  constexpr std::int32_t kNone = -1;
  std::vector<std::int32_t> order(point_count);
  for (std::int32_t i = 0; i < point_count; ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    return lexicographically_before(points[i], points[j]);
  });
  std::vector<std::int32_t> found(point_count, kNone);
  const PointFilter filter(points, point_count);
  for (std::int32_t v = 0; v < vertex_count; ++v) {
    if (!filter.may_hold(vertices[v])) continue;
    auto at = std::lower_bound(
        order.begin(), order.end(), vertices[v],
        [&](std::int32_t i, Point p) { return lexicographically_before(points[i], p); });
    for (; at != order.end() && points[*at] == vertices[v]; ++at) {
      if (found[*at] == kNone) found[*at] = v;
    }
  }
  return found;
}

}  // namespace tinsmith
