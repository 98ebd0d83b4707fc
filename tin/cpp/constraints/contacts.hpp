// Where do segments meet: which cross, and which vertices lie on them?
//
// Two segments cross where their open interiors have exactly one point in common and neither holds
// an end of the other. Segments that share an end, touch or overlap along a line do not cross.
//
// Ends of segments are found to touch as pairs of near segments are looked at; only the other
// vertices, most of a survey, are asked about one by one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "intersection_point.hpp"
#include "segment_boxes.hpp"
#include "segments.hpp"
#include "touches.hpp"

namespace tinsmith {

inline bool do_cross(Point a, Point b, Point c, Point d) {
  return orientation(a, b, c) * orientation(a, b, d) < 0 &&
         orientation(c, d, a) * orientation(c, d, b) < 0;
}

inline Crossing in_ascending_order(Segment first, Segment second) {
  return {std::min(first, second), std::max(first, second)};
}

// Pairs i < j with j >= first_new, sorted; incomplete if the team was stopped.
inline std::vector<Crossing> find_crossings(const Segments& segments, Segment first_new,
                                            Team& team) {
  using Item = SegmentBoxes::Item;
  std::vector<std::vector<Crossing>> found(team.size());
  const SegmentBoxes tree(segments, 0.0);
  tree.visit_pairs(first_new, team, [&](int part, const Item& s, const Item& t) {
    if (!do_cross(s.end[0], s.end[1], t.end[0], t.end[1])) return;
    found[part].push_back(in_ascending_order(s.segment, t.segment));
  });
  return sorted_together(found);
}

// Where the segments of each pair cross, two numbers a pair; incomplete if the team was stopped.
inline std::vector<Point> find_intersections(const Segments& segments, const std::int32_t* pairs,
                                             std::int32_t count, Team& team) {
  std::vector<Point> found(count);
  visit_in_blocks(count, team, [&](int, std::int32_t i) {
    const std::int32_t* pair = pairs + 2 * static_cast<std::size_t>(i);
    const Segment s{pair[0]}, t{pair[1]};
    const Point a = segments.point(s, 0), b = segments.point(s, 1);
    const Point c = segments.point(t, 0), d = segments.point(t, 1);
    if (!do_cross(a, b, c, d)) {
      throw std::invalid_argument("the segments of every pair must cross");
    }
    const Point met = intersection_point(a, b, c, d);
    found[i] = {met.x + 0.0, met.y + 0.0};  // no -0.0
  });
  return found;
}

// Crossings, and touches within a distance, of all segments and vertices in one search.
class ContactSearch {
 public:
  std::vector<Crossing> crossings;  // incomplete, as the touches, if the team was stopped
  std::vector<Touch> touches;

  ContactSearch(const Segments& segments, std::int32_t vertex_count, double distance, Team& team)
      : distance_(distance), found_(team.size()) {
    const SegmentBoxes tree(segments, distance);
    tree.visit_pairs(
        Segment{0}, team, [&](int part, const SegmentBoxes::Item& s, const SegmentBoxes::Item& t) {
          distance > 0.0 ? compare_near(s, t, found_[part]) : compare(s, t, found_[part]);
        });
    if (team.is_stopped()) return;
    touches = touches_of_others(segments, vertex_count, team);
    for (Found& found : found_) {
      crossings.insert(crossings.end(), found.crossings.begin(), found.crossings.end());
      touches.insert(touches.end(), found.touches.begin(), found.touches.end());
    }
    std::sort(crossings.begin(), crossings.end());
    std::sort(touches.begin(), touches.end());
    // A vertex is the end of several segments.
    const auto is_same = [](Touch p, Touch q) { return !(p < q) && !(q < p); };
    touches.erase(std::unique(touches.begin(), touches.end(), is_same), touches.end());
  }

 private:
  using Item = SegmentBoxes::Item;
  struct Found {
    std::vector<Crossing> crossings;
    std::vector<Touch> touches;
  };

  // Most pairs are told apart by the first two signs.
  static void compare(const Item& s, const Item& t, Found& found) {
    int t_side[2], s_side[2];
    for (int k = 0; k < 2; ++k) t_side[k] = orientation(s.end[0], s.end[1], t.end[k]);
    if (t_side[0] * t_side[1] > 0) return;
    for (int k = 0; k < 2; ++k) s_side[k] = orientation(t.end[0], t.end[1], s.end[k]);
    if (s_side[0] * s_side[1] > 0) return;
    if (t_side[0] * t_side[1] < 0 && s_side[0] * s_side[1] < 0) {
      found.crossings.push_back(in_ascending_order(s.segment, t.segment));
      return;
    }
    for (int k = 0; k < 2; ++k) {
      if (t_side[k] == 0) add_touch(s, t, k, 0.0, found);
      if (s_side[k] == 0) add_touch(t, s, k, 0.0, found);
    }
  }

  void compare_near(const Item& s, const Item& t, Found& found) const {
    if (do_cross(s.end[0], s.end[1], t.end[0], t.end[1])) {
      found.crossings.push_back(in_ascending_order(s.segment, t.segment));
    }
    for (int k = 0; k < 2; ++k) {
      add_touch(s, t, k, distance_, found);
      add_touch(t, s, k, distance_, found);
    }
  }

  // Where end k of `other` touches `item`.
  static void add_touch(const Item& item, const Item& other, int k, double distance, Found& found) {
    if (other.vertex[k] == item.vertex[0] || other.vertex[k] == item.vertex[1]) return;
    if (!touches_interior(item.end[0], item.end[1], other.end[k], distance)) return;
    found.touches.push_back({item.segment, other.vertex[k]});
  }

  std::vector<Touch> touches_of_others(const Segments& segments, std::int32_t vertex_count,
                                       Team& team) const {
    std::vector<char> is_end(vertex_count);
    for (std::int32_t i = 0; i < segments.count; ++i) {
      for (int k = 0; k < 2; ++k) is_end[number(segments.end(Segment{i}, k))] = 1;
    }
    const auto is_asked = [&](Vertex v) { return is_end[number(v)] == 0; };
    return TouchSearch(segments, {distance_, false}).run(Vertex{0}, vertex_count, is_asked, team);
  }

  double distance_;
  std::vector<Found> found_;  // by each part
};

}  // namespace tinsmith
