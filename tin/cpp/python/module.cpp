// The compiled module. What is in this folder converts and names, nothing else.
#include <nanobind/nanobind.h>

#include "bind_constraints.hpp"
#include "bind_editing.hpp"
#include "bind_interpolation.hpp"
#include "bind_location.hpp"
#include "bind_mesh.hpp"
#include "bind_points.hpp"
#include "bind_refinement.hpp"
#include "bind_simplification.hpp"
#include "bind_triangulation.hpp"

NB_MODULE(_core, m) {
  m.doc() = "Compiled core of tinsmith.tin: exact predicates, growth, point location.";
  tinsmith::python::bind_points(m);
  tinsmith::python::bind_triangulation(m);
  tinsmith::python::bind_location(m);
  tinsmith::python::bind_interpolation(m);
  tinsmith::python::bind_constraints(m);
  tinsmith::python::bind_mesh(m);
  tinsmith::python::bind_editing(m);
  tinsmith::python::bind_refinement(m);
  tinsmith::python::bind_simplification(m);
}
