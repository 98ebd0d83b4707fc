// Whether growth is worth its cost, by a sample of the vertices: even data need about 1 unit of
// work a point in their searches, rasters 5, clusters 18, contour lines 100; from 12 on insertion is
// quicker. To begin with growth and give it up late costs more than either.
//
// The sample are short ranges of the sweep, each grown as a thread grows its own (growth.hpp): more
// than twice the work of a long one, as its first triangles have no neighbours yet.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../index/grid.hpp"
#include "growth.hpp"
#include "triangle_store.hpp"

namespace tinsmith {

template <typename Near>
class GrowthSample {
 public:
  // `hull` counter-clockwise.
  GrowthSample(const PointGrid& grid, const std::vector<Vertex>& hull) : grid_(grid), hull_(hull) {}

  // False if insertion is likely to be quicker; true where there are too few points to tell.
  bool is_cheap() const {
    const std::int32_t ranges = std::min(kRanges, grid_.count() / kPointsPerRange);
    if (ranges < kFewestRanges) return true;
    const std::int64_t allowed = std::int64_t{kMostWork} * kVertices * ranges;
    std::int64_t work = 0;
    for (std::int32_t i = 0; i < ranges && work <= allowed; ++i) {
      work += work_of(range_at(part_of(grid_.count(), i, ranges)), allowed - work);
    }
    return work <= allowed;
  }

 private:
  static constexpr std::int32_t kRanges = 16, kFewestRanges = 4;
  static constexpr std::int32_t kPointsPerRange = 2048;
  static constexpr std::int32_t kVertices = 32;  // of a range
  // A vertex. Of a million points uniform ones took 4, rasters 9, those with a dense corner 10,
  // hills of contours 36, one hill 52, clusters 54, survey tracks 118.
  static constexpr std::int32_t kMostWork = 20;

  // In the middle of a part. In a nested grid the first vertices: behind others of the same grid
  // each search would go over the whole index.
  Range range_at(Range part) const {
    std::int32_t begin = part.begin + part.size() / 2;
    const Level& level = PointGrid::LevelCursor(grid_, begin).at(begin);
    if (&level != &grid_.top()) begin = level.begin;
    return {begin, std::min(begin + kVertices, grid_.count())};
  }

  // More than `allowed` if the searches of the range are given up.
  std::int64_t work_of(Range range, std::int64_t allowed) const {
    TriangleStore made(std::int64_t{8} * range.size());
    Growth<Near> growth(grid_, hull_, range, made);
    return growth.is_grown_within(allowed) ? growth.counts().work() : allowed + 1;
  }

  const PointGrid& grid_;
  const std::vector<Vertex>& hull_;
};

}  // namespace tinsmith
