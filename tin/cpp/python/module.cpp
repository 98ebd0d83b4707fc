// The compiled module. What is in this folder converts and names, nothing else.
#include <nanobind/nanobind.h>

#include "bind_constraints.hpp"
#include "bind_editing.hpp"
#include "bind_interpolation.hpp"
#include "bind_location.hpp"
#include "bind_mesh.hpp"
#include "bind_points.hpp"
#include "bind_refinement.hpp"
#include "bind_screening.hpp"
#include "bind_simplification.hpp"
#include "bind_tiling.hpp"
#include "bind_triangulation.hpp"

NB_MODULE(_core, m) {
  nanobind::set_leak_warnings(false);  // daemon threads keep what they use at exit
  using namespace tinsmith::python;
  m.doc() = "Compiled core of tinsmith.tin: exact predicates, growth, point location.";
  bind_points(m);
  bind_triangulation(m);
  bind_location(m);
  bind_interpolation(m);
  bind_constraints(m);
  bind_mesh(m);
  bind_editing(m);
  bind_refinement(m);
  bind_screening(m);
  bind_simplification(m);
  bind_tiling(m);
}
