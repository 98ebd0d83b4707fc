// Samples of the triangles of a surface: from the one nearest a point the walk to it is short.
//
// In canonical order (insertion/canonical_order.hpp) triangles follow each other along rows of
// cells, from west to east, each with its first vertex in front. So between two samples of a row
// the easting tells about where a triangle is. Triangles in any other order only make longer walks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "given_triangles.hpp"

namespace tinsmith {

class TriangleSamples {
 public:
  bool are_set() const { return stride_ > 0; }

  void set(const PointRows& rows, const GivenTriangles& given) {
    stride_ = std::max(1, static_cast<std::int32_t>(std::sqrt(given.count) / kOfRoot));
    samples_.clear();
    for (std::int32_t t = 0; t < given.count; t += stride_) {
      samples_.push_back(first_point(rows, given, t));
    }
  }

  // A triangle that may be near p.
  Triangle near(const PointRows& rows, const GivenTriangles& given, Point p) const {
    const std::size_t nearest = nearest_sample(p);
    const auto at = static_cast<std::int32_t>(nearest) * stride_;
    const double per_length = stride_ / gap_at(nearest);
    Guess best{at, samples_[nearest]};
    for (int i = 0; i < 2; ++i) {
      const double step = (p.x - best.first.x) * per_length;
      if (!(std::abs(step) < 2 * stride_)) break;
      const std::int32_t there = best.triangle + static_cast<std::int32_t>(step);
      if (there < 0 || there >= given.count) break;
      const Guess guess{there, first_point(rows, given, there)};
      if (square(guess.first, p) >= square(best.first, p)) break;
      best = guess;
    }
    return triangle_numbered(best.triangle);
  }

 private:
  // Times the root of the number of triangles: four in each row of cells of a square.
  static constexpr double kOfRoot = 2.0;

  struct Guess {
    std::int32_t triangle;
    Point first;
  };

  static Point first_point(const PointRows& rows, const GivenTriangles& given, std::int32_t t) {
    return rows[given.corners[entry_of(triangle_numbered(t), 0)]];
  }

  static double square(Point p, Point q) {
    const double dx = q.x - p.x, dy = q.y - p.y;
    return dx * dx + dy * dy;
  }

  // Eastward between samples of a row: from the nearer one of both beside it, which may be of
  // another row.
  double gap_at(std::size_t i) const {
    double gap = INFINITY;
    if (i > 0) gap = std::abs(samples_[i].x - samples_[i - 1].x);
    if (i + 1 < samples_.size()) gap = std::min(gap, std::abs(samples_[i + 1].x - samples_[i].x));
    return gap;
  }

  // Northings ascend from row to row: of the rows about that of p, which halving finds.
  std::size_t nearest_sample(Point p) const {
    const auto above = std::lower_bound(samples_.begin(), samples_.end(), p.y,
                                        [](Point sample, double y) { return sample.y < y; });
    const auto middle = static_cast<std::size_t>(above - samples_.begin());
    const std::size_t begin = middle > kAbout ? middle - kAbout : 0;
    const std::size_t end = std::min(samples_.size(), middle + kAbout);
    // A cell has four triangles, so samples of a row are a quarter of a stride of rows apart.
    const double per_row = 2.0 / stride_;
    std::size_t nearest = begin;
    double least = INFINITY;
    for (std::size_t i = begin; i < end; ++i) {
      const double dx = per_row * (samples_[i].x - p.x), dy = samples_[i].y - p.y;
      const double distance = dx * dx + dy * dy;
      if (distance >= least) continue;
      least = distance;
      nearest = i;
    }
    return nearest;
  }
  static constexpr std::size_t kAbout = 12;  // some rows

  std::int32_t stride_ = 0;
  std::vector<Point> samples_;
};

}  // namespace tinsmith
