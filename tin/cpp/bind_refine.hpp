// The border to Python for refinement.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "bind_arrays.hpp"
#include "bind_mesh.hpp"
#include "refinement/refiner.hpp"

namespace tinsmith::python {

using Places2 = nb::ndarray<nb::numpy, double, nb::shape<-1, 2>>;

// Places of the new vertices, which are numbered after the given ones; splits of segments as flat
// triples (from, to, middle); and whether more than `most` vertices were needed.
inline auto refine(const GivenRows& points, const GivenTriangles& triangles,
                   const GivenTriangles& neighbors, const GivenFlags& fixed, double least_angle,
                   double largest_area, double longest_edge, std::int32_t most) {
  MeshEditor editor = editor_of(points, triangles, neighbors, fixed);
  const std::int32_t given = editor.slots();
  Refiner::Ended ended{};
  std::vector<std::int32_t> splits;
  std::vector<Point> places;
  {
    nb::gil_scoped_release release;
    Refiner refiner(editor, {least_angle, largest_area, longest_edge});
    ended = refiner.run(most, no_signal);
    std::vector<std::int32_t> number(editor.slots());
    for (std::int32_t v = 0; v < editor.slots(); ++v) {
      number[v] = v < given ? v : given + static_cast<std::int32_t>(places.size());
      if (v >= given && editor.mesh().is_alive(v)) places.push_back(editor.point(v));
    }
    for (const Refiner::Split& split : refiner.splits()) {
      splits.insert(splits.end(), {number[split.from], number[split.to], number[split.middle]});
    }
  }
  if (ended == Refiner::Ended::kStopped) throw nb::python_error();
  auto xy = streamed_array<double>(2 * places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    xy[2 * i] = places[i].x;
    xy[2 * i + 1] = places[i].y;
  }
  return std::make_tuple(hand_over<Places2>(std::move(xy), {places.size(), 2}), hand_over(splits),
                         ended == Refiner::Ended::kTooMany);
}

inline void bind_refine(nb::module_& m) {
  using namespace nb::literals;
  m.def("refine", &refine, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "fixed"_a.noconvert(), "least_angle"_a, "largest_area"_a,
        "longest_edge"_a, "most"_a,
        "Places of new vertices, splits of segments (from, to, middle), and whether they are too many.");
}

}  // namespace tinsmith::python
