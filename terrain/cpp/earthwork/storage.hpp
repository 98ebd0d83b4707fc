// How much lies under levels: area, wetted surface and volume between a surface and each level.
//
// A triangle that a level cuts is integrated in closed form; one wholly under it counts from then on
// by its area alone: from a level to the next the volume grows by the area times the step. Nothing
// is ever subtracted.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "../../../tin/cpp/base/pulse.hpp"
#include "facet.hpp"
#include "sums.hpp"
#include "volumes.hpp"

namespace tinsmith::earthwork {

class Storage {
 public:
  using Row = std::array<double, 3>;  // area in the plane, in space, volume

  // `levels` ascend; `up` converts elevations to the unit of the plane for areas in space.
  Storage(const Surface& surface, const double* levels, std::int32_t count, double up, Team& team)
      : levels_(levels, levels + count), cut_(count), drowned_(count) {
    Pulse pulse(team);
    for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
      if (!pulse.goes_on()) return;
      add(Facet::of(surface, t), up, pulse);
    }
  }

  std::vector<Row> rows() const {
    std::vector<Row> rows;
    Triple under;  // the triangles wholly under the level
    for (std::size_t k = 0; k < levels_.size(); ++k) {
      if (k > 0) under[2].add(under[0].value() * (levels_[k] - levels_[k - 1]));
      Row row;
      for (int i = 0; i < 3; ++i) {
        under[i].add(drowned_[k][i]);
        ExactSum all = under[i];
        all.add(cut_[k][i]);
        row[i] = all.value();
      }
      rows.push_back(row);
    }
    return rows;
  }

 private:
  using Triple = std::array<ExactSum, 3>;

  void add(const Facet& facet, double up, Pulse& pulse) {
    const double area = 0.5 * twice_area(facet.corner[0], facet.corner[1], facet.corner[2]);
    const double slope = steepness(facet, up);
    const double* z = facet.elevation;
    const auto [lowest, highest] = std::minmax({z[0], z[1], z[2]});
    auto level = std::upper_bound(levels_.begin(), levels_.end(), lowest);
    for (; level != levels_.end() && *level < highest && pulse.goes_on(); ++level) {
      const Part part = positive_part(*level - z[0], *level - z[1], *level - z[2]);
      add(cut_[level - levels_.begin()], area * part.area, slope, area * part.volume);
    }
    if (level == levels_.end()) return;
    const double depth = ((*level - z[0]) + (*level - z[1]) + (*level - z[2])) / 3.0;
    add(drowned_[level - levels_.begin()], area, slope, area * depth);
  }

  static void add(Triple& sums, double area, double slope, double volume) {
    sums[0].add(area);
    sums[1].add(area * slope);
    sums[2].add(volume);
  }

  std::vector<double> levels_;
  std::vector<Triple> cut_;      // triangles that the level cuts
  std::vector<Triple> drowned_;  // triangles wholly under it, but not under the one before
};

}  // namespace tinsmith::earthwork
