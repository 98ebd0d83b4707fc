// How far one surface lies above another at the corners of their overlay: exactly 0 where they
// meet, of the exact sign elsewhere, and good to some ten digits of the elevations' range.
//
// Each is a sum of three weighted elevations, an orientation in space; where it nearly cancels it
// is summed as an expansion.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "facet.hpp"

namespace tinsmith::earthwork {

namespace detail {

constexpr double kKeptOfSum = 0x1p-20;

inline Expansion<16> exact_area(Point a, Point b, Point c) {
  return tinsmith::detail::exact_twice_area(a, b, c);
}

// weight[0] * rise[0] + ..., where `exact` gives each weight as an expansion.
template <typename ExactWeight>
double weighted_sum(const double (&weight)[3], const double (&elevation)[3], double datum,
                    ExactWeight&& exact) {
  double sum = 0.0, size = 0.0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const double term = weight[k] * (elevation[k] - datum);
    sum += term;
    size += std::fabs(term);
  }
  if (size == 0.0 || std::fabs(sum) > kKeptOfSum * size) return sum;
  const auto term = [&](std::uint32_t k) {
    return exact(k) * expand(exact_difference(elevation[k], datum));
  };
  return (term(0) + term(1) + term(2)).value();
}

}  // namespace detail

// Of a segment above a point on it, from both sides of an edge the same.
inline double height_of_segment(const Facet& facet, std::uint32_t edge, Point p, double elevation) {
  std::uint32_t from = corner_after(edge), to = corner_before(edge);
  if (lexicographically_before(facet.corner[to], facet.corner[from])) std::swap(from, to);
  const Point start = facet.corner[from], end = facet.corner[to];
  const bool is_steep = std::fabs(end.y - start.y) > std::fabs(end.x - start.x);
  const TwoDoubles before =
      is_steep ? exact_difference(p.y, start.y) : exact_difference(p.x, start.x);
  const TwoDoubles behind = is_steep ? exact_difference(end.y, p.y) : exact_difference(end.x, p.x);
  const double at_start = behind.high * (facet.elevation[from] - elevation);
  const double at_end = before.high * (facet.elevation[to] - elevation);
  const double total = before.high + behind.high;
  const double sum = at_start + at_end;
  if (std::fabs(sum) > detail::kKeptOfSum * (std::fabs(at_start) + std::fabs(at_end))) {
    return sum / total;
  }
  const auto exact = expand(behind) * expand(exact_difference(facet.elevation[from], elevation)) +
                     expand(before) * expand(exact_difference(facet.elevation[to], elevation));
  return exact.value() / total;
}

// Of the plane of a facet above a point that it holds: `weight` has the point's twice areas with
// the edges of the facet.
inline double height_of_plane(const Facet& facet, Point p, double elevation,
                              const double (&weight)[3]) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (weight[corner_after(k)] == 0.0 && weight[corner_before(k)] == 0.0) {
      return facet.elevation[k] - elevation;  // the point is a corner of the facet
    }
  }
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (weight[k] == 0.0) return height_of_segment(facet, k, p, elevation);
  }
  const double total = weight[0] + weight[1] + weight[2];
  const double sum = detail::weighted_sum(weight, facet.elevation, elevation, [&](std::uint32_t k) {
    return detail::exact_area(facet.start(k), facet.end(k), p);
  });
  return sum / total;
}

// An edge with the twice areas of its ends and an edge that it crosses: of opposite signs.
struct CrossingEdge {
  Point start, end;
  double start_elevation, end_elevation;
  double start_area, end_area;
};

// Both edges from the end that comes first by easting, then northing: areas of the ends of one
// change their signs with the direction of the other.
inline void direct(CrossingEdge& edge, CrossingEdge& other) {
  if (lexicographically_before(edge.start, edge.end)) return;
  std::swap(edge.start, edge.end);
  std::swap(edge.start_elevation, edge.end_elevation);
  std::swap(edge.start_area, edge.end_area);
  other.start_area = -other.start_area;
  other.end_area = -other.end_area;
}

// Of the second edge above the first where they cross; the same whichever way edges are directed,
// and the opposite if they are exchanged.
inline double height_at_crossing(CrossingEdge first, CrossingEdge second) {
  direct(first, second);
  direct(second, first);
  if (lexicographically_before(second.start, first.start)) {
    return -height_at_crossing(second, first);
  }
  const double datum = first.start_elevation;
  const double weight[3] = {second.end_area, -second.start_area, -first.start_area};
  const double elevation[3] = {second.start_elevation, second.end_elevation, first.end_elevation};
  const double sum = detail::weighted_sum(weight, elevation, datum, [&](std::uint32_t k) {
    if (k == 0) return detail::exact_area(first.start, first.end, second.end);
    if (k == 1) return -detail::exact_area(first.start, first.end, second.start);
    return -detail::exact_area(second.start, second.end, first.start);
  });
  return sum / (first.start_area - first.end_area);
}

}  // namespace tinsmith::earthwork
