// The border to Python for lines: contacts between them, places in rings.
#pragma once

#include <nanobind/nanobind.h>

#include "bind_arrays.hpp"

namespace tinsmith::python {

inline void bind_lines(nb::module_&) {}

}  // namespace tinsmith::python
