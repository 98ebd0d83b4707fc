// Bindings of volumes between surfaces.
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../../../tin/cpp/python/conversion.hpp"
#include "../earthwork/overlay.hpp"
#include "../earthwork/storage.hpp"
#include "../earthwork/volumes.hpp"

namespace tinsmith::python {

using StageTable = Made<double, -1, 3>;
using SumTable = Made<double, -1, earthwork::Sums::kColumns>;

inline Surface exact_surface_of(const GivenXyz& points, const GivenTriples& triangles) {
  const Surface surface = surface_of(points, triangles);
  require_exact_points(surface);
  return surface;
}

inline void require_groups(const GivenNumbers& groups, std::size_t count, std::int32_t limit) {
  if (groups.shape(0) != count) throw std::invalid_argument("a group for each triangle is needed");
  if (!are_all(groups, [limit](std::int32_t group) { return group >= 0 && group < limit; })) {
    throw std::invalid_argument("groups must be numbers from 0 to their count - 1");
  }
}

// Sums that are not rounded yet: doubles whose sums they are, and the extremes.
struct SumTerms {
  Made<double, -1, earthwork::Sums::kSummed, ExactSum::kTerms> terms;
  Made<double, -1, 2> extremes;
};
using AreaTerms = Made<double, -1, ExactSum::kTerms>;

inline SumTerms hand_over_terms(const std::vector<earthwork::Sums>& sums) {
  std::vector<earthwork::Sums::Terms> terms;
  std::vector<std::array<double, 2>> extremes;
  for (const earthwork::Sums& one : sums) {
    terms.push_back(one.terms());
    extremes.push_back(one.extremes());
  }
  return {copy_over<decltype(SumTerms::terms), double>(
              terms, {sums.size(), earthwork::Sums::kSummed, ExactSum::kTerms}),
          copy_over<decltype(SumTerms::extremes), double>(extremes, {sums.size(), 2})};
}

inline AreaTerms hand_over_terms(const std::vector<ExactSum>& sums) {
  std::vector<std::array<double, ExactSum::kTerms>> terms;
  for (const ExactSum& one : sums) terms.push_back(one.terms());
  return copy_over<AreaTerms, double>(terms, {sums.size(), ExactSum::kTerms});
}

// The sum of each row.
inline std::vector<ExactSum> sums_of_rows(const GivenRows& rows) {
  std::vector<ExactSum> sums(rows.shape(0));
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    for (std::size_t k = 0; k < rows.shape(1); ++k) {
      sums[i].add(rows.data()[i * rows.shape(1) + k]);
    }
  }
  return sums;
}

inline Elevations sum_rows(const GivenRows& rows) {
  std::vector<double> values;
  for (const ExactSum& sum : sums_of_rows(rows)) values.push_back(sum.value());
  return copy_over<Elevations, double>(values, {values.size()});
}

inline AreaTerms merge_terms(const GivenRows& rows) { return hand_over_terms(sums_of_rows(rows)); }

inline SumTable hand_over(const std::vector<earthwork::Sums>& sums) {
  const auto rows = earthwork::rows_of(sums);
  return copy_over<SumTable, double>(rows, {rows.size(), earthwork::Sums::kColumns});
}

inline std::vector<earthwork::Sums> sum_cells(const GivenXyz& points, const GivenTriples& triangles,
                                              const GivenNumbers& groups, std::int32_t group_count,
                                              const GivenXyz& other_points,
                                              const GivenTriples& other_triangles, double up,
                                              bool is_other_apart, int threads,
                                              const Listener::Tell& tell) {
  const Surface first = exact_surface_of(points, triangles);
  const Surface second = exact_surface_of(other_points, other_triangles);
  require_groups(groups, triangles.shape(0), group_count);
  const auto sum = [&](Team& team) {
    return earthwork::sum_between(first, groups.data(), group_count, second, is_other_apart, up,
                                  team);
  };
  return unlocked(threads, sum, tell);
}

