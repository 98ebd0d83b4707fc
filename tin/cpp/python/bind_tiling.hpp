// Bindings of parts of a triangulation.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../tiling/box_triangles.hpp"
#include "../tiling/extraction.hpp"
#include "../tiling/visibility.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

using GivenSides = std::tuple<double, double, double, double>;

inline Box box_from(const GivenSides& sides) {
  return {std::get<0>(sides), std::get<1>(sides), std::get<2>(sides), std::get<3>(sides)};
}

using GivenCorners = Given<std::uint8_t, -1>;
using Corners = Made<std::uint8_t, -1>;

struct BoxTriangleArrays {
  Numbers chosen;
  Corners firsts;
  Flags owned;
  Numbers open;
};

// Triangles of places that are there; neighbours, if they are given, as they come.
inline PlaneTriangles plane_triangles_of(const GivenXy& places, const GivenTriples& triangles,
                                         const GivenTriples* neighbors = nullptr) {
  const std::int32_t count = row_count(places.shape(0));
  const Surface corners = corners_of(triangles, count);
  if (neighbors != nullptr && neighbors->shape(0) != triangles.shape(0)) {
    throw std::invalid_argument("triangles and neighbors must have the same number of rows");
  }
  return {points_of(places), corners.corners, neighbors == nullptr ? nullptr : neighbors->data(),
          count, corners.triangle_count};
}

inline BoxTriangleArrays find_in_box(const GivenXy& places, const GivenTriples& triangles,
                                     const GivenSides& box, const GivenSides& around) {
  BoxTriangles found(plane_triangles_of(places, triangles), box_from(box), box_from(around));
  {
    ReleasedLock release;
    found.find();
  }
  const std::size_t count = found.count();
  return {hand_over<Numbers>(found.take_chosen(), {count}),
          hand_over<Corners>(found.take_firsts(), {count}),
          hand_over<Flags>(found.take_owned(), {count}),
          hand_over<Numbers>(found.take_open(), {found.open_count()})};
}

inline ChosenTriangles chosen_from(const PlaneTriangles& all, const GivenNumbers& triangles,
                                   const GivenCorners& firsts) {
  const auto count = static_cast<std::int32_t>(all.count);
  bool is_sound = triangles.size() == firsts.size();
  for (std::size_t i = 0; is_sound && i < triangles.size(); ++i) {
    const std::int32_t t = triangles.data()[i];
    is_sound = t > (i == 0 ? -1 : triangles.data()[i - 1]) && t < count && firsts.data()[i] < 3;
  }
  if (!is_sound) {
    throw std::invalid_argument(
        "chosen must be ascending numbers of triangles, with a corner each");
  }
  return {triangles.data(), firsts.data(), static_cast<std::uint32_t>(triangles.size())};
}

struct ExtractedArrays {
  Numbers vertices;
  Triples triangles, neighbors;
  Numbers order;
  std::optional<TripleFlags> fixed;
};

// Each row once.
inline const std::int32_t* rows_from(const std::optional<GivenNumbers>& rows, std::int32_t count) {
  if (!rows) return nullptr;
  std::vector<bool> is_there(static_cast<std::size_t>(count));
  const bool is_sound = rows->size() == is_there.size() && are_all(*rows, [&](std::int32_t row) {
                          if (row < 0 || row >= count || is_there[static_cast<std::size_t>(row)])
                            return false;
                          is_there[static_cast<std::size_t>(row)] = true;
                          return true;
                        });
  if (!is_sound) throw std::invalid_argument("rows must be the numbers from 0 to n - 1");
  return rows->data();
}

inline ExtractedArrays extract(const GivenXy& places, const GivenTriples& triangles,
                               const GivenTriples& neighbors,
                               const std::optional<GivenNumbers>& rows,
                               const std::optional<GivenFlags>& fixed, const GivenNumbers& chosen,
                               const GivenCorners& firsts, bool is_ordered) {
  const PlaneTriangles all = plane_triangles_of(places, triangles, &neighbors);
  if (fixed && fixed->shape(0) != triangles.shape(0)) {
    throw std::invalid_argument("triangles and fixed must have as many rows");
  }
  Extraction made(all, rows_from(rows, all.place_count), fixed ? fixed->data() : nullptr,
                  chosen_from(all, chosen, firsts));
  {
    ReleasedLock release;
    made.run(is_ordered);
  }
  const std::size_t size = chosen.size();
  std::optional<TripleFlags> flags;
  if (fixed) flags = hand_over<TripleFlags>(made.take_fixed(), {size, 3});
  return {hand_over(made.vertices()), hand_over<Triples>(made.take_triangles(), {size, 3}),
          hand_over<Triples>(made.take_neighbors(), {size, 3}),
          hand_over<Numbers>(made.take_order(), {size}), std::move(flags)};
}

