// Delaunay32 as a peer, for points and for lines. Its coordinates are integers of 32 bits: points
// are rounded to millimetres before they are given to it, or to what their extent allows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "delaunay32/delaunay.hpp"
#include "serve.hpp"

struct Point {
  Point(double given_x, double given_y) : x(given_x), y(given_y) {}
  double x, y;
};

struct Kept {
  const std::vector<Point>* points;
  delaunay32::TriangulationOptions options;
  std::unique_ptr<delaunay32::Triangulator> triangulator;
  delaunay32::TriangulationResult result;

  std::size_t number_of_faces() const { return result.triangles.size(); }
};

bool save(const Kept& kept, const char* path) {
  std::FILE* file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  for (const delaunay32::Triangle& triangle : kept.result.triangles) {
    for (const std::uint32_t corner : {triangle.i0, triangle.i1, triangle.i2}) {
      const double xy[2] = {(*kept.points)[corner].x, (*kept.points)[corner].y};
      std::fwrite(xy, sizeof(double), 2, file);
    }
  }
  return std::fclose(file) == 0;
}

std::vector<delaunay32::Point> round_all(const std::vector<Point>& points) {
  constexpr double kMillimetres = 1000.0, kLargest = 1.9e9;
  Point low = points[0], high = points[0];
  for (const Point& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double extent = std::max(high.x - low.x, high.y - low.y);
  const double scale = std::min(kMillimetres, kLargest / extent);
  std::vector<delaunay32::Point> rounded;
  for (const Point& p : points) {
    rounded.push_back({static_cast<std::int32_t>(std::lround((p.x - low.x) * scale)),
                       static_cast<std::int32_t>(std::lround((p.y - low.y) * scale))});
  }
  return rounded;
}

void renew(Kept& kept) {
  kept.result = {};
  kept.triangulator = std::make_unique<delaunay32::Triangulator>();
  kept.triangulator->set_options(kept.options);
}
