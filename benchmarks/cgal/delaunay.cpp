// CGAL as a peer. Reads (x, y) pairs of doubles from a file, says "ready" and obeys stdin:
//
//   run K       triangulate K times; answers one line of JSON: mean seconds, number of triangles
//   save PATH   writes the corners of the last triangles, six doubles each
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel>;
using Points = std::vector<Kernel::Point_2>;

namespace {

bool read_points(const char* path, Points& points) {
  std::FILE* file = std::fopen(path, "rb");
  if (file == nullptr) return false;
  double xy[2];
  while (std::fread(xy, sizeof(double), 2, file) == 2) points.emplace_back(xy[0], xy[1]);
  std::fclose(file);
  return true;
}

double seconds_to_build(const Points& points, Delaunay& triangulation) {
  const auto begin = std::chrono::steady_clock::now();
  triangulation.insert(points.begin(), points.end());
  const auto end = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(end - begin).count();
}

bool save(const Delaunay& triangulation, const char* path) {
  std::FILE* file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  for (const auto& face : triangulation.finite_face_handles()) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto& point = face->vertex(corner)->point();
      const double xy[2] = {point.x(), point.y()};
      std::fwrite(xy, sizeof(double), 2, file);
    }
  }
  return std::fclose(file) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  Points points;
  if (argc != 2 || !read_points(argv[1], points)) {
    std::fprintf(stderr, "usage: %s POINTS.bin\n", argv[0]);
    return 2;
  }
  std::printf("{\"ready\": true}\n");
  std::fflush(stdout);
  Delaunay kept;
  std::string line;
  while (std::getline(std::cin, line)) {
    if (line.rfind("run ", 0) == 0) {
      const int count = std::atoi(line.c_str() + 4);
      double total = 0;
      for (int i = 0; i < count; ++i) {
        kept.clear();
        total += seconds_to_build(points, kept);
      }
      std::printf("{\"seconds\": %.9f, \"triangles\": %zu}\n", total / count,
                  static_cast<std::size_t>(kept.number_of_faces()));
    } else if (line.rfind("save ", 0) == 0) {
      std::printf("{\"saved\": %s}\n", save(kept, line.c_str() + 5) ? "true" : "false");
    }
    std::fflush(stdout);
  }
  return 0;
}