inline SumTable sum_between(const GivenXyz& points, const GivenTriples& triangles,
                            const GivenNumbers& groups, std::int32_t group_count,
                            const GivenXyz& other_points, const GivenTriples& other_triangles,
                            double up, bool is_other_apart, int threads,
                            const Listener::Tell& tell) {
  return hand_over(sum_cells(points, triangles, groups, group_count, other_points, other_triangles,
                             up, is_other_apart, threads, tell));
}

inline SumTerms terms_between(const GivenXyz& points, const GivenTriples& triangles,
                              const GivenNumbers& groups, std::int32_t group_count,
                              const GivenXyz& other_points, const GivenTriples& other_triangles,
                              double up, bool is_other_apart, int threads) {
  return hand_over_terms(sum_cells(points, triangles, groups, group_count, other_points,
                                   other_triangles, up, is_other_apart, threads, {}));
}

inline std::vector<earthwork::Sums> sum_triangles(const GivenXyz& points,
                                                  const GivenTriples& triangles,
                                                  const GivenValues& heights,
                                                  const GivenNumbers& groups,
                                                  std::int32_t group_count, double up) {
  const Surface given = exact_surface_of(points, triangles);
  require_groups(groups, triangles.shape(0), group_count);
  if (heights.shape(0) != points.shape(0)) {
    throw std::invalid_argument("a height for each point is needed");
  }
  return unlocked(1, [&](Team& team) {
    return earthwork::sum_heights(given, heights.data(), groups.data(), group_count, up, team);
  });
}

inline SumTable sum_heights(const GivenXyz& points, const GivenTriples& triangles,
                            const GivenValues& heights, const GivenNumbers& groups,
                            std::int32_t group_count, double up) {
  return hand_over(sum_triangles(points, triangles, heights, groups, group_count, up));
}

inline SumTerms terms_of_heights(const GivenXyz& points, const GivenTriples& triangles,
                                 const GivenValues& heights, const GivenNumbers& groups,
                                 std::int32_t group_count, double up) {
  return hand_over_terms(sum_triangles(points, triangles, heights, groups, group_count, up));
}

inline std::vector<ExactSum> add_areas(const GivenXyz& points, const GivenTriples& triangles,
                                       const GivenNumbers& groups, std::int32_t group_count) {
  const Surface given = exact_surface_of(points, triangles);
  require_groups(groups, triangles.shape(0), group_count);
  return unlocked(1,
                  [&](Team&) { return earthwork::sum_areas(given, groups.data(), group_count); });
}

inline Elevations sum_areas(const GivenXyz& points, const GivenTriples& triangles,
                            const GivenNumbers& groups, std::int32_t group_count) {
  std::vector<double> areas;
  for (const ExactSum& sum : add_areas(points, triangles, groups, group_count)) {
    areas.push_back(sum.value());
  }
  return copy_over<Elevations, double>(areas, {areas.size()});
}

inline AreaTerms terms_of_areas(const GivenXyz& points, const GivenTriples& triangles,
                                const GivenNumbers& groups, std::int32_t group_count) {
  return hand_over_terms(add_areas(points, triangles, groups, group_count));
}

struct OverlayMesh {
  Xyz vertices;
  Pairs origins;
  Offsets offsets;
  Numbers corners;
  Pairs triangles;
};

inline OverlayMesh overlay(const GivenXyz& points, const GivenTriples& triangles,
                           const GivenXyz& other_points, const GivenTriples& other_triangles,
                           bool is_other_apart) {
  const Surface first = exact_surface_of(points, triangles);
  const Surface second = exact_surface_of(other_points, other_triangles);
  const earthwork::Overlay made = unlocked(
      1, [&](Team& team) { return earthwork::Overlay(first, second, is_other_apart, team); });
  return {copy_over<Xyz, double>(made.vertices, {made.vertices.size(), 3}),
          copy_over<Pairs, std::int32_t>(made.origins, {made.origins.size(), 2}),
          copy_over<Offsets, std::int64_t>(made.offsets, {made.offsets.size()}),
          hand_over(made.corners),
          copy_over<Pairs, std::int32_t>(made.triangles, {made.triangles.size(), 2})};
}

