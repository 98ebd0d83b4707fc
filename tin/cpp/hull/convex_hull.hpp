// Convex hull, exact, with the points that lie on its edges kept.
//
// The monotone chain of Andrew, "Another efficient algorithm for convex hulls in two dimensions"
// (1979), of the points outside a polygon of extreme ones (Akl and Toussaint, "A fast convex hull
// algorithm", 1978).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../index/grid.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// Finds the hull among few points: those inside a polygon of extreme points are left out first.
class HullFinder {
 public:
  HullFinder(const PointGrid& grid, Team& team) : grid_(grid), team_(team) {}

  // Counter-clockwise vertices; empty if all points are collinear.
  std::vector<Vertex> find() {
    find_extremes();
    collect_candidates();
    return hull_of(grid_, std::move(candidates_));
  }

  // Whether the points seem to lie on one convex curve, where every search sees them all: of an even
  // sample more than a quarter is on its hull.
  static bool is_of_curve(const PointGrid& grid) {
    const std::int32_t size = std::min(grid.count(), kSample);
    std::vector<Vertex> sample;
    for (std::int32_t i = 0; i < size; ++i) {
      sample.push_back(Vertex{part_of(grid.count(), i, size).begin});
    }
    return hull_of(grid, std::move(sample)).size() > static_cast<std::size_t>(size / 4);
  }

 private:
  static constexpr std::int32_t kSample = 1024;

  static std::vector<Vertex> hull_of(const PointGrid& grid, std::vector<Vertex> points) {
    std::sort(points.begin(), points.end(), [&](Vertex a, Vertex b) {
      return lexicographically_before(grid.point(a), grid.point(b));
    });
    const std::vector<Vertex> lower = chain(grid, points);
    std::reverse(points.begin(), points.end());
    const std::vector<Vertex> upper = chain(grid, points);
    const bool is_flat = upper.size() < 2 || lower[1] == upper[upper.size() - 2];
    if (is_flat) return {};
    std::vector<Vertex> hull(lower.begin(), lower.end() - 1);
    hull.insert(hull.end(), upper.begin(), upper.end() - 1);
    return hull;
  }

  // Extreme points counter-clockwise from the west: W, SW, S, SE, E, NE, N, NW.
  struct Extremes {
    std::array<double, 8> reach;
    std::array<Point, 8> point;

    void offer(Point p) {
      const double towards[8] = {-p.x, -p.x - p.y, -p.y, p.x - p.y, p.x, p.x + p.y, p.y, p.y - p.x};
      for (int k = 0; k < 8; ++k) {
        if (towards[k] > reach[k]) {
          reach[k] = towards[k];
          point[k] = p;
        }
      }
    }
  };

  void find_extremes() {
    std::vector<Extremes> found(team_.size());
    team_.run([&](int part) {
      Extremes extremes;
      extremes.reach.fill(-HUGE_VAL);
      const Range range = part_of(grid_.count(), part, team_.size());
      for (std::int32_t i = range.begin; i < range.end; ++i) {
        extremes.offer(grid_.point(static_cast<Vertex>(i)));
      }
      found[part] = extremes;
    });
    Extremes all = found[0];
    for (const Extremes& extremes : found) {
      for (int k = 0; k < 8; ++k) {
        if (extremes.reach[k] > -HUGE_VAL) all.offer(extremes.point[k]);
      }
    }
    extreme_ = all.point;
  }

  void collect_candidates() {
    std::vector<std::vector<Vertex>> found(team_.size());
    team_.run(
        [&](int part) { found[part] = candidates_in(part_of(grid_.count(), part, team_.size())); });
    for (const auto& part : found) {
      candidates_.insert(candidates_.end(), part.begin(), part.end());
    }
  }

  std::vector<Vertex> candidates_in(Range range) const {
    // The box between the diagonal extremes lies inside their quadrilateral: its south side is
    // above both SW and SE, and so on. No arithmetic, so no rounding.
    const Point sw = extreme_[1], se = extreme_[3], ne = extreme_[5], nw = extreme_[7];
    const double west = std::max(sw.x, nw.x), east = std::min(se.x, ne.x);
    const double south = std::max(sw.y, se.y), north = std::min(nw.y, ne.y);
    std::vector<Vertex> candidates;
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      const Point p = grid_.point(static_cast<Vertex>(i));
      if (p.x > west && p.x < east && p.y > south && p.y < north) continue;
      if (!is_surely_inside(p)) candidates.push_back(static_cast<Vertex>(i));
    }
    return candidates;
  }

  bool is_surely_inside(Point p) const {
    for (int k = 0; k < 8; ++k) {
      const Point a = extreme_[k], b = extreme_[(k + 1) % 8];
      if (a == b) continue;
      const double left = (a.x - p.x) * (b.y - p.y);
      const double right = (a.y - p.y) * (b.x - p.x);
      const double bound = detail::kOrientationBound * (std::fabs(left) + std::fabs(right));
      if (!(left - right > bound)) return false;
    }
    return true;
  }

  // Andrew's monotone chain: pop only at right turns, so that collinear points stay.
  static std::vector<Vertex> chain(const PointGrid& grid, const std::vector<Vertex>& sorted) {
    std::vector<Vertex> kept;
    for (Vertex v : sorted) {
      while (kept.size() >= 2 && orientation(grid.point(kept[kept.size() - 2]),
                                             grid.point(kept.back()), grid.point(v)) < 0) {
        kept.pop_back();
      }
      kept.push_back(v);
    }
    return kept;
  }

  const PointGrid& grid_;
  Team& team_;
  std::array<Point, 8> extreme_;
  std::vector<Vertex> candidates_;
};

}  // namespace tinsmith
