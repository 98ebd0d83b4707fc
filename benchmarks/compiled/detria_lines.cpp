// detria (github Kimbatt/detria) as a peer: points and constrained edges, Delaunay. Reads (x, y)
// pairs of doubles and segments as pairs of 64-bit point numbers; obeys stdin, see serve.hpp.
#include <cstdint>
#include <memory>

#include "detria.hpp"
#include "serve.hpp"

using Triangulation = detria::Triangulation<detria::PointD, std::uint32_t>;

struct Kept {
  const std::vector<detria::PointD>* points;
  std::unique_ptr<Triangulation> made;

  std::size_t number_of_faces() const {
    std::size_t count = 0;
    made->forEachTriangleOfEveryLocation([&](const detria::Triangle<std::uint32_t>&) { ++count; });
    return count;
  }
};

bool save(const Kept& kept, const char* path) {
  std::FILE* file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  kept.made->forEachTriangleOfEveryLocation([&](const detria::Triangle<std::uint32_t>& triangle) {
    for (const std::uint32_t corner : {triangle.x, triangle.y, triangle.z}) {
      const detria::PointD& point = (*kept.points)[corner];
      const double xy[2] = {point.x, point.y};
      std::fwrite(xy, sizeof(double), 2, file);
    }
  });
  return std::fclose(file) == 0;
}

struct Segment {
  std::uint32_t start, end;
};

int main(int argc, char** argv) {
  std::vector<detria::PointD> points;
  std::vector<Segment> segments;
  if (argc != 3 || !read_pairs<double>(argv[1], points) || !read_segments(argv[2], segments)) {
    std::fprintf(stderr, "usage: %s POINTS.bin SEGMENTS.bin\n", argv[0]);
    return 2;
  }
  Kept kept{&points, nullptr};
  serve(
      kept, [](Kept& old) { old.made = std::make_unique<Triangulation>(); },
      [&](Kept& fresh) {
        return seconds_of([&] {
          fresh.made->setPoints(points);
          for (const Segment& segment : segments) {
            fresh.made->setConstrainedEdge(segment.start, segment.end);
          }
          if (!fresh.made->triangulate(true)) {
            std::fprintf(stderr, "%s\n", fresh.made->getErrorMessage().c_str());
            std::exit(1);
          }
        });
      });
  return 0;
}
