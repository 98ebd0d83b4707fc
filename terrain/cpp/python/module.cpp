// The compiled module of terrain. What is in this folder converts and names, nothing else.
#include <nanobind/nanobind.h>

NB_MODULE(_core, m) { m.doc() = "Compiled core of tinsmith.terrain: what is derived from a TIN."; }
