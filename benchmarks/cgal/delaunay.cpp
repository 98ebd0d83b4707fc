// CGAL as a peer: reads n (x, y) pairs of doubles from a file, triangulates them `repeats` times
// and prints one line of JSON a run: seconds and the number of triangles.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel>;

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s POINTS.bin REPEATS\n", argv[0]);
    return 2;
  }
  std::FILE* file = std::fopen(argv[1], "rb");
  if (file == nullptr) return 1;
  std::vector<Kernel::Point_2> points;
  double xy[2];
  while (std::fread(xy, sizeof(double), 2, file) == 2) points.emplace_back(xy[0], xy[1]);
  std::fclose(file);
  for (int run = 0; run < std::atoi(argv[2]); ++run) {
    const auto begin = std::chrono::steady_clock::now();
    Delaunay triangulation;
    triangulation.insert(points.begin(), points.end());
    const auto end = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(end - begin).count();
    std::printf("{\"seconds\": %.6f, \"triangles\": %zu}\n", seconds,
                static_cast<std::size_t>(triangulation.number_of_faces()));
    std::fflush(stdout);
  }
  return 0;
}
