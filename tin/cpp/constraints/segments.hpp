// Segments between numbered points, and what lies near one.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// As the caller holds them; the two ends may be one point.
struct Segments {
  const Point* points;
  const std::int32_t* ends;  // two point numbers each
  std::int32_t count;

  Vertex end(Segment s, int k) const {
    return Vertex{ends[2 * static_cast<std::size_t>(number(s)) + k]};
  }
  Point point(Vertex v) const { return points[number(v)]; }
  Point point(Segment s, int k) const { return point(end(s, k)); }
  Box box_of(Segment s) const { return Box::of(point(s, 0), point(s, 1)); }
};

// How far a segment reaches for vertices.
struct Reach {
  double distance;
  bool is_rounded;  // at least one unit in the last place of the ends' largest coordinate

  double of(Point a, Point b) const {
    if (!is_rounded) return distance;
    const double largest = std::max(std::max(std::fabs(a.x), std::fabs(a.y)),
                                    std::max(std::fabs(b.x), std::fabs(b.y)));
    return std::max(distance, std::nextafter(largest, HUGE_VAL) - largest);
  }
};

// Two segments that cross, in ascending order.
struct Crossing {
  Segment first;
  Segment second;
};

inline bool operator<(Crossing a, Crossing b) {
  return a.first < b.first || (a.first == b.first && a.second < b.second);
}

// A vertex on or near the interior of a segment.
struct Touch {
  Segment segment;
  Vertex vertex;
};

inline bool operator<(Touch a, Touch b) {
  return a.segment < b.segment || (a.segment == b.segment && a.vertex < b.vertex);
}

// All that lies within `reach` of a segment. meets() may say yes to what lies just outside, but
// never no to what lies within: then the sides' rounded distance exceeds its error bound.
class Band {
 public:
  static constexpr double kRoom = 1.0 + 0x1p-10;  // more than all roundings of a reach make

  Band(Point a, Point b, double reach) : a_(a), dx_(b.x - a.x), dy_(b.y - a.y) {
    box_.include(a);
    box_.include(b);
    const double wide_reach = kRoom * reach;
    box_ = box_.grown_by(wide_reach);
    half_width_ = wide_reach * (std::fabs(dx_) + std::fabs(dy_));
  }

  bool meets(const Box& box) const { return box_.meets(box) && reaches(box); }

 private:
  static constexpr double kErrorBound = 0x1p-48;  // a few roundings of each term

  // Whether the box has corners on both sides of the line, or one within reach of it.
  bool reaches(const Box& box) const {
    const double west = box.west - a_.x, east = box.east - a_.x;
    const double south = box.south - a_.y, north = box.north - a_.y;
    const double x = 0.5 * (west + east), half_x = 0.5 * (east - west);
    const double y = 0.5 * (south + north), half_y = 0.5 * (north - south);
    const double across = std::fabs(dx_ * y - dy_ * x);
    const double spread = std::fabs(dx_) * half_y + std::fabs(dy_) * half_x + half_width_;
    const double terms = std::fabs(dx_ * y) + std::fabs(dy_ * x) + spread;
    return across <= spread + kErrorBound * terms;
  }

  Point a_;
  double dx_, dy_;
  double half_width_;  // reach times the segment's length, or more
  Box box_;
};

// visit(item) for every item by the team's parts, in blocks that each part fetches.
template <typename Visit>
void visit_in_blocks(std::int32_t count, Team& team, Visit&& visit) {
  constexpr std::int64_t kBlock = 128;  // small enough for even shares of uneven work
  std::atomic<std::int64_t> next{0};
  team.run([&](int part) {
    for (;;) {
      const std::int64_t begin = next.fetch_add(kBlock);
      if (begin >= count || !team.keeps_going(part)) return;
      const std::int64_t end = std::min<std::int64_t>(begin + kBlock, count);
      for (std::int64_t i = begin; i < end; ++i) visit(part, static_cast<std::int32_t>(i));
    }
  });
}

// What the parts found, as one sorted list.
template <typename Pair>
std::vector<Pair> sorted_together(std::vector<std::vector<Pair>>& found) {
  std::vector<Pair> all = std::move(found[0]);
  for (std::size_t part = 1; part < found.size(); ++part) {
    all.insert(all.end(), found[part].begin(), found[part].end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace tinsmith
