// The core without Python: triangulate, insert, fix edges, remove, locate, refine, and prove what
// comes out by exact predicates alone. Prints what is wrong and returns 1, or prints "sound".
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "constraints/contacts.hpp"
#include "constraints/point_in_polygon.hpp"
#include "expectations.hpp"
#include "location/locator.hpp"
#include "mesh/checked_mesh.hpp"
#include "mesh/mesh_arrays.hpp"
#include "refinement/refine.hpp"
#include "triangulation.hpp"

using namespace tinsmith;

namespace {

// Arrays of triangles, whoever made them.
struct Arrays {
  std::vector<std::int32_t> corners, neighbors;
  std::vector<char> fixed;

  std::int32_t count() const { return static_cast<std::int32_t>(corners.size() / 3); }
  bool operator==(const Arrays& other) const {
    return corners == other.corners && neighbors == other.neighbors;
  }
};

Arrays arrays_of(const Triangulation& made) {
  const auto size = static_cast<std::size_t>(3 * made.triangle_count);
  return {{made.corners.get(), made.corners.get() + size},
          {made.neighbors.get(), made.neighbors.get() + size},
          std::vector<char>(size, 0)};
}

Arrays arrays_of(const MeshEditor& mesh) {
  Team team(1, keep_going);
  const MeshArrays made(mesh, team);
  const std::size_t size = std::size_t{3} * made.triangle_count;
  return {{made.corners.get(), made.corners.get() + size},
          {made.neighbors.get(), made.neighbors.get() + size},
          {made.fixed.get(), made.fixed.get() + size}};
}

Arrays arrays_of(const RefinedSurface& made) {
  const std::size_t size = std::size_t{3} * made.triangle_count;
  return {{made.corners.get(), made.corners.get() + size},
          {made.neighbors.get(), made.neighbors.get() + size},
          {made.fixed.get(), made.fixed.get() + size}};
}

std::vector<double> xyz_of(const std::vector<Point>& points) {
  std::vector<double> xyz;
  for (const Point p : points) xyz.insert(xyz.end(), {p.x, p.y, p.x + 2.0 * p.y});
  return xyz;
}

Arrays triangulate(const std::vector<Point>& points, const Options& options) {
  const std::vector<double> xyz = xyz_of(points);
  const PointRows rows{xyz.data(), static_cast<std::int64_t>(points.size()), 3};
  return arrays_of(Triangulator(rows, options, keep_going).run());
}

MeshEditor editor_of_arrays(const std::vector<Point>& points, const Arrays& arrays) {
  const std::vector<double> xyz = xyz_of(points);
  const PointRows rows{xyz.data(), static_cast<std::int64_t>(points.size()), 3};
  return editor_of(rows, {arrays.corners.data(), arrays.neighbors.data(), nullptr, arrays.count()});
}

// Counter-clockwise triangles; across every edge a neighbour that knows it; every edge that is not
// fixed locally Delaunay, ties included, which is the whole triangulation's being so.
void prove(const std::vector<Point>& points, const Arrays& arrays, const std::string& name) {
  for (std::int32_t t = 0; t < arrays.count(); ++t) {
    const std::int32_t* c = arrays.corners.data() + 3 * std::size_t(t);
    const Point a = points[c[0]], b = points[c[1]], d = points[c[2]];
    expect(orientation(a, b, d) > 0, name + ": a triangle is counter-clockwise");
    for (int k = 0; k < 3; ++k) {
      const std::int32_t n = arrays.neighbors[3 * std::size_t(t) + k];
      if (n == kNoNeighbor) continue;
      const std::int32_t* back = arrays.neighbors.data() + 3 * std::size_t(n);
      const auto twin = std::find(back, back + 3, t) - back;
      expect(twin < 3, name + ": a neighbour knows its neighbour");
      if (twin == 3 || arrays.fixed[3 * std::size_t(t) + k] != 0) continue;
      const Point apex = points[arrays.corners[3 * std::size_t(n) + twin]];
      expect(!is_in_circle(a, b, d, apex), name + ": an edge is Delaunay");
    }
  }
}

std::vector<Point> random_points(int count, double cells, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1000.0);
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const Point p{unit(rng), unit(rng)};
    points.push_back(cells > 0.0 ? Point{std::floor(p.x / cells), std::floor(p.y / cells)} : p);
  }
  std::sort(points.begin(), points.end(), lexicographically_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::shuffle(points.begin(), points.end(), rng);
  return points;
}

void build_in_every_way(const std::vector<Point>& points, const std::string& name) {
  const Arrays wanted = triangulate(points, Options{});
  prove(points, wanted, name);
  for (const NamedPath& path : vector_paths()) {
    expect(triangulate(points, {Method::kGrowth, 3, path.path}) == wanted, name + ": " + path.name);
  }
  Options options;
  options.method = Method::kInsertion;
  expect(triangulate(points, options) == wanted, name + ": insertion builds the same");
}

