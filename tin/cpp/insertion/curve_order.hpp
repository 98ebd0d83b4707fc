// The points in the order of insertion's numbers: parts of the plane, one after the other, and in
// each of them along one curve.
//
// Parts are strips across the longer side of the points' box, of about equally many points. No two
// parts have points at one coordinate along that side, so that lines lie between their hulls.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../base/point.hpp"
#include "../base/range.hpp"
#include "../index/grid.hpp"
#include "../index/hilbert_order.hpp"
#include "../predicates/predicates.hpp"
#include "ghost_mesh.hpp"

namespace tinsmith {

class CurveOrder {
 public:
  // One part a thread of the team, or fewer.
  CurveOrder(const PointGrid& grid, Team& team)
      : sweep_of(grid.count()), points(grid.count()), grid_(grid), team_(team) {}

  WithGhost<Vertex> sweep_of;
  WithGhost<Point> points;

  // Returns false if the team is stopped.
  bool put_in_order() {
    constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
    points[kGhost] = {kNotANumber, kNotANumber};
    sweep_of[kGhost] = kGhost;
    find_cuts();
    const ScratchArray<std::int32_t> dealt = deal();
    join_flat_parts(dealt.get());
    if (!team_.keeps_going(0)) return false;
    team_.run([&](int member) {
      for (std::size_t part = member; part < parts_.size(); part += team_.size()) {
        order_part(parts_[part], dealt.get() + parts_[part].begin);
      }
    });
    return !team_.is_stopped();
  }

  // None of them is collinear; there is none if all points are.
  const std::vector<Range>& parts() const { return parts_; }

  // Along the side that parts divide.
  double coordinate(Point p) const { return is_by_northing_ ? p.y : p.x; }

 private:
  static constexpr std::int32_t kLeastInPart = 8;
  static constexpr std::int32_t kSampleOfPart = 256;

  const PointGrid& grid_;
  Team& team_;
  bool is_by_northing_ = false;
  std::vector<double> cuts_;  // a part begins at each, but for the first
  std::vector<Range> parts_;

  void find_cuts() {
    const std::int32_t count = grid_.count();
    const std::int32_t parts = std::min(team_.size(), count / kLeastInPart);
    if (parts < 2) return;
    const Box box = grid_.top().box;
    is_by_northing_ = box.height() > box.width();
    std::vector<double> sample;
    const std::int32_t size = std::min(count, parts * kSampleOfPart);
    for (std::int32_t i = 0; i < size; ++i) {
      sample.push_back(coordinate(grid_.point(Vertex{part_of(count, i, size).begin})));
    }
    std::sort(sample.begin(), sample.end());
    for (int part = 1; part < parts; ++part)
      cuts_.push_back(sample[part_of(size, part, parts).begin]);
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
  }

  std::size_t part_at(std::int32_t position) const {
    const double at = coordinate(grid_.point(Vertex{position}));
    std::size_t part = 0;
    for (const double cut : cuts_) part += at >= cut;
    return part;
  }

  // Positions in the sweep, part by part.
  ScratchArray<std::int32_t> deal() {
    const std::int32_t count = grid_.count();
    ScratchArray<std::int32_t> dealt = scratch_array<std::int32_t>(count);
    const std::size_t parts = cuts_.size() + 1;
    std::vector<std::vector<std::int32_t>> at(team_.size(), std::vector<std::int32_t>(parts));
    team_.run([&](int member) {
      std::vector<std::int32_t> counts(parts);
      const Range own = part_of(count, member, team_.size());
      for (std::int32_t i = own.begin; i < own.end; ++i) ++counts[part_at(i)];
      at[member] = counts;
    });
    std::int32_t total = 0;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::int32_t begin = total;
      for (std::vector<std::int32_t>& counts : at) total += std::exchange(counts[part], total);
      if (total > begin) parts_.push_back({begin, total});
    }
    team_.run([&](int member) {
      std::vector<std::int32_t> next = at[member];
      const Range own = part_of(count, member, team_.size());
      for (std::int32_t i = own.begin; i < own.end; ++i) dealt[next[part_at(i)]++] = i;
    });
    return dealt;
  }

  // A part of points in line has no triangles: it goes with the one after it, or before it.
  void join_flat_parts(const std::int32_t* dealt) {
    std::vector<Range> joined;
    std::int32_t begin = 0;
    for (const Range part : parts_) {
      if (is_flat({begin, part.end}, dealt)) continue;
      joined.push_back({begin, part.end});
      begin = part.end;
    }
    if (!joined.empty()) joined.back().end = grid_.count();
    parts_ = joined;
  }

  bool is_flat(Range range, const std::int32_t* dealt) const {
    const auto point = [&](std::int32_t i) { return grid_.point(Vertex{dealt[i]}); };
    const Point first = point(range.begin), last = point(range.end - 1);
    for (std::int32_t i = range.begin + 1; i < range.end - 1; ++i) {
      if (orientation(first, last, point(i)) != 0) return false;
    }
    return true;
  }

  void order_part(Range part, const std::int32_t* dealt) {
    const auto point = [&](std::int32_t i) { return grid_.point(Vertex{dealt[i]}); };
    const HilbertOrder order(part.size(), point);
    for (std::int32_t i = 0; i < part.size(); ++i) {
      const Vertex sweep{dealt[order[i]]}, v{part.begin + i};
      sweep_of[v] = sweep;
      points[v] = grid_.point(sweep);
    }
  }
};

}  // namespace tinsmith
