// CGAL's Delaunay triangulation as a peer. Reads (x, y) pairs of doubles from a file and obeys
// stdin, see serve.hpp.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "serve.hpp"

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel>;

int main(int argc, char** argv) {
  std::vector<Kernel::Point_2> points;
  if (argc != 2 || !read_pairs<double>(argv[1], points)) {
    std::fprintf(stderr, "usage: %s POINTS.bin\n", argv[0]);
    return 2;
  }
  Delaunay kept;
  serve(
      kept, [](Delaunay& triangulation) { triangulation.clear(); },
      [&points](Delaunay& triangulation) {
        return seconds_of([&] { triangulation.insert(points.begin(), points.end()); });
      });
  return 0;
}