// Insert what was left out, fix edges and release them, remove vertices and put them back: the
// arrays are those of all points.
void change(const std::vector<Point>& points) {
  const Arrays wanted = triangulate(points, Options{});
  const std::size_t half = points.size() / 2;
  const std::vector<Point> some(points.begin(), points.begin() + half);
  CheckedMesh mesh(editor_of_arrays(some, triangulate(some, Options{})));
  std::vector<std::int32_t> added(points.size() - half);
  mesh.insert(points.data() + half, static_cast<std::int32_t>(added.size()), added.data());
  expect(arrays_of(mesh.editor()) == wanted, "points inserted one by one build the same");

  const std::int32_t ends[] = {0, 1, 2, 3, 4, 5};
  const auto forced = mesh.force({ends, 3}, keep_going);
  prove(points, arrays_of(mesh.editor()), "with fixed edges");
  expect(forced.is_complete && mesh.has_fixed_edge(Vertex{0}), "an edge is fixed at its vertex");
  for (const Vertex v : mesh.editor().vertices()) {
    for (const Vertex w : mesh.fixed_neighbors(v)) {
      const std::int32_t edge[] = {number(v), number(w)};
      mesh.release({edge, 1});
    }
  }
  mesh.remove(added.data(), added.size());
  for (const std::int32_t v : added) mesh.put(Vertex{v}, points[v]);
  expect(arrays_of(mesh.editor()) == wanted, "edges released and vertices put back leave the same");
  try {
    mesh.clearance(Vertex{static_cast<std::int32_t>(points.size())});
    expect(false, "a vertex that is not there is refused");
  } catch (const std::invalid_argument&) {
  }
}

// Elevations are a plane's, so what is interpolated is known.
void locate(const std::vector<Point>& points) {
  const Arrays arrays = triangulate(points, Options{});
  const std::vector<double> xyz = xyz_of(points);
  const Locator locator({xyz.data(), arrays.corners.data(), arrays.neighbors.data(),
                         static_cast<std::int32_t>(points.size()),
                         static_cast<std::uint32_t>(arrays.count())});
  const std::vector<Point> queries = random_points(1000, 0.0, 7);
  std::vector<std::int32_t> found(queries.size());
  std::vector<double> elevation(queries.size());
  const auto count = static_cast<std::int64_t>(queries.size());
  expect(locator.locate(queries.data(), count, found.data(), keep_going), "all are located");
  locator.interpolate(queries.data(), count, elevation.data(), keep_going);
  std::int64_t inside = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    expect((found[i] == -1) == std::isnan(elevation[i]), "outside there is no elevation");
    if (found[i] == -1) continue;
    ++inside;
    const std::int32_t* c = arrays.corners.data() + 3 * std::size_t(found[i]);
    for (int k = 0; k < 3; ++k) {
      const int side = orientation(points[c[k]], points[c[(k + 1) % 3]], queries[i]);
      expect(side >= 0, "a triangle holds the point located in it");
    }
    const double plane = queries[i].x + 2.0 * queries[i].y;
    expect(std::fabs(elevation[i] - plane) < 1e-9 * 3000.0, "a plane is interpolated");
  }
  expect(inside > count / 2, "most queries are inside");
}

void refine_square() {
  const std::vector<Point> corners{{0, 0}, {100, 0}, {100, 10}, {0, 10}};
  const Arrays arrays = triangulate(corners, Options{});
  const auto fixed = std::make_unique<bool[]>(arrays.neighbors.size());
  for (std::size_t i = 0; i < arrays.neighbors.size(); ++i) {
    fixed[i] = arrays.neighbors[i] == kNoNeighbor;
  }
  const std::vector<double> xyz = xyz_of(corners);
  const GivenTriangles given{arrays.corners.data(), arrays.neighbors.data(), fixed.get(),
                             arrays.count()};
  const RefinementGoal goal{0.5, 5.0, INFINITY};
  Team team(1, keep_going);
  const Refined refined = refine({xyz.data(), 4, 3}, given, goal, {nullptr, 0}, 100000, team);
  expect(refined.ended == Refiner::Ended::kDone && refined.misses.empty(), "the goal is reached");
  std::vector<Point> all = corners;
  all.insert(all.end(), refined.points.begin(), refined.points.end());
  expect(refined.surface.has_value(), "the surface of the square is given back");
  const Arrays made = arrays_of(*refined.surface);
  prove(all, made, "refined");
  double area = 0.0;
  for (std::int32_t t = 0; t < made.count(); ++t) {
    const std::int32_t* c = made.corners.data() + 3 * std::size_t(t);
    const double size = 0.5 * detail::twice_area(all[c[0]], all[c[1]], all[c[2]]);
    expect(size <= 5.0, "no triangle is larger than asked for");
    area += size;
  }
  expect(std::fabs(area - 1000.0) < 1e-9, "the square is covered");
}

void meet() {
  const Point points[] = {{0, 0}, {10, 10}, {0, 10}, {10, 0}, {5, 0}};
  const std::int32_t ends[] = {0, 1, 2, 3, 0, 3}, pair[] = {0, 1};
  const Segments segments{points, ends, 3};
  Team team(2, keep_going);
  const ContactSearch contacts(segments, 5, 0.0, team);
  expect(contacts.crossings.size() == 1 && contacts.touches.size() == 1, "lines cross and touch");
  const std::vector<Point> met = find_intersections(segments, pair, 1, team);
  expect(met[0] == Point{5, 5}, "diagonals meet in the middle");
  const std::int32_t offsets[] = {0, 3};
  const Point ring[] = {{0, 0}, {10, 0}, {0, 10}}, queries[] = {{1, 1}, {5, 5}, {9, 9}};
  std::int8_t sides[3];
  PointInPolygon(ring, offsets, 1).locate(queries, 3, sides, team);
  expect(sides[0] == 1 && sides[1] == 0 && sides[2] == -1, "inside, on the ring, outside");
}

}  // namespace

int main() {
  build_in_every_way(random_points(3000, 0.0, 1), "random points");
  build_in_every_way(random_points(3000, 25.0, 2), "a raster with holes");
  change(random_points(800, 0.0, 3));
  locate(random_points(2000, 0.0, 5));
  refine_square();
  meet();
  return tell_faults();
}
