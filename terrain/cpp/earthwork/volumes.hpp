// Cut and fill between two surfaces, or a surface and heights at its vertices, group by group.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "cell.hpp"
#include "facet.hpp"
#include "pairs.hpp"
#include "sums.hpp"

namespace tinsmith::earthwork {

// Area in space of a triangle by its area in the plane; `up` converts elevations.
inline double steepness(const Facet& facet, double up) {
  const Point a = facet.corner[0], b = facet.corner[1], c = facet.corner[2];
  const double doubled = twice_area(a, b, c);
  const double b_rise = (facet.elevation[1] - facet.elevation[0]) * up;
  const double c_rise = (facet.elevation[2] - facet.elevation[0]) * up;
  const double east = (b.y - a.y) * c_rise - (c.y - a.y) * b_rise;
  const double north = (c.x - a.x) * b_rise - (b.x - a.x) * c_rise;
  return std::hypot(1.0, std::hypot(east / doubled, north / doubled));
}

inline double cross(Point p, Point q) { return p.x * q.y - p.y * q.x; }

// A cell in triangles from its first corner: visit(twice the area, the differences).
template <typename Visit>
void fan_out(const Cell& cell, Visit&& visit) {
  const Point apex = cell.place(0);
  const auto from_apex = [&](int i) {
    return Point{cell.place(i).x - apex.x, cell.place(i).y - apex.y};
  };
  for (int i = 1; i + 1 < cell.size(); ++i) {
    // Rounding may turn over a triangle thinner than coordinates can tell.
    const double doubled = std::fmax(cross(from_apex(i), from_apex(i + 1)), 0.0);
    visit(doubled, cell.difference(0), cell.difference(i), cell.difference(i + 1));
  }
}

inline std::vector<Sums> add_up(const std::vector<std::vector<Sums>>& parts) {
  std::vector<Sums> all = parts.front();
  for (std::size_t part = 1; part < parts.size(); ++part) {
    for (std::size_t group = 0; group < all.size(); ++group) all[group].add(parts[part][group]);
  }
  return all;
}

inline std::vector<double> all_steepness(const Surface& surface, double up) {
  std::vector<double> values(surface.triangle_count);
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    values[number(t)] = steepness(Facet::of(surface, t), up);
  }
  return values;
}

// Of the second surface above the first; `groups` has the group of each triangle of the first.
inline std::vector<Sums> sum_between(const Surface& first, const std::int32_t* groups,
                                     std::int32_t group_count, const Surface& second,
                                     bool is_second_apart, double up, Team& team) {
  const Pairs pairs(first, second, is_second_apart);
  const auto steep = all_steepness(first, up), other_steep = all_steepness(second, up);
  std::vector<std::vector<Sums>> parts(team.size(), std::vector<Sums>(group_count));
  pairs.visit(team, [&](int part, const Facet& one, const Facet& other) {
    const bool is_kept = is_measured_along(one, other);
    Cell cell;
    if (!(is_kept ? cell.cut(one, other) : cell.cut(other, one))) return;
    const double sign = is_kept ? 1.0 : -1.0;
    CellSums sums;
    fan_out(cell, [&](double doubled, double u, double v, double w) {
      sums.add(doubled, sign * u, sign * v, sign * w);
    });
    const std::uint32_t t = number(one.triangle), u = number(other.triangle);
    parts[part][groups[t]].add(sums, sums.area * steep[t], sums.area * other_steep[u]);
  });
  return add_up(parts);
}

// Of heights at the vertices, which are linear over each triangle.
inline std::vector<Sums> sum_heights(const Surface& surface, const double* heights,
                                     const std::int32_t* groups, std::int32_t group_count,
                                     double up, Team& team) {
  std::vector<Sums> sums(group_count);
  Pulse pulse(team);
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    if (!pulse.goes_on()) break;
    const Facet facet = Facet::of(surface, t);
    const double doubled = twice_area(facet.corner[0], facet.corner[1], facet.corner[2]);
    const auto height = [&](int k) { return heights[number(facet.vertex[k])]; };
    CellSums own;
    own.add(doubled, height(0), height(1), height(2));
    sums[groups[number(t)]].add(own, own.area * steepness(facet, up), own.area);
  }
  return sums;
}

// Areas in the plane.
inline std::vector<ExactSum> sum_areas(const Surface& surface, const std::int32_t* groups,
                                       std::int32_t group_count) {
  std::vector<ExactSum> sums(group_count);
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    const Facet facet = Facet::of(surface, t);
    sums[groups[number(t)]].add(0.5 *
                                twice_area(facet.corner[0], facet.corner[1], facet.corner[2]));
  }
  return sums;
}

}  // namespace tinsmith::earthwork
