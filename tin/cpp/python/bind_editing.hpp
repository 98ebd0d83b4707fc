// Bindings of a TIN that is being edited.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../mesh/edited_mesh.hpp"
#include "bind_mesh.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

// ------------------------------------------- arguments of edits, as most callers write them

inline std::optional<double> float_of(nb::handle given) {
  if (!PyFloat_CheckExact(given.ptr())) return std::nullopt;
  return PyFloat_AsDouble(given.ptr());
}

inline std::optional<std::int32_t> vertex_of(nb::handle given) {
  if (!PyLong_CheckExact(given.ptr())) return std::nullopt;
  int is_too_large = 0;
  const long value = PyLong_AsLongAndOverflow(given.ptr(), &is_too_large);
  if (is_too_large != 0 || value < 0 || value > kMostRows) return std::nullopt;
  return static_cast<std::int32_t>(value);
}

inline bool is_list_of(nb::handle given, Py_ssize_t size) {
  return PyList_CheckExact(given.ptr()) && PyList_Size(given.ptr()) == size;
}

// [x, y, z]
inline std::optional<GivenVertex> point_of(nb::handle given) {
  if (!is_list_of(given, 3)) return std::nullopt;
  double value[3];
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> one = float_of(PyList_GetItem(given.ptr(), k));
    if (!one) return std::nullopt;
    value[k] = *one;
  }
  return GivenVertex{value[0], value[1], value[2]};
}

// [[x, y, z]]
inline std::optional<GivenVertex> only_point_of(nb::handle given) {
  if (!is_list_of(given, 1)) return std::nullopt;
  return point_of(PyList_GetItem(given.ptr(), 0));
}

inline bool is_word(nb::handle given, const char* word) {
  return PyUnicode_CheckExact(given.ptr()) &&
         PyUnicode_CompareWithASCIIString(given.ptr(), word) == 0;
}

// --------------------------------------------------------------------------------- the TIN

class HeldEdits {
 public:
  HeldEdits(GivenXyz points, std::int32_t first_line, std::int32_t end_of_lines)
      : points_(std::move(points)), edited_(rows_of(points_), {first_line, end_of_lines}) {
    if (first_line < 0 || first_line > end_of_lines || end_of_lines > edited_.slots()) {
      throw std::invalid_argument("vertices of lines must be among the points");
    }
  }

  void open(const GivenTriples& triangles, const GivenTriples& neighbors, const GivenFlags& fixed) {
    if (edited_.is_open()) throw std::invalid_argument("the mesh is open already");
    const GivenTriangles given = triangles_of(triangles, neighbors, fixed);
    arrays_ = {triangles, neighbors, fixed};
    edited_.open(given);
  }
  HeldMesh mesh() {
    const auto made = [this] {
      ReleasedLock release;
      return edited_.mesh();
    }();
    let_arrays_go();
    return HeldMesh(made);
  }
  void leave_empty(const GivenNumbers& slots) {
    for (const Vertex slot : checked(slots)) edited_.leave_empty(slot);
  }
  void keep_clear(double distance) { edited_.keep_clear(distance); }

  // -------------------------------------------------------------- one vertex
  //
  // None of these lets another thread of Python in between.

  void lend() { edited_.lend(); }
  void take_back() { edited_.take_back(); }

  std::int32_t insert_one(nb::handle points, nb::handle duplicates) {
    const std::optional<GivenVertex> given = only_point_of(points);
    return given && is_word(duplicates, "last") ? edited_.insert(*given) : EditedMesh::kNotDone;
  }
  bool remove_one(nb::handle vertex) {
    const std::optional<std::int32_t> number = vertex_of(vertex);
    return number && edited_.remove(*number);
  }
  bool move_one(nb::handle vertex, nb::handle point) {
    const std::optional<std::int32_t> number = vertex_of(vertex);
    const std::optional<GivenVertex> given = point_of(point);
    return number && given && edited_.move(*number, *given);
  }
  bool set_elevation_of_one(nb::handle vertex, nb::handle z) {
    const std::optional<std::int32_t> number = vertex_of(vertex);
    const std::optional<double> elevation = float_of(z);
    return number && elevation && edited_.set_elevation(*number, *elevation);
  }

