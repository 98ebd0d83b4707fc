// Bindings for segments and polygons: where they meet, what lies on them and in them.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../constraints/contacts.hpp"
#include "../constraints/point_in_polygon.hpp"
#include "../constraints/touches.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

inline void require_numbers(const GivenPairs& pairs, std::int32_t limit) {
  if (are_all(pairs, [limit](std::int32_t i) { return i >= 0 && i < limit; })) return;
  throw std::invalid_argument("every number must be that of an existing row");
}

inline Segments segments_of(const GivenXy& xy, const GivenPairs& segments) {
  const Point* points = exact_points_of(xy);
  require_numbers(segments, row_count(xy.shape(0)));
  return {points, segments.data(), row_count(segments.shape(0))};
}

inline void require_first(std::int32_t first) {
  if (first < 0) throw std::invalid_argument("the first number must be 0 or more");
}

inline void require_distance(double distance) {
  if (distance >= 0.0 && distance <= kLargestCoordinate) return;
  throw std::invalid_argument("the distance must be finite and 0 or more");
}

// Crossings or touches.
template <typename Pair>
Pairs hand_over_pairs(const std::vector<Pair>& pairs) {
  return copy_over<Pairs, std::int32_t>(pairs, {pairs.size(), 2});
}

inline Pairs crossings(const GivenXy& xy, const GivenPairs& segments, std::int32_t first_new,
                       int threads) {
  require_first(first_new);
  const Segments given = segments_of(xy, segments);
  return hand_over_pairs(unlocked(
      threads, [&](Team& team) { return find_crossings(given, Segment{first_new}, team); }));
}

inline Pairs touches(const GivenXy& xy, const GivenPairs& segments, double distance,
                     std::int32_t first_vertex, bool is_rounded, int threads) {
  require_distance(distance);
  require_first(first_vertex);
  const Segments given = segments_of(xy, segments);
  const std::int32_t count = row_count(xy.shape(0));
  return hand_over_pairs(unlocked(threads, [&](Team& team) {
    const auto is_asked = [](Vertex) { return true; };
    return TouchSearch(given, {distance, is_rounded})
        .run(Vertex{std::min(first_vertex, count)}, count, is_asked, team);
  }));
}

inline auto contacts(const GivenXy& xy, const GivenPairs& segments, double distance, int threads) {
  require_distance(distance);
  const Segments given = segments_of(xy, segments);
  const std::int32_t count = row_count(xy.shape(0));
  const ContactSearch found =
      unlocked(threads, [&](Team& team) { return ContactSearch(given, count, distance, team); });
  return std::make_tuple(hand_over_pairs(found.crossings), hand_over_pairs(found.touches));
}

inline Xy intersections(const GivenXy& xy, const GivenPairs& segments, const GivenPairs& pairs) {
  const Segments given = segments_of(xy, segments);
  require_numbers(pairs, given.count);
  const std::int32_t count = row_count(pairs.shape(0));
  const auto found =
      unlocked(1, [&](Team& team) { return find_intersections(given, pairs.data(), count, team); });
  return copy_over<Xy, double>(found, {pairs.shape(0), 2});
}

inline Numbers numbers_of_vertices_at(const GivenXy& xy, const GivenXy& queries) {
  const Point* vertices = exact_points_of(xy);
  const Point* sought = exact_points_of(queries);
  return hand_over(
      vertices_at(vertices, row_count(xy.shape(0)), sought, row_count(queries.shape(0))));
}

inline Signs points_in_polygons(const GivenXy& xy, const GivenXy& ring_xy,
                                const GivenNumbers& offsets, int threads) {
  const Point* queries = exact_points_of(xy);
  const Point* corners = exact_points_of(ring_xy);
  const std::size_t bounds = offsets.shape(0);
  const std::int32_t* offset = offsets.data();
  if (bounds == 0 || offset[0] != 0 || !std::is_sorted(offset, offset + bounds) ||
      offset[bounds - 1] != row_count(ring_xy.shape(0))) {
    throw std::invalid_argument("offsets must grow from 0 to the number of corners");
  }
  const std::int32_t count = row_count(xy.shape(0));
  auto sides = unlocked(threads, [&](Team& team) {
    auto result = streamed_array<std::int8_t>(count);
    const PointInPolygon rings(corners, offset, row_count(bounds - 1));
    rings.locate(queries, count, result.get(), team);
    return result;
  });
  return hand_over<Signs>(std::move(sides), {static_cast<std::size_t>(count)});
}

inline void bind_constraints(nb::module_& m) {
  m.def("crossings", &crossings, "xy"_a.noconvert(), "segments"_a.noconvert(), "first_new"_a = 0,
        "threads"_a = 1, "Pairs i < j of segments that cross, sorted; j is first_new or more.");
  m.def("touches", &touches, "xy"_a.noconvert(), "segments"_a.noconvert(), "distance"_a = 0.0,
        "first_vertex"_a = 0, "is_rounded"_a = false, "threads"_a = 1,
        "Pairs (segment, vertex), sorted, where the vertex, first_vertex or later, lies inside the "
        "segment or, further than the distance from both ends, within the distance of it; "
        "is_rounded: at least a unit in the last place.");
  m.def("contacts", &contacts, "xy"_a.noconvert(), "segments"_a.noconvert(), "distance"_a = 0.0,
        "threads"_a = 1, "The crossings and the touches of all, found together.");
  m.def("intersections", &intersections, "xy"_a.noconvert(), "segments"_a.noconvert(),
        "pairs"_a.noconvert(), "Where the segments of each pair cross, rounded once.");
  m.def("vertices_at", &numbers_of_vertices_at, "xy"_a.noconvert(), "queries"_a.noconvert(),
        "The first vertex at each point, -1 where there is none.");
  m.def("points_in_polygons", &points_in_polygons, "xy"_a.noconvert(), "ring_xy"_a.noconvert(),
        "offsets"_a.noconvert(), "threads"_a = 1,
        "+1 in an odd number of the rings, -1 outside, 0 on a ring.");
}

}  // namespace tinsmith::python
