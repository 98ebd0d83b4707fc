// Reads (x, y) pairs of doubles and segments as pairs of 64-bit point numbers; obeys stdin, see
// serve.hpp.
#include "delaunay32.hpp"

int main(int argc, char** argv) {
  std::vector<Point> points;
  std::vector<delaunay32::Constraint> segments;
  if (argc != 4 || !read_pairs<double>(argv[1], points) || !read_segments(argv[2], segments)) {
    std::fprintf(stderr, "usage: %s POINTS.bin SEGMENTS.bin THREADS (0: all cores)\n", argv[0]);
    return 2;
  }
  const std::vector<delaunay32::Point> rounded = round_all(points);
  const auto threads = static_cast<std::size_t>(std::atoi(argv[3]));
  Kept kept{&points, {threads, delaunay32::ResultDetail::Full}, nullptr, {}};
  serve(kept, renew, [&](Kept& made) {
    return seconds_of([&] {
      made.triangulator->set_points(rounded);
      made.triangulator->set_constraints(segments);
      made.result = made.triangulator->triangulate();
    });
  });
  return 0;
}
