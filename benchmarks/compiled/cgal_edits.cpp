// Edits of CGAL's Delaunay triangulation as a peer. Reads (x, y) pairs of doubles and a script,
// four doubles an edit: what, number of a point, x, y. Obeys stdin, see serve.hpp; every run starts
// from all points, which is not timed.
//
//   what: 0 insert (x, y), 1 remove a point, 2 move a point to (x, y), 3 nothing (a new height),
//   4 insert (x, y) together with all others of this kind, in one call before the rest
//
// Vertices are named by handles.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cstdint>
#include <utility>

#include "serve.hpp"

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Delaunay =
    CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;
using Handles = std::vector<Delaunay::Vertex_handle>;
using Numbered = std::vector<std::pair<Point, std::uint32_t>>;

namespace {

enum What { insert = 0, remove = 1, move = 2, set_height = 3, insert_all = 4 };

struct Edit {
  What what;
  std::size_t number;
  Point point;
};

bool read_edits(const char* path, std::vector<Edit>& edits) {
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) return false;
  double row[4];
  while (std::fread(row, sizeof(double), 4, file) == 4) {
    edits.push_back(
        {static_cast<What>(row[0]), static_cast<std::size_t>(row[1]), Point(row[2], row[3])});
  }
  std::fclose(file);
  return true;
}

void build(const Numbered& numbered, Delaunay& triangulation, Handles& handles) {
  triangulation.clear();
  triangulation.insert(numbered.begin(), numbered.end());
  handles.resize(numbered.size());
  for (const auto vertex : triangulation.finite_vertex_handles()) handles[vertex->info()] = vertex;
}

void apply(const Edit& edit, Delaunay& triangulation, Handles& handles) {
  if (edit.what == insert) {
    triangulation.insert(edit.point);
  } else if (edit.what == remove) {
    triangulation.remove(handles[edit.number]);
  } else if (edit.what == move) {
    triangulation.move_if_no_collision(handles[edit.number], edit.point);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Point> points;
  std::vector<Edit> edits;
  if (argc != 3 || !read_pairs<double>(argv[1], points) || !read_edits(argv[2], edits)) {
    std::fprintf(stderr, "usage: %s POINTS.bin EDITS.bin\n", argv[0]);
    return 2;
  }
  Numbered numbered;
  for (const Point& point : points) numbered.emplace_back(point, numbered.size());
  std::vector<Point> batch;
  for (const Edit& edit : edits) {
    if (edit.what == insert_all) batch.push_back(edit.point);
  }
  Delaunay kept;
  Handles handles;
  serve(
      kept, [&](Delaunay& triangulation) { build(numbered, triangulation, handles); },
      [&](Delaunay& triangulation) {
        return seconds_of([&] {
          triangulation.insert(batch.begin(), batch.end());
          for (const Edit& edit : edits) apply(edit, triangulation, handles);
        });
      });
  return 0;
}