struct SeenArrays {
  Numbers offsets, triangles;
  Numbers failed;
};

inline SeenArrays find_seen(const GivenXy& places, const GivenTriples& triangles,
                            const GivenTriples& neighbors, const GivenFlags& fixed,
                            const GivenNumbers& chosen, const GivenXy& centers,
                            const GivenValues& radii, std::int32_t most) {
  const PlaneTriangles all = plane_triangles_of(places, triangles, &neighbors);
  const bool is_sound = fixed.shape(0) == triangles.shape(0) && centers.shape(0) == chosen.size() &&
                        radii.size() == chosen.size() && most > 0 &&
                        are_all(chosen, [&](std::int32_t t) {
                          return t >= 0 && t < static_cast<std::int32_t>(all.count);
                        });
  if (!is_sound) throw std::invalid_argument("triangles, flags and discs do not go together");
  std::vector<std::int32_t> offsets{0}, seen, failed;
  {
    ReleasedLock release;
    Visibility visibility(all, fixed.data(), static_cast<std::size_t>(most));
    const Point* center = points_of(centers);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const Disc disc{center[i], radii.data()[i]};
      if (!visibility.find(triangle_numbered(chosen.data()[i]), disc, seen))
        failed.push_back(static_cast<std::int32_t>(i));
      offsets.push_back(static_cast<std::int32_t>(seen.size()));
    }
  }
  return {hand_over(offsets), hand_over(seen), hand_over(failed)};
}

inline Made<bool, -1> are_in_triangles(const GivenXy& corners, const GivenXy& places) {
  if (corners.shape(0) % 3 != 0) throw std::invalid_argument("three corners for each triangle");
  StreamedArray<bool> found = streamed_array<bool>(places.shape(0));
  {
    ReleasedLock release;
    for (std::size_t i = 0; i < places.shape(0); ++i)
      found[i] = is_in_any(points_of(places)[i], points_of(corners), corners.shape(0) / 3);
  }
  return hand_over<Made<bool, -1>>(std::move(found), {places.shape(0)});
}

inline void bind_tiling(nb::module_& m) {
  Result<SeenArrays>(m, "SeenTriangles", "The triangles that are seen from each of some.")
      .def_array("offsets", &SeenArrays::offsets, "(k + 1,), where those of each begin.")
      .def_array("triangles", &SeenArrays::triangles, "(n,), ascending for each.")
      .def_array("failed", &SeenArrays::failed, "Which of some see more than was asked for.");
  m.def("find_seen", &find_seen, "places"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "fixed"_a.noconvert(), "chosen"_a.noconvert(),
        "centers"_a.noconvert(), "radii"_a.noconvert(), "most"_a,
        "The triangles that lines of sight from the inside of each chosen one reach in its disc.");
  m.def("are_in_triangles", &are_in_triangles, "corners"_a.noconvert(), "places"_a.noconvert(),
        "Whether each place lies in any of some closed triangles.");
  Result<BoxTriangleArrays>(m, "BoxTriangles", "Triangles that meet a box.")
      .def_array("chosen", &BoxTriangleArrays::chosen, "(k,), ascending.")
      .def_array("firsts", &BoxTriangleArrays::firsts,
                 "(k,), the lexicographically first corner of each.")
      .def_array("owned", &BoxTriangleArrays::owned,
                 "(k,), whether the box without its eastern and northern side holds this corner.")
      .def_array("open", &BoxTriangleArrays::open,
                 "Places among them of those whose circumscribed disc may leave the second box.");
  m.def("find_in_box", &find_in_box, "places"_a.noconvert(), "triangles"_a.noconvert(), "box"_a,
        "around"_a, "The triangles that meet a closed box.");
  Result<ExtractedArrays>(m, "Extracted", "Some triangles, their vertices numbered anew.")
      .def_array("vertices", &ExtractedArrays::vertices, "(n,), the rows that are used, ascending.")
      .def_array("triangles", &ExtractedArrays::triangles, "(k, 3), from their first corners.")
      .def_array("neighbors", &ExtractedArrays::neighbors, "(k, 3), -1 where none of them is.")
      .def_array("order", &ExtractedArrays::order, "(k,), the place of each among the chosen.")
      .def_array("fixed", &ExtractedArrays::fixed, "(k, 3), None if none were given.");
  m.def("extract", &extract, "places"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "rows"_a.noconvert().none(), "fixed"_a.noconvert().none(),
        "chosen"_a.noconvert(), "firsts"_a.noconvert(), "is_ordered"_a,
        "Some triangles as arrays of their own, in their order or in that of first and second "
        "corners.");
}

}  // namespace tinsmith::python