  bool is_sound() const { return edited_.is_sound(); }
  std::size_t logged() const { return edited_.logged(); }

  auto take_log() {
    let_arrays_go();
    const std::vector<EditRecord> log = edited_.take_log();
    const std::size_t size = log.size();
    auto numbers = streamed_array<std::int32_t>(3 * size);
    auto given = streamed_array<double>(3 * size);
    for (std::size_t i = 0; i < size; ++i) {
      numbers[3 * i] = static_cast<std::int32_t>(log[i].kind);
      numbers[3 * i + 1] = log[i].vertex;
      numbers[3 * i + 2] = number(log[i].slot);
      given[3 * i] = log[i].given.x;
      given[3 * i + 1] = log[i].given.y;
      given[3 * i + 2] = log[i].given.z;
    }
    return std::make_tuple(hand_over<Triples>(std::move(numbers), {size, 3}),
                           hand_over<Xyz>(std::move(given), {size, 3}));
  }

  // ---------------------------------------------------------------- by slot

  std::int32_t slots() const { return edited_.slots(); }
  std::int32_t count() const { return edited_.numbers().count(); }

  Numbers insert(const GivenXyz& rows) {
    const std::int32_t count = row_count(rows.shape(0));
    auto result = streamed_array<std::int32_t>(count);
    {
      ReleasedLock release;
      edited_.insert_all(rows.data(), count, result.get());
    }
    let_arrays_go();
    return hand_over<Numbers>(std::move(result), {rows.shape(0)});
  }
  bool empty(std::int32_t slot) { return edited_.empty(Vertex{slot}); }
  std::int32_t fill(std::int32_t slot, double x, double y) {
    return number(edited_.fill(Vertex{slot}, {x, y}));
  }
  bool is_clear(std::int32_t slot) { return edited_.is_clear(Vertex{slot}); }
  bool has_fixed_edge(std::int32_t slot) { return edited_.has_fixed_edge(Vertex{slot}); }
  void put_elevation(std::int32_t slot, double z) { edited_.put_elevation(Vertex{slot}, z); }

  std::tuple<double, double, double> point(std::int32_t slot) const {
    const Vertex v = edited_.checked(Vertex{slot});
    const Point place = edited_.place(v);
    return {place.x, place.y, edited_.elevation(v)};
  }

  Numbers slots_of(const Given<std::int64_t, -1>& vertices) const {
    std::vector<Vertex> slots(vertices.shape(0));
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const std::int64_t vertex = vertices.data()[i];
      if (vertex < 0 || vertex >= count()) throw std::invalid_argument("no such vertex");
      slots[i] = edited_.numbers().slot_of(static_cast<std::int32_t>(vertex));
    }
    return hand_over(slots);
  }
  Numbers numbers_of(const GivenNumbers& slots) const {
    std::vector<std::int32_t> numbers;
    numbers.reserve(slots.shape(0));
    for (const Vertex slot : checked(slots)) numbers.push_back(edited_.numbers().of(slot));
    return hand_over(numbers);
  }

  // The number of the vertex in each slot, -1 for none.
  Numbers numbers() const {
    const auto size = static_cast<std::size_t>(slots());
    auto numbers = streamed_array<std::int32_t>(size);
    std::fill_n(numbers.get(), size, number(kNoVertex));
    edited_.numbers().for_each(
        [&](Vertex slot, std::int32_t vertex) { numbers[number(slot)] = vertex; });
    return hand_over<Numbers>(std::move(numbers), {size});
  }

  // Of the vertices, in the order of their numbers.
  Xyz points() const {
    const auto size = static_cast<std::size_t>(count());
    auto points = streamed_array<double>(3 * size);
    edited_.numbers().for_each([&](Vertex slot, std::int32_t vertex) {
      const Point place = edited_.place(slot);
      double* const row = points.get() + 3 * static_cast<std::size_t>(vertex);
      row[0] = place.x;
      row[1] = place.y;
      row[2] = edited_.elevation(slot);
    });
    return hand_over<Xyz>(std::move(points), {size, 3});
  }

 private:
  // Once there is a mesh of its own.
  void let_arrays_go() {
    if (edited_.is_whole()) arrays_ = {};
  }

  std::vector<Vertex> checked(const GivenNumbers& slots) const {
    std::vector<Vertex> found(slots.shape(0));
    for (std::size_t i = 0; i < found.size(); ++i) {
      found[i] = edited_.checked(Vertex{slots.data()[i]});
    }
    return found;
  }

  struct Arrays {
    GivenTriples triangles, neighbors;
    GivenFlags fixed;
  };

  GivenXyz points_;  // of the first slots
  Arrays arrays_;    // of the triangles before the edits
  EditedMesh edited_;
};

