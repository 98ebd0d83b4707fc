// Reads (x, y) pairs of doubles from a file and obeys stdin, see serve.hpp.
#include "delaunay32.hpp"

int main(int argc, char** argv) {
  std::vector<Point> points;
  if (argc != 3 || !read_pairs<double>(argv[1], points) || points.empty()) {
    std::fprintf(stderr, "usage: %s POINTS.bin THREADS (0: all cores)\n", argv[0]);
    return 2;
  }
  const std::vector<delaunay32::Point> rounded = round_all(points);
  const auto threads = static_cast<std::size_t>(std::atoi(argv[2]));
  Kept kept{&points, {threads, delaunay32::ResultDetail::Full}, nullptr, {}};
  serve(kept, renew, [&rounded](Kept& made) {
    return seconds_of([&] {
      made.triangulator->set_points(rounded);
      made.result = made.triangulator->triangulate();
    });
  });
  return 0;
}