inline StageTable stage_sums(const GivenXyz& points, const GivenTriples& triangles,
                             const GivenValues& levels, double up) {
  const Surface given = exact_surface_of(points, triangles);
  if (!std::is_sorted(levels.data(), levels.data() + levels.shape(0))) {
    throw std::invalid_argument("levels must ascend");
  }
  const std::int32_t count = row_count(levels.shape(0));
  const auto rows = unlocked(1, [&](Team& team) {
    return earthwork::Storage(given, levels.data(), count, up, team).rows();
  });
  return copy_over<StageTable, double>(rows, {rows.size(), 3});
}

inline void bind_earthwork(nb::module_& m) {
  m.def("sum_between", &sum_between, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "groups"_a.noconvert(), "group_count"_a, "other_points"_a.noconvert(),
        "other_triangles"_a.noconvert(), "up"_a, "is_other_apart"_a = false, "threads"_a = 1,
        "progress"_a = nb::none(),
        "Cut and fill from one surface to another, a row for each group of the first's triangles.");
  m.def("sum_heights", &sum_heights, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "heights"_a.noconvert(), "groups"_a.noconvert(), "group_count"_a, "up"_a,
        "Cut and fill of heights at the vertices, a row for each group of triangles.");
  m.def("sum_areas", &sum_areas, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "groups"_a.noconvert(), "group_count"_a, "The area in the plane of each group.");
  m.def("terms_between", &terms_between, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "groups"_a.noconvert(), "group_count"_a, "other_points"_a.noconvert(),
        "other_triangles"_a.noconvert(), "up"_a, "is_other_apart"_a = false, "threads"_a = 1,
        "Doubles whose sums are those of sum_between, exactly.");
  m.def("terms_of_heights", &terms_of_heights, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "heights"_a.noconvert(), "groups"_a.noconvert(), "group_count"_a, "up"_a,
        "Doubles whose sums are those of sum_heights, exactly.");
  m.def("terms_of_areas", &terms_of_areas, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "groups"_a.noconvert(), "group_count"_a,
        "Doubles whose sums are those of sum_areas, exactly.");
  m.def("sum_rows", &sum_rows, "rows"_a.noconvert(),
        "The sum of each row, exact before it is rounded.");
  m.def("merge_terms", &merge_terms, "rows"_a.noconvert(),
        "Doubles whose sum is that of each row, exactly: as few for any number of columns.");
  Result<SumTerms>(m, "SumTerms", "Sums of groups that are not rounded yet.")
      .def_array("terms", &SumTerms::terms, "(g, 8, t), of all columns but the last two.")
      .def_array("extremes", &SumTerms::extremes, "(g, 2), the last two: lowest and highest.");
  m.def("overlay", &overlay, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "other_points"_a.noconvert(), "other_triangles"_a.noconvert(), nb::kw_only(),
        "is_other_apart"_a = false,
        "Cut two surfaces along the edges of each other, where both are. Faster where both have "
        "many triangles in common, if it is known that those of the other one do not overlap.");
  Result<OverlayMesh>(m, "OverlayMesh",
                      "The overlay of two surfaces: convex cells that share their vertices.")
      .def_array("vertices", &OverlayMesh::vertices,
                 "(n, 3), easting, northing, elevation of the second surface above the first.")
      .def_array("origins", &OverlayMesh::origins,
                 "(n, 2), the vertex of the first surface, and of the second, that it is; -1 for "
                 "none.")
      .def_array("offsets", &OverlayMesh::offsets, "(k + 1,), where the corners of cells begin.")
      .def_array("corners", &OverlayMesh::corners,
                 "(c,), cell i has the vertices corners[offsets[i]:offsets[i + 1]], "
                 "counter-clockwise.")
      .def_array("triangles", &OverlayMesh::triangles,
                 "(k, 2), of the first and of the second surface, that the cell is part of.");
  m.def("stage_sums", &stage_sums, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "levels"_a.noconvert(), "up"_a, "Area, area in space and volume under each level.");
}

}  // namespace tinsmith::python
