// The border to Python for lines: contacts between them, places in rings.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bind_arrays.hpp"
#include "lines/contacts.hpp"
#include "lines/meeting_point.hpp"
#include "lines/ring_places.hpp"
#include "lines/touches.hpp"

namespace tinsmith::python {

using NumberPairs = nb::ndarray<const std::int32_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using NumberList = nb::ndarray<const std::int32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using PairRows = nb::ndarray<nb::numpy, std::int32_t, nb::shape<-1, 2>>;
using PlaceRows = nb::ndarray<nb::numpy, double, nb::shape<-1, 2>>;

inline std::int32_t row_count(std::size_t rows) {
  if (rows > static_cast<std::size_t>(INT32_MAX / 4)) {
    throw std::invalid_argument("more rows than 32-bit indices can number");
  }
  return static_cast<std::int32_t>(rows);
}

// The places, which the predicates can compute with.
inline const Point* sound_places(const Places& xy) {
  const double* end = xy.data() + 2 * static_cast<std::size_t>(row_count(xy.shape(0)));
  const auto is_sound = [](double c) { return std::fabs(c) <= kLargestCoordinate; };
  if (!std::all_of(xy.data(), end, is_sound)) {
    throw std::invalid_argument("every coordinate must be finite and within the exact range");
  }
  return reinterpret_cast<const Point*>(xy.data());
}

inline void require_numbers(const std::int32_t* numbers, std::size_t count, std::int32_t limit) {
  const auto is_sound = [limit](std::int32_t i) { return i >= 0 && i < limit; };
  if (!std::all_of(numbers, numbers + count, is_sound)) {
    throw std::invalid_argument("every number must be that of an existing row");
  }
}

inline Segments sound_segments(const Places& xy, const NumberPairs& segments) {
  const Point* places = sound_places(xy);
  require_numbers(segments.data(), 2 * segments.shape(0), row_count(xy.shape(0)));
  return {places, segments.data(), row_count(segments.shape(0))};
}

inline void require_first(std::int32_t first) {
  if (first < 0) throw std::invalid_argument("the first number must be 0 or more");
}

inline PairRows hand_over(const std::vector<NumberPair>& pairs) {
  auto data = streamed_array<std::int32_t>(2 * pairs.size());
  if (!pairs.empty()) std::memcpy(data.get(), pairs.data(), pairs.size() * sizeof(NumberPair));
  return hand_over<PairRows>(std::move(data), {pairs.size(), 2});
}

// What `search(team)` finds without Python's lock, unless it was stopped.
template <typename Search>
auto unlocked(int threads, Search&& search) {
  if (threads < 1) throw std::invalid_argument("at least one thread is needed");
  bool is_stopped = false;
  auto found = [&] {
    nb::gil_scoped_release release;
    Team team(threads, no_signal);
    auto result = search(team);
    is_stopped = team.is_stopped();
    return result;
  }();
  if (is_stopped) throw nb::python_error();
  return found;
}

inline PairRows crossings(const Places& xy, const NumberPairs& segments, std::int32_t first_new,
                          int threads) {
  require_first(first_new);
  const Segments given = sound_segments(xy, segments);
  return hand_over(unlocked(
      threads, [&](Team& team) { return find_crossings(given, first_new, team); }));
}

inline void require_distance(double distance) {
  if (distance >= 0.0 && distance <= kLargestCoordinate) return;
  throw std::invalid_argument("the distance must be finite and 0 or more");
}

inline PairRows touches(const Places& xy, const NumberPairs& segments, double distance,
                        std::int32_t first_vertex, bool is_rounded, int threads) {
  require_distance(distance);
  require_first(first_vertex);
  const Segments given = sound_segments(xy, segments);
  const std::int32_t count = row_count(xy.shape(0));
  return hand_over(unlocked(threads, [&](Team& team) {
    const auto is_asked = [](std::int32_t) { return true; };
    return TouchSearch(given, {distance, is_rounded})
        .run(std::min(first_vertex, count), count, is_asked, team);
  }));
}

inline auto contacts(const Places& xy, const NumberPairs& segments, double distance, int threads) {
  require_distance(distance);
  const Segments given = sound_segments(xy, segments);
  const std::int32_t count = row_count(xy.shape(0));
  const ContactSearch found = unlocked(
      threads, [&](Team& team) { return ContactSearch(given, count, distance, team); });
  return std::make_tuple(hand_over(found.crossings), hand_over(found.touches));
}

inline PlaceRows intersections(const Places& xy, const NumberPairs& segments,
                               const NumberPairs& pairs) {
  const Segments given = sound_segments(xy, segments);
  require_numbers(pairs.data(), 2 * pairs.shape(0), given.count);
  const std::size_t count = pairs.shape(0);
  auto result = streamed_array<double>(2 * count);
  const auto size = row_count(count);
  const bool all_cross = unlocked(1, [&](Team& team) {
    std::atomic<bool> do_all{true};
    visit_in_blocks(size, team, [&](int, std::int32_t i) {
      const std::int32_t* pair = pairs.data() + 2 * static_cast<std::size_t>(i);
      const Point a = given.place(pair[0], 0), b = given.place(pair[0], 1);
      const Point c = given.place(pair[1], 0), d = given.place(pair[1], 1);
      if (!do_cross(a, b, c, d)) {
        do_all = false;
        return;
      }
      const Point met = meeting_point(a, b, c, d);
      result[2 * static_cast<std::size_t>(i)] = met.x + 0.0;  // no -0.0
      result[2 * static_cast<std::size_t>(i) + 1] = met.y + 0.0;
    });
    return do_all.load();
  });
  if (!all_cross) throw std::invalid_argument("the segments of every pair must cross");
  return hand_over<PlaceRows>(std::move(result), {count, 2});
}

inline Numbers places_of_vertices(const Places& xy, const Places& places) {
  const Point* vertices = sound_places(xy);
  const Point* sought = sound_places(places);
  return hand_over(vertices_at(vertices, row_count(xy.shape(0)), sought,
                               row_count(places.shape(0))));
}

inline Signs places_in_rings(const Places& xy, const Places& ring_xy, const NumberList& offsets,
                             int threads) {
  const Point* places = sound_places(xy);
  const Point* corners = sound_places(ring_xy);
  const std::size_t bounds = offsets.shape(0);
  const std::int32_t* offset = offsets.data();
  if (bounds == 0 || offset[0] != 0 || !std::is_sorted(offset, offset + bounds) ||
      offset[bounds - 1] != row_count(ring_xy.shape(0))) {
    throw std::invalid_argument("offsets must grow from 0 to the number of corners");
  }
  const std::int32_t count = row_count(xy.shape(0));
  auto sides = unlocked(threads, [&](Team& team) {
    auto result = streamed_array<std::int8_t>(count);
    const RingPlaces rings(corners, offset, row_count(bounds - 1));
    rings.locate(places, count, result.get(), team);
    return result;
  });
  return hand_over<Signs>(std::move(sides), {static_cast<std::size_t>(count)});
}

inline void bind_lines(nb::module_& m) {
  m.def("crossings", &crossings, "xy"_a.noconvert(), "segments"_a.noconvert(), "first_new"_a = 0,
        "threads"_a = 1,
        "Pairs i < j of segments that cross, sorted; j is first_new or more.");
  m.def("touches", &touches, "xy"_a.noconvert(), "segments"_a.noconvert(), "distance"_a = 0.0,
        "first_vertex"_a = 0, "is_rounded"_a = false, "threads"_a = 1,
        "Pairs (segment, vertex), sorted, where the vertex, first_vertex or later, lies inside the "
        "segment or, further than the distance from both ends, within the distance of it; "
        "is_rounded: at least a unit in the last place.");
  m.def("contacts", &contacts, "xy"_a.noconvert(), "segments"_a.noconvert(), "distance"_a = 0.0,
        "threads"_a = 1, "The crossings and the touches of all, found together.");
  m.def("intersections", &intersections, "xy"_a.noconvert(), "segments"_a.noconvert(),
        "pairs"_a.noconvert(), "Where the segments of each pair cross, rounded once.");
  m.def("vertices_at", &places_of_vertices, "xy"_a.noconvert(), "places"_a.noconvert(),
        "The first vertex at each place, -1 where there is none.");
  m.def("places_in_rings", &places_in_rings, "xy"_a.noconvert(), "ring_xy"_a.noconvert(),
        "offsets"_a.noconvert(), "threads"_a = 1,
        "+1 in an odd number of the rings, -1 outside, 0 on a ring.");
}

}  // namespace tinsmith::python
