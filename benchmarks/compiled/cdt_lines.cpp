// CDT of A. Amirkhanov (github artem-ogre/CDT) as a peer: points, then constrained edges, then the
// super triangle is erased. Reads (x, y) pairs of doubles and segments as pairs of 64-bit point
// numbers; obeys stdin, see serve.hpp.
#include <cstdint>
#include <memory>

#include "CDT.h"
#include "serve.hpp"

struct Kept {
  std::unique_ptr<CDT::Triangulation<double>> made;

  std::size_t number_of_faces() const { return made->triangles.size(); }
};

bool save(const Kept& kept, const char* path) {
  std::FILE* file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  for (const CDT::Triangle& triangle : kept.made->triangles) {
    for (const CDT::VertInd corner : triangle.vertices) {
      const auto& point = kept.made->vertices[corner];
      const double xy[2] = {point.x, point.y};
      std::fwrite(xy, sizeof(double), 2, file);
    }
  }
  return std::fclose(file) == 0;
}

int main(int argc, char** argv) {
  std::vector<CDT::V2d<double>> points;
  std::vector<CDT::Edge> segments;
  if (argc != 3 || !read_pairs<double>(argv[1], points) || !read_segments(argv[2], segments)) {
    std::fprintf(stderr, "usage: %s POINTS.bin SEGMENTS.bin\n", argv[0]);
    return 2;
  }
  Kept kept;
  serve(
      kept, [](Kept& old) { old.made = std::make_unique<CDT::Triangulation<double>>(); },
      [&](Kept& fresh) {
        return seconds_of([&] {
          fresh.made->insertVertices(points);
          fresh.made->insertEdges(segments);
          fresh.made->eraseSuperTriangle();
        });
      });
  return 0;
}
