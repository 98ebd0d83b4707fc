// Bindings of what products share.
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/base/range.hpp"
#include "../../../tin/cpp/python/conversion.hpp"
#include "../surface/components.hpp"

namespace tinsmith::python {

using GivenPlaces = Given<std::int64_t, -1>;

// Of triangles, by their neighbours.
inline Offsets number_components(const GivenTriples& neighbors) {
  const std::int32_t count = row_count(neighbors.shape(0), kMostTriangles);
  if (!are_all(neighbors, [=](std::int32_t t) { return -1 <= t && t < count; })) {
    throw std::invalid_argument("neighbors must be triangles or -1");
  }
  auto roots = streamed_array<std::int64_t>(neighbors.shape(0));
  {
    ReleasedLock release;
    Components components(count);
    for (std::int32_t i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) {
        const std::int32_t across = neighbors.data()[std::size_t{3} * i + k];
        if (across > i) components.join(i, across);
      }
    }
    components.write(roots.get());
  }
  return hand_over<Offsets>(std::move(roots), {neighbors.shape(0)});
}

// Of so many numbers, by pairs of them.
inline Offsets join_components(std::int32_t count, const GivenPlaces& one,
                               const GivenPlaces& other) {
  const auto is_sound = [=](std::int64_t i) { return 0 <= i && i < count; };
  if (count < 0 || one.shape(0) != other.shape(0) || !are_all(one, is_sound) ||
      !are_all(other, is_sound)) {
    throw std::invalid_argument("pairs must be of numbers from 0 to count - 1");
  }
  auto roots = streamed_array<std::int64_t>(static_cast<std::size_t>(count));
  {
    ReleasedLock release;
    Components components(count);
    for (std::size_t i = 0; i < one.shape(0); ++i) {
      components.join(static_cast<std::int32_t>(one.data()[i]),
                      static_cast<std::int32_t>(other.data()[i]));
    }
    components.write(roots.get());
  }
  return hand_over<Offsets>(std::move(roots), {static_cast<std::size_t>(count)});
}

// Twice the signed areas of triangles in the plane, of points with two columns or more.
inline Elevations double_areas(const GivenRows& points, const GivenTriples& triangles,
                               int threads) {
  const std::size_t columns = points.shape(1);
  if (columns < 2) throw std::invalid_argument("points must have two columns at least");
  const Surface surface = corners_of(triangles, row_count(points.shape(0)));
  auto areas = streamed_array<double>(triangles.shape(0));
  run_unlocked(threads, [&](Team& team) {
    team.run([&](int part) {
      Pulse pulse(team, part);
      const Range range = part_of(surface.triangle_count, part, team.size());
      for (std::int32_t i = range.begin; i < range.end && pulse.goes_on(); ++i) {
        const double* row[3];
        for (std::uint32_t k = 0; k < 3; ++k) {
          const auto v = static_cast<std::size_t>(number(surface.vertex(triangle_numbered(i), k)));
          row[k] = points.data() + columns * v;
        }
        const double ux = row[1][0] - row[0][0], uy = row[1][1] - row[0][1];
        const double vx = row[2][0] - row[0][0], vy = row[2][1] - row[0][1];
        areas[i] = ux * vy - uy * vx;
      }
    });
  });
  return hand_over<Elevations>(std::move(areas), {triangles.shape(0)});
}

inline void bind_surface(nb::module_& m) {
  m.def("number_components", &number_components, "neighbors"_a.noconvert(),
        "The smallest triangle that each is connected to.");
  m.def("double_areas", &double_areas, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "threads"_a = 1, "Twice the signed areas of triangles in the plane.");
  m.def("join_components", &join_components, "count"_a, "one"_a.noconvert(), "other"_a.noconvert(),
        "The smallest of so many numbers that each is connected to, by pairs of them.");
}

}  // namespace tinsmith::python
