// The kernels of terrain without Python: contours, bands, volumes, the overlay, rasters and the water
// of planes, whose answers are known. Prints what is wrong and returns 1, or prints "sound".
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "earthwork/overlay.hpp"
#include "earthwork/storage.hpp"
#include "earthwork/volumes.hpp"
#include "expectations.hpp"
#include "gridding/centers.hpp"
#include "gridding/means.hpp"
#include "hydrology/cells.hpp"
#include "hydrology/channels.hpp"
#include "hydrology/network.hpp"
#include "isolines/band_filling.hpp"
#include "isolines/line_arrays.hpp"
#include "isolines/line_smoothing.hpp"
#include "location/locator.hpp"
#include "sight/seen_vertices.hpp"
#include "simplification/row_errors.hpp"
#include "triangulation.hpp"

using namespace tinsmith;

namespace {

bool is_close(double value, double wanted) { return std::fabs(value - wanted) < 1e-7; }

// A square of 100 by 100 with points inside, on the plane base + slope * x + north * y.
struct Plane {
  std::vector<double> xyz;
  Triangulation made;

  Plane(double base, double slope, unsigned seed, double north = 0.0) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> unit(0.0, 100.0);
    std::vector<Point> points{{0, 0}, {100, 0}, {100, 100}, {0, 100}};
    for (int i = 0; i < 500; ++i) points.push_back({unit(rng), unit(rng)});
    for (const Point p : points)
      xyz.insert(xyz.end(), {p.x, p.y, base + slope * p.x + north * p.y});
    const PointRows rows{xyz.data(), static_cast<std::int64_t>(points.size()), 3};
    made = Triangulator(rows, Options{}, keep_going).run();
  }

  Surface surface() const {
    return {xyz.data(), made.corners.get(), made.neighbors.get(),
            static_cast<std::int32_t>(xyz.size() / 3),
            static_cast<std::uint32_t>(made.triangle_count)};
  }
};

void see() {
  const Plane plane(0.0, 0.1, 1);
  const Surface surface = plane.surface();
  Team team(2, keep_going);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double height : {1.0, -1.0}) {
    const sight::View view{{{30.5, 40.5}, 3.05 + height}, 0.0, infinite};
    std::vector<sight::Sight> seen(plane.xyz.size() / 3, sight::Sight::kSeen);
    sight::find_seen_vertices(surface, view, 0.0, seen.data(), team);
    std::size_t count = 0;
    for (const sight::Sight one : seen) count += one == sight::Sight::kSeen;
    expect(height < 0.0 ? count < 10 : count == seen.size(), "a plane is seen from above alone");
  }
}

// Cells of a row, some without an elevation, beside a plane: the search of each vector path finds what
// one cell after another tells, to the last bit.
void search_far_rows() {
  constexpr std::int32_t kMost = 40;
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<double> z(kMost + kMostLanes), steps(kMost + kMostLanes);
  for (std::size_t i = 0; i < z.size(); ++i) {
    z[i] = rng() % 5 == 0 ? kNoElevation : unit(rng);
    steps[i] = static_cast<double>(i);
  }
  for (std::int32_t first = 0; first < kMost; ++first) {
    for (std::int32_t last = first; last < kMost; ++last) {
      const CellPlane plane(CellTriangle{{{0, 0}, {7, -2}, {3, 5}}, {unit(rng), unit(rng), 0.3}});
      const CellRow row{0, first, last};
      double wanted = -kInfinity;
      for (std::int32_t i = 0; i <= last - first; ++i) {
        const double error = std::fabs(z[first + i] - (plane.at(first, 0) + plane.east() * i));
        if (error > wanted) wanted = error;
      }
      for (const NamedPath& path : vector_paths()) {
        const PlaneOverRows over{plane, z.data(), kMost, steps.data()};
        const FarRow far = far_row_search(path.path)(over, &row, &row + 1, 0.25);
        const bool is_far = wanted >= 0.25;
        expect(far.row == (is_far ? &row : &row + 1), std::string(path.name) + ": the far row");
        expect(!is_far || far.error == wanted, std::string(path.name) + ": the error in a row");
      }
    }
  }
}

