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
// triples (from, to, middle); the triangles that miss the goal, as flat rows (three corners, why);
// how many triangles there are; and whether more than `most` vertices were needed.
inline auto refine(const GivenRows& points, const GivenTriangles& triangles,
                   const GivenTriangles& neighbors, const GivenFlags& fixed,
                   const GivenPairs& kept_whole, double least_angle, double largest_area,
                   double longest_edge, std::int32_t most) {
  MeshEditor editor = editor_of(points, triangles, neighbors, fixed);
  const std::int32_t given = editor.slots();
  Refiner::Ended ended{};
  std::vector<std::int32_t> splits, left;
  std::int64_t count = 0;
  std::vector<Point> places;
  {
    nb::gil_scoped_release release;
    Refiner refiner(editor, {least_angle, largest_area, longest_edge});
    for (std::size_t i = 0; i < kept_whole.shape(0); ++i) {
      refiner.keep_whole(kept_whole.data()[2 * i], kept_whole.data()[2 * i + 1]);
    }
    ended = refiner.run(most, no_signal);
    std::vector<std::int32_t> number(editor.slots());
    for (std::int32_t v = 0; v < editor.slots(); ++v) {
      number[v] = v < given ? v : given + static_cast<std::int32_t>(places.size());
      if (v >= given && editor.mesh().is_alive(v)) places.push_back(editor.point(v));
    }
    for (const Refiner::Split& split : refiner.splits()) {
      splits.insert(splits.end(), {number[split.from], number[split.to], number[split.middle]});
    }
    const Mesh& mesh = editor.mesh();
    for (std::uint32_t t = 0; t < mesh.triangle_slots(); ++t) {
      count += !mesh.is_free(t) && !mesh.is_ghost(t);
    }
    refiner.visit_left([&](std::uint32_t t, Refiner::Why why) {
      for (const std::int32_t v : mesh[t].corner) left.push_back(number[v]);
      left.push_back(static_cast<std::int32_t>(why));
    });
  }
  if (ended == Refiner::Ended::kStopped) throw nb::python_error();
  auto xy = streamed_array<double>(2 * places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    xy[2 * i] = places[i].x;
    xy[2 * i + 1] = places[i].y;
  }
  return std::make_tuple(hand_over<Places2>(std::move(xy), {places.size(), 2}), hand_over(splits),
                         hand_over(left), count, ended == Refiner::Ended::kTooMany);
}

inline void bind_refine(nb::module_& m) {
  using namespace nb::literals;
  m.def("refine", &refine, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "fixed"_a.noconvert(), "kept_whole"_a.noconvert(), "least_angle"_a, "largest_area"_a,
        "longest_edge"_a, "most"_a,
        "Places of new vertices, splits of segments (from, to, middle), triangles that miss the goal "
        "(three corners, why), the number of triangles, and whether there are too many vertices.");
}

}  // namespace tinsmith::python
