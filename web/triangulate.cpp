// The triangulation for WebAssembly: C functions, no Python and no threads. See docs/web.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "../tin/cpp/points/cleaning.hpp"
#include "../tin/cpp/triangulation.hpp"

namespace {
tinsmith::Triangulation made;
}

extern "C" {

// Room for so many rows of x, y, z; null if there is none.
double* allocate_rows(std::int32_t count) {
  return static_cast<double*>(std::malloc(3 * sizeof(double) * static_cast<std::size_t>(count)));
}

void free_rows(double* rows) { std::free(rows); }

// Whether all rows are such as the predicates are exact for; -0.0 becomes 0.0.
std::int32_t clean_rows(double* rows, std::int32_t count) {
  tinsmith::Team alone(1, [] { return true; });
  return tinsmith::copy_clean(rows, count, rows, alone) ? 1 : 0;
}

// Triangulate rows; returns how many triangles there are, none if all points are in line.
std::int32_t triangulate(const double* rows, std::int32_t count) {
  made = tinsmith::Triangulator({rows, count, 3}, {}, [] { return true; }).run();
  return static_cast<std::int32_t>(made.triangle_count);
}

// 3 a triangle, counter-clockwise, numbered by the rows that are kept.
const std::int32_t* corners() { return made.corners.get(); }

// Of each row the first one at its place; null if no two share a place.
const std::int32_t* kept_rows() { return made.kept_row.empty() ? nullptr : made.kept_row.data(); }
}
