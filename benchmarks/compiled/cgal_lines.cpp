// CGAL's constrained Delaunay triangulation as a peer, in both ways that its manual shows. Reads
// (x, y) pairs of doubles and segments as pairs of 64-bit point numbers; obeys stdin, see serve.hpp.
//
//   handles   insert(begin, end) all points, then insert_constraint between vertex handles
//   indices   insert_constraints(points, segments) in one call
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cstdint>
#include <cstring>
#include <utility>

#include "serve.hpp"

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Face = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Numbered =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel,
                                               CGAL::Triangulation_data_structure_2<Vertex, Face>>;
using Plain = CGAL::Constrained_Delaunay_triangulation_2<Kernel>;
using Points = std::vector<Point>;
using Segments = std::vector<std::pair<std::size_t, std::size_t>>;

namespace {

template <typename Triangulation>
void clear(Triangulation& triangulation) {
  triangulation.clear();
}

void serve_handles(const Points& points, const Segments& segments) {
  std::vector<std::pair<Point, std::uint32_t>> numbered;
  for (const Point& point : points) numbered.emplace_back(point, numbered.size());
  const auto build = [&](Numbered& triangulation) {
    triangulation.insert(numbered.begin(), numbered.end());
    std::vector<Numbered::Vertex_handle> handles(points.size());
    for (const auto vertex : triangulation.finite_vertex_handles()) {
      handles[vertex->info()] = vertex;
    }
    for (const auto& [start, end] : segments) {
      triangulation.insert_constraint(handles[start], handles[end]);
    }
  };
  Numbered kept;
  serve(kept, clear<Numbered>,
        [&](Numbered& triangulation) { return seconds_of([&] { build(triangulation); }); });
}

void serve_indices(const Points& points, const Segments& segments) {
  Plain kept;
  serve(kept, clear<Plain>, [&](Plain& triangulation) {
    return seconds_of([&] {
      triangulation.insert_constraints(points.begin(), points.end(), segments.begin(),
                                       segments.end());
    });
  });
}

}  // namespace

int main(int argc, char** argv) {
  Points points;
  Segments segments;
  if (argc != 4 || !read_pairs<double>(argv[1], points) ||
      !read_pairs<std::int64_t>(argv[2], segments)) {
    std::fprintf(stderr, "usage: %s POINTS.bin SEGMENTS.bin handles|indices\n", argv[0]);
    return 2;
  }
  if (std::strcmp(argv[3], "handles") == 0) {
    serve_handles(points, segments);
  } else {
    serve_indices(points, segments);
  }
  return 0;
}
