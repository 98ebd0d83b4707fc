// The compiled module of terrain. What is in this folder converts and names, nothing else.
#include <nanobind/nanobind.h>

#include "bind_earthwork.hpp"
#include "bind_gridding.hpp"
#include "bind_ground.hpp"
#include "bind_hydrology.hpp"
#include "bind_isolines.hpp"
#include "bind_raster_simplification.hpp"
#include "bind_relief.hpp"
#include "bind_sight.hpp"
#include "bind_surface.hpp"

NB_MODULE(_core, m) {
  nanobind::set_leak_warnings(false);  // daemon threads keep what they use at exit
  using namespace tinsmith::python;
  m.doc() = "Compiled core of tinsmith.terrain: what is derived from a TIN.";
  bind_isolines(m);
  bind_gridding(m);
  bind_earthwork(m);
  bind_relief(m);
  bind_hydrology(m);
  bind_ground(m);
  bind_raster_simplification(m);
  bind_sight(m);
  bind_surface(m);
}