void contour() {
  const Plane plane(0.0, 0.1, 1);
  const std::vector<double> values{2.0, 5.0};
  const isolines::Levels levels{values.data(), 2};
  Team team(1, keep_going);
  const isolines::TracedLines lines = isolines::trace_lines(plane.surface(), levels, team);
  const isolines::LineArrays arrays(lines, levels);
  expect(arrays.count == 2, "a plane has one line a level");
  for (std::size_t k = 0; k < arrays.count; ++k) {
    expect(is_close(arrays.length[k], 100.0), "a line runs straight across the square");
  }
  const isolines::TracedLines again =
      isolines::lines_of({arrays.xyz.get(), arrays.offsets.get(), arrays.level.get(),
                          arrays.is_closed.get(), arrays.count},
                         levels);
  expect(again.points.size() == lines.points.size(), "lines come back from their arrays");
  const isolines::Bands bands = isolines::fill_bands(plane.surface(), levels, team);
  expect(bands.band.size() == 3, "two levels divide the square into three");
}

void refuse_open_boundary() {
  for (const Point end : {Point{2, 2}, Point{0, -1}}) {
    try {
      isolines::RingTracer({{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, end}}).trace();
      expect(false, "a boundary that does not close is refused");
    } catch (const std::logic_error&) {
    }
  }
}

// With points only where the line turns: none but its ends.
void simplify() {
  const Plane plane(0.0, 0.1, 1);
  const double level = 5.0;
  const isolines::Levels levels{&level, 1};
  Team team(1, keep_going);
  const isolines::TracedLines lines = isolines::trace_lines(plane.surface(), levels, team);
  const std::vector<Point> points(lines.points.begin(), lines.points.end());
  std::vector<std::int32_t> triangles(points.size());
  Locator(plane.surface())
      .locate(points.data(), static_cast<std::int64_t>(points.size()), triangles.data(),
              keep_going);
  isolines::LineSmoother smoother(plane.surface(), levels, lines, triangles.data(), team);
  smoother.simplify(0.01);
  expect(smoother.take().points.size() < points.size() / 2, "a straight line needs few points");
}

// The planes 0 and -1 + x / 50 meet at x = 50: a wedge of 2500 is cut, another one filled.
void measure_earthwork() {
  const Plane flat(0.0, 0.0, 2), ramp(-1.0, 0.02, 3);
  const std::vector<std::int32_t> groups(flat.surface().triangle_count, 0);
  for (const int threads : {1, 3}) {
    Team team(threads, keep_going);
    const auto sums =
        earthwork::sum_between(flat.surface(), groups.data(), 1, ramp.surface(), true, 1.0, team);
    const auto row = sums[0].values();
    expect(is_close(row[0], 10000.0), "the whole square is compared");
    expect(is_close(row[3], 2500.0) && is_close(row[4], 2500.0), "two wedges are cut and filled");
  }
  Team team(1, keep_going);
  const earthwork::Overlay overlay(flat.surface(), ramp.surface(), true, team);
  double area = 0.0;
  for (std::size_t cell = 0; cell + 1 < overlay.offsets.size(); ++cell) {
    const auto first = overlay.offsets[cell], last = overlay.offsets[cell + 1] - 1;
    for (std::int64_t i = first, j = last; i <= last; j = i++) {
      const auto& p = overlay.vertices[number(overlay.corners[j])];
      const auto& q = overlay.vertices[number(overlay.corners[i])];
      area += 0.5 * (p.x * q.y - p.y * q.x);
    }
  }
  expect(is_close(area, 10000.0), "the cells of the overlay cover the square");
  const double level = 0.0;
  const auto stored = earthwork::Storage(ramp.surface(), &level, 1, 1.0, team).rows();
  expect(is_close(stored[0][0], 5000.0), "half of the ramp lies under its middle");
  expect(is_close(stored[0][2], 2500.0), "and holds a wedge");
}

