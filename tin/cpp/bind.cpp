// The border to Python: converts and names, nothing else.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>

#include "base/arrays.hpp"
#include "bind_arrays.hpp"
#include "bind_lines.hpp"
#include "bind_mesh.hpp"
#include "bind_refine.hpp"
#include "location/locate.hpp"
#include "points/cleaning.hpp"
#include "points/snapping.hpp"
#include "predicates/predicates.hpp"
#include "triangulation.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using namespace tinsmith::python;

tinsmith::Options options_of(tinsmith::Method method, int threads, const std::string& path) {
  if (threads < 1) throw std::invalid_argument("at least one thread is needed");
  return {method, threads, tinsmith::vector_path_named(path)};
}

auto grow(const Points& points, tinsmith::Method method, int threads, const std::string& path) {
  const tinsmith::PointRows rows = rows_of(points);
  const tinsmith::Options options = options_of(method, threads, path);
  tinsmith::Triangulation made = [&] {
    nb::gil_scoped_release release;
    return tinsmith::Triangulator(rows, options, no_signal).run();
  }();
  if (!made.is_complete) throw nb::python_error();
  const auto size = static_cast<std::size_t>(made.triangle_count);
  std::optional<Numbers> kept_row;
  if (!made.kept_row.empty()) kept_row = hand_over(made.kept_row);
  return std::make_tuple(hand_over<Corners>(std::move(made.corners), {size, 3}),
                         hand_over<Corners>(std::move(made.neighbors), {size, 3}), kept_row,
                         made.distinct_count);
}

nb::dict count_work(const Points& points, tinsmith::Method method, int threads,
                    const std::string& path) {
  const tinsmith::PointRows rows = rows_of(points);
  tinsmith::Triangulator triangulator(rows, options_of(method, threads, path), no_signal);
  const tinsmith::Triangulation made = triangulator.run();
  if (!made.is_complete) throw nb::python_error();
  nb::dict counts;
  counts["triangles"] = made.triangle_count;
  counts["searches"] = made.counts.searches;
  counts["full_searches"] = made.counts.full_searches;
  counts["candidates"] = made.counts.candidates;
  counts["cell_rows"] = made.counts.cell_rows;
  counts["exact_decisions"] = made.counts.exact_decisions;
  counts["walk_steps"] = made.counts.walk_steps;
  return counts;
}

nb::list vector_paths() {
  nb::list names;
  for (const tinsmith::NamedPath& path : tinsmith::vector_paths()) names.append(path.name);
  return names;
}

// The clean copy, and whether it is sound.
auto clean(const Points& points, int threads) {
  const std::size_t size = points.shape(0);
  auto copy = tinsmith::streamed_array<double>(3 * size);
  bool is_sound = false;
  {
    nb::gil_scoped_release release;
    tinsmith::Team team(threads, [] { return true; });
    is_sound = tinsmith::copy_clean(points.data(), static_cast<std::int64_t>(size), copy.get(), team);
  }
  return std::make_tuple(hand_over<Rows>(std::move(copy), {size, 3}), is_sound);
}

Numbers snap(const Points& points, double distance) {
  const tinsmith::PointRows rows = rows_of(points);
  std::vector<std::int32_t> kept_row;
  {
    nb::gil_scoped_release release;
    kept_row = tinsmith::snap_rows(rows, distance);
  }
  return hand_over(kept_row);
}

tinsmith::Point place(const Places& places, std::size_t row) {
  return {places.data()[2 * row], places.data()[2 * row + 1]};
}

// The expansions of the exact stage hold finite numbers only.
void require_finite(const Places& places) {
  const double* end = places.data() + 2 * places.shape(0);
  if (!std::all_of(places.data(), end, [](double c) { return std::isfinite(c); })) {
    throw std::invalid_argument("every coordinate must be finite");
  }
}

template <typename Decide>
Signs signs(const Places& a, const Places& b, const Places& c, const Places& d, Decide decide) {
  const std::size_t n = a.shape(0);
  if (b.shape(0) != n || c.shape(0) != n || d.shape(0) != n) {
    throw std::invalid_argument("the arrays must have the same number of rows");
  }
  for (const Places* places : {&a, &b, &c, &d}) require_finite(*places);
  auto result = tinsmith::streamed_array<std::int8_t>(n);
  for (std::size_t i = 0; i < n; ++i) {
    result[i] = static_cast<std::int8_t>(decide(place(a, i), place(b, i), place(c, i), place(d, i)));
  }
  return hand_over<Signs>(std::move(result), {n});
}

Signs orientation(const Places& a, const Places& b, const Places& c) {
  using tinsmith::Point;
  return signs(a, b, c, c, [](Point p, Point q, Point r, Point) {
    return tinsmith::orientation(p, q, r);
  });
}

Signs compare_distances(const Places& v, const Places& p, const Places& q) {
  using tinsmith::Point;
  return signs(v, p, q, q, [](Point a, Point b, Point c, Point) {
    return tinsmith::compare_distances(a, b, c);
  });
}

Signs in_circle(const Places& a, const Places& b, const Places& c, const Places& d) {
  return signs(a, b, c, d, tinsmith::in_circle);
}

// A locator with the arrays that it reads.
class HeldLocator {
 public:
  using Triangles = nb::ndarray<const std::int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

  HeldLocator(const Points& points, const Triangles& triangles, const Triangles& neighbors)
      : points_(points), triangles_(triangles), neighbors_(neighbors), locator_(index()) {}

