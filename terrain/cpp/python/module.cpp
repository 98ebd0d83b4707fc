// The compiled module of terrain. What is in this folder converts and names, nothing else.
#include <nanobind/nanobind.h>

#include "bind_earthwork.hpp"
#include "bind_gridding.hpp"
#include "bind_ground.hpp"
#include "bind_hydrology.hpp"
#include "bind_inspection.hpp"
#include "bind_isolines.hpp"
#include "bind_raster_simplification.hpp"
#include "bind_relief.hpp"
#include "bind_sight.hpp"

NB_MODULE(_core, m) {
  m.doc() = "Compiled core of tinsmith.terrain: what is derived from a TIN.";
  tinsmith::python::bind_isolines(m);
  tinsmith::python::bind_gridding(m);
  tinsmith::python::bind_earthwork(m);
  tinsmith::python::bind_relief(m);
  tinsmith::python::bind_hydrology(m);
  tinsmith::python::bind_inspection(m);
  tinsmith::python::bind_ground(m);
  tinsmith::python::bind_raster_simplification(m);
  tinsmith::python::bind_sight(m);
}