void draw_raster() {
  const Plane plane(3.0, 0.1, 4);
  std::vector<double> centers, northings, edges, north_edges;
  for (int i = 0; i < 10; ++i) centers.push_back(5.0 + 10.0 * i);
  for (int i = 0; i <= 10; ++i) edges.push_back(10.0 * i);
  northings.assign(centers.rbegin(), centers.rend());
  north_edges.assign(edges.rbegin(), edges.rend());
  const CellGrid grid{centers.data(), northings.data(), 10, 10, 10.0, 10.0};
  std::vector<double> values(100), means(100);
  Team team(2, keep_going);
  const OrderedSurface ordered(plane.surface());
  const ElevationPaint paint{ordered, values.data()};
  CenterScan<ElevationPaint>::run(ordered, grid, paint, team);
  MeanScan::run(ordered, grid, edges.data(), north_edges.data(), nullptr, means.data(), team);
  for (int i = 0; i < 100; ++i) {
    const double wanted = 3.0 + 0.1 * centers[i % 10];
    expect(is_close(values[i], wanted), "a cell has the plane's elevation at its centre");
    expect(is_close(means[i], wanted), "which is its mean");
  }
}

// How the triangles of a plane fall: to the west, and a little to the south.
struct FallingPlane {
  static constexpr double kEast = 0.1, kNorth = 0.03;

  Plane plane{0.0, kEast, 6, kNorth};
  std::vector<std::int8_t> signs;
  std::vector<double> values, areas;
  hydrology::FallingSurface falls{plane.surface(), nullptr, nullptr};
  std::vector<hydrology::Base> bases;

  FallingPlane() {
    const Ids<Triangle> triangles(falls.surface.triangle_count);
    for (const Triangle t : triangles) {
      for (const HalfEdge e : half_edges(t)) values.push_back(measure_fall(e));
      areas.push_back(measure_area(t));
    }
    for (const double fall : values) signs.push_back(fall > 0.0 ? 1 : fall < 0.0 ? -1 : 0);
    falls.signs = signs.data();
    falls.values = values.data();
    for (const Triangle t : triangles) bases.push_back(falls.base(t));
  }

 private:
  // Out of the triangle across an edge, in proportion.
  double measure_fall(HalfEdge e) const {
    const Point start = falls.surface.point(falls.start(e));
    const Point end = falls.surface.point(falls.end(e));
    return kEast * (start.y - end.y) - kNorth * (start.x - end.x);
  }

  double measure_area(Triangle t) const {
    Point corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = falls.surface.point(falls.surface.vertex(t, k));
    const auto [a, b, c] = corner;
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
  }
};