inline void bind_editing(nb::module_& m) {
  nb::class_<HeldEdits>(m, "EditedMesh", "A TIN while it is edited; slots are lasting numbers.")
      .def(nb::init<GivenXyz, std::int32_t, std::int32_t>(), "points"_a.noconvert(), "first_line"_a,
           "end_of_lines"_a)
      .def("open", &HeldEdits::open, "triangles"_a.noconvert(), "neighbors"_a.noconvert(),
           "fixed"_a.noconvert(), "From now on there are triangles.")
      .def_prop_ro("mesh", &HeldEdits::mesh, "A mesh of all triangles, whose vertices stay.")
      .def("leave_empty", &HeldEdits::leave_empty, "slots"_a.noconvert(),
           "Slots without a vertex, before there are triangles.")
      .def("keep_clear", &HeldEdits::keep_clear, "distance"_a,
           "There are lines: what comes as near as this to an edge around it may reach one.")
      .def("lend", &HeldEdits::lend, "From now on edits of one vertex are done, and logged.")
      .def("take_back", &HeldEdits::take_back, "From now on they are refused.")
      .def("insert_one", &HeldEdits::insert_one, "points"_a.none(), "duplicates"_a.none(),
           "The vertex inserted, or -1 if that was not done.")
      .def("remove_one", &HeldEdits::remove_one, "vertex"_a.none(), "Whether it was removed.")
      .def("move_one", &HeldEdits::move_one, "vertex"_a.none(), "point"_a.none(),
           "Whether it was moved.")
      .def("set_elevation_of_one", &HeldEdits::set_elevation_of_one, "vertex"_a.none(),
           "z"_a.none(), "Whether it was set.")
      .def_prop_ro("is_sound", &HeldEdits::is_sound, "False after an error within an edit.")
      .def_prop_ro("logged", &HeldEdits::logged, "Edits of one vertex since the log was taken.")
      .def("take_log", &HeldEdits::take_log,
           "Kind, vertex and slot, and what was given, of each; the log is empty then.")
      .def_prop_ro("slots", &HeldEdits::slots, "Vertices that are or were there.")
      .def_prop_ro("count", &HeldEdits::count, "Vertices that are there.")
      .def("insert", &HeldEdits::insert, "points"_a.noconvert(),
           "The slot of the vertex at each point; one new slot a point.")
      .def("empty", &HeldEdits::empty, "slot"_a,
           "Remove a vertex; False if it must stay, for no triangle would be left.")
      .def("fill", &HeldEdits::fill, "slot"_a, "x"_a, "y"_a,
           "Put a removed vertex at a place; returns the slot of the vertex there.")
      .def("is_clear", &HeldEdits::is_clear, "slot"_a,
           "Whether a vertex is as far from lines as it must be.")
      .def("has_fixed_edge", &HeldEdits::has_fixed_edge, "slot"_a)
      .def("put_elevation", &HeldEdits::put_elevation, "slot"_a, "z"_a)
      .def("point", &HeldEdits::point, "slot"_a, "Easting, northing and elevation.")
      .def("slots_of", &HeldEdits::slots_of, "vertices"_a.noconvert(), "Their slots.")
      .def("numbers_of", &HeldEdits::numbers_of, "slots"_a.noconvert(), "Numbers of vertices.")
      .def("numbers", &HeldEdits::numbers, "The vertex of every slot, -1 for none.")
      .def("points", &HeldEdits::points, "Of the vertices, by their numbers.");
}

}  // namespace tinsmith::python