  Numbers locate(const Places& xy) const {
    return answer<Numbers, std::int32_t>(xy, [&](std::int64_t count, std::int32_t* result) {
      return locator_.locate(places_of(xy), count, result, no_signal);
    });
  }

  Heights interpolate(const Places& xy) const {
    return answer<Heights, double>(xy, [&](std::int64_t count, double* result) {
      return locator_.interpolate(places_of(xy), count, result, no_signal);
    });
  }

 private:
  tinsmith::Locator index() const {
    if (triangles_.shape(0) != neighbors_.shape(0)) {
      throw std::invalid_argument("triangles and neighbors must have the same number of rows");
    }
    if (triangles_.shape(0) > INT32_MAX / 3 || points_.shape(0) > INT32_MAX / 3) {
      throw std::invalid_argument("more triangles or points than 32-bit indices can number");
    }
    const tinsmith::Surface surface{points_.data(), triangles_.data(), neighbors_.data(),
                                    static_cast<std::int32_t>(points_.shape(0)),
                                    static_cast<std::int32_t>(triangles_.shape(0))};
    nb::gil_scoped_release release;
    if (!surface.has_sound_points()) {
      throw std::invalid_argument("points must be finite and within the exact range");
    }
    if (!surface.has_sound_corners()) {
      throw std::invalid_argument("triangles must hold vertex numbers from 0 to n - 1");
    }
    return tinsmith::Locator(surface);
  }

  static const tinsmith::Point* places_of(const Places& xy) {
    static_assert(sizeof(tinsmith::Point) == 2 * sizeof(double), "a row is a point");
    return reinterpret_cast<const tinsmith::Point*>(xy.data());
  }

  template <typename Array, typename T, typename Run>
  static Array answer(const Places& xy, Run run) {
    const std::size_t count = xy.shape(0);
    auto result = tinsmith::streamed_array<T>(count);
    bool is_complete = false;
    {
      nb::gil_scoped_release release;
      is_complete = run(static_cast<std::int64_t>(count), result.get());
    }
    if (!is_complete) throw nb::python_error();
    return hand_over<Array>(std::move(result), {count});
  }

  Points points_;
  Triangles triangles_, neighbors_;
  tinsmith::Locator locator_;
};

}  // namespace

NB_MODULE(_core, m) {
  m.doc() = "Compiled core of tinsmith.tin: exact predicates, growth, point location.";
  m.attr("SMALLEST_COORDINATE") = tinsmith::kSmallestCoordinate;
  m.attr("LARGEST_COORDINATE") = tinsmith::kLargestCoordinate;
  m.attr("MOST_POINTS") = tinsmith::kMostPoints;
  nb::enum_<tinsmith::Method>(m, "Method", "How to build; the result is the same.")
      .value("AUTOMATIC", tinsmith::Method::kAutomatic)
      .value("GROWTH", tinsmith::Method::kGrowth)
      .value("INSERTION", tinsmith::Method::kInsertion);
  const auto fastest = tinsmith::vector_paths().back().name;
  m.def("grow", &grow, "points"_a.noconvert(), "method"_a = tinsmith::Method::kAutomatic,
        "threads"_a = 1, "path"_a = fastest,
        "Triangles, neighbours, kept row of each row (or None) and the number of distinct places.");
  m.def("count_work", &count_work, "points"_a.noconvert(),
        "method"_a = tinsmith::Method::kAutomatic, "threads"_a = 1, "path"_a = fastest,
        "Triangulate and return how much the searches did.");
  m.def("vector_paths", &vector_paths,
        "Names of the vector instructions that this processor has, slowest first.");
  m.def("clean", &clean, "points"_a.noconvert(), "threads"_a = 1,
        "A copy without -0.0, and whether the growth can work with it.");
  m.def("snap", &snap, "points"_a.noconvert(), "distance"_a,
        "For each row the row that it is merged into.");
  m.def("orientation", &orientation, "a"_a.noconvert(), "b"_a.noconvert(), "c"_a.noconvert(),
        "+1 where c lies left of the line from a to b, -1 right, 0 on it.");
  m.def("compare_distances", &compare_distances, "v"_a.noconvert(), "p"_a.noconvert(),
        "q"_a.noconvert(), "+1 where p is further from v than q is, -1 nearer, 0 equally far.");
  m.def("in_circle", &in_circle, "a"_a.noconvert(), "b"_a.noconvert(), "c"_a.noconvert(),
        "d"_a.noconvert(),
        "+1 where d lies inside the circle through counter-clockwise a, b, c, -1 outside, 0 on it.");
  tinsmith::python::bind_lines(m);
  tinsmith::python::bind_mesh(m);
  tinsmith::python::bind_refine(m);
  nb::class_<HeldLocator>(m, "Locator", "Finds the triangle and the height at any place.")
      .def(nb::init<const Points&, const HeldLocator::Triangles&, const HeldLocator::Triangles&>(),
           "points"_a.noconvert(), "triangles"_a.noconvert(), "neighbors"_a.noconvert())
      .def("locate", &HeldLocator::locate, "xy"_a.noconvert(),
           "The triangle at each place, -1 outside; the smallest one where several meet.")
      .def("interpolate", &HeldLocator::interpolate, "xy"_a.noconvert(),
           "The height at each place, NaN outside.");
}