std::vector<std::int32_t> count_up(std::int32_t count) {
  std::vector<std::int32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

// The water of a plane, from strips and vertices down.
class Drainage {
 public:
  Drainage() {
    hydrology::StripCutter cutter(plane_.falls, plane_.bases.data(), pulse_);
    cutter.cut(1'000'000, offsets_.data());
    strip_count_ = static_cast<std::int32_t>(cutter.size());
    starts_ = cutter.take_starts();
    nexts_ = count_up(nodes().count());
    uppers_ = nexts_;
    link_strips();
    link_vertices();
  }

  hydrology::Nodes nodes() const { return {strip_count_, vertex_count(), grounds_.data()}; }
  std::size_t undecided_count() const { return undecided_.size(); }

  std::vector<std::int32_t> find_ends() {
    std::vector<std::int32_t> ends(nexts_.size());
    hydrology::find_ends(nexts_.data(), nodes().count(), ends.data(), pulse_);
    return ends;
  }

  std::vector<double> sum_areas() {
    std::vector<double> totals(nexts_.size());
    hydrology::measure_strips(strips(), plane_.bases.data(), plane_.areas.data(),
                              plane_.falls.surface.triangle_count, totals.data());
    hydrology::accumulate(nexts_.data(), nodes().count(), totals.data(), pulse_);
    return totals;
  }

 private:
  std::int32_t vertex_count() const { return plane_.falls.surface.point_count; }
  hydrology::Strips strips() const { return {offsets_.data(), starts_.get()}; }

  void link_strips() {
    const hydrology::Strips cut = strips();
    const hydrology::Nodes all = nodes();
    hydrology::StripLinks(plane_.falls, plane_.bases.data(), filling_, cut, all)
        .run(nexts_.data(), uppers_.data(), team_);
  }

  void link_vertices() {
    const auto is_boundary = std::make_unique<bool[]>(vertex_count());
    std::fill_n(is_boundary.get(), 4, true);  // the corners of the square come first
    const hydrology::ExitTable exits(plane_.falls, filling_, is_boundary.get(), team_);
    const hydrology::Nodes all = nodes();
    undecided_ = hydrology::VertexLinks(plane_.falls, plane_.bases.data(), filling_, exits, all)
                     .run(&nexts_[strip_count_], &uppers_[strip_count_], team_);
  }

  const FallingPlane plane_;
  const hydrology::Filling filling_;
  const std::vector<std::int32_t> grounds_ = count_up(vertex_count());
  Team team_{1, keep_going};
  Pulse pulse_{team_};
  std::vector<std::int64_t> offsets_ =
      std::vector<std::int64_t>(std::size_t{plane_.falls.surface.triangle_count} + 1);
  StreamedArray<double> starts_;
  std::int32_t strip_count_ = 0;
  std::vector<std::int32_t> nexts_, uppers_;
  std::vector<Vertex> undecided_;
};

// The water of the whole square leaves it.
void drain() {
  Drainage drainage;
  const hydrology::Nodes nodes = drainage.nodes();
  expect(drainage.undecided_count() == 0, "on a plane doubles decide where water goes");
  if (drainage.undecided_count() > 0) return;
  const std::vector<std::int32_t> ends = drainage.find_ends();
  for (std::int32_t i = 0; i < nodes.first_vertex + nodes.vertex_count; ++i) {
    expect(ends[i] == nodes.outside(), "all water leaves a plane");
  }
  expect(is_close(drainage.sum_areas()[nodes.outside()], 10000.0), "that of the whole square");
}

// Two strips and their vertex run down one edge.
void follow_channels() {
  const std::vector<std::int32_t> uppers{0, 0, 0, -1}, nexts{3, 3, 3, 3};
  const std::vector<double> totals{5.0, 2.0, 1.0, 8.0};
  const hydrology::ChannelSums sums(uppers.data(), nexts.data(), 4, 2, 2);
  const auto channels = sums.sum(totals.data(), 2);
  expect(channels.size() == 1 && channels[0].area == 8.0, "one channel has the water of all");
}

// From the middle of its base to its apex.
void cut_triangle() {
  const std::int32_t corners[3] = {0, 1, 2}, lower = 3, upper = 2;
  const std::int64_t ranges[6] = {0, 1, 0, 0, 0, 0}, offsets[2] = {0, 1};
  const hydrology::CutTriangles given{1, corners, ranges, 3, offsets, &lower, &upper};
  const hydrology::CutCells cells = hydrology::CellCutter(given).run();
  expect(cells.offsets == std::vector<std::int64_t>{0, 3, 6}, "a cut makes two cells");
}

}  // namespace

int main() {
  contour();
  see();
  search_far_rows();
  refuse_open_boundary();
  simplify();
  measure_earthwork();
  draw_raster();
  drain();
  follow_channels();
  cut_triangle();
  return tell_faults();
}
