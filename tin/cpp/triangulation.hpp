// The main path: index the points, find the hull, grow, number by the caller's rows. The triangles
// of a lattice are written as they are.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/arrays.hpp"
#include "base/ids.hpp"
#include "base/parallel.hpp"
#include "base/point.hpp"
#include "growth/growth.hpp"
#include "growth/growth_sample.hpp"
#include "growth/stitch.hpp"
#include "growth/work_stealing.hpp"
#include "hull/convex_hull.hpp"
#include "index/grid.hpp"
#include "insertion/canonical_order.hpp"
#include "insertion/insertion.hpp"
#include "lattice/hole_filling.hpp"
#include "lattice/lattice.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_order.hpp"
#include "search/neighborhood_paths.hpp"

namespace tinsmith {

// Automatic: as a lattice, or by growth, or by insertion where growth costs too much.
enum class Method { kAutomatic, kGrowthOrInsertion, kGrowth, kInsertion };

// How to build; the result is the same for all.
struct Options {
  Method method = Method::kAutomatic;
  int threads = 1;
  VectorPath path = vector_paths().back().path;
  bool keeps_sweep = false;  // number vertices in the sweep, where neighbours lie side by side
  bool is_for_mesh = false;  // what insertion made is not put in order, as it will be changed
};

struct Triangulation {
  StreamedArray<std::int32_t> corners;    // 3 a triangle, by vertex
  StreamedArray<std::int32_t> neighbors;  // 3 a triangle, kNoNeighbor outside
  std::int64_t triangle_count = 0;
  std::vector<std::int32_t> kept_row;  // empty if all rows are kept
  std::int64_t distinct_count = 0;
  StreamedArray<std::int32_t> rows;  // of each vertex in the sweep, if these are the numbers
  StreamedArray<Point> places;       // likewise
  // If it is for a mesh: the vertices in the order of the sweep, unless they are of a lattice; and
  // what was inserted, closed by ghosts, in place of corners and neighbours.
  std::vector<Vertex> sweep;
  ScratchArray<GhostTriangle> inserted;
  std::uint32_t inserted_count = 0;
  SearchCounts counts;
  bool is_complete = true;  // false if asked to stop

  Triangles arrays() const { return {corners.get(), neighbors.get()}; }
};

class Triangulator {
 public:
  // `keep_going` is asked now and then, on the calling thread, whether to go on; the vertices that
  // growth takes up are counted in `progress`.
  Triangulator(const PointRows& rows, const Options& options, std::function<bool()> keep_going,
               Progress* progress = nullptr)
      : rows_(rows),
        options_(options),
        team_(static_cast<int>(std::min<std::int64_t>(options.threads, rows.count)),
              std::move(keep_going), progress) {}

  // Delaunay triangulation of one or more rows. No triangles if all points are collinear.
  Triangulation run() {
    triangulate();
    result_.is_complete = !team_.is_stopped();
    return std::move(result_);
  }

 private:
  void triangulate() {
    if (options_.method == Method::kAutomatic && is_lattice()) return;
    PointGrid grid(rows_, team_);
    if (!team_.keeps_going(0)) return;
    result_.kept_row = grid.kept_row();
    result_.distinct_count = grid.count();
    if (grid.count() < 3) return;
    rows_of_ = grid.rows();
    if (options_.keeps_sweep) keep_sweep(grid);
    if (options_.is_for_mesh) list_sweep(grid);
    if (!is_worth_growing(grid)) return insert_all(grid);
    std::vector<Vertex> hull = HullFinder(grid, team_).find();
    if (hull.empty() || !team_.keeps_going(0)) return;
    result_.triangle_count = triangle_count(grid.count(), static_cast<std::int64_t>(hull.size()));
    const bool is_grown = with_path(options_.path, [&](auto tag) {
      using Near = typename decltype(tag)::Type;
      if (may_insert() && !GrowthSample<Near>(grid, hull).is_cheap()) return false;
      return grow<Near>(grid, hull);
    });
    if (is_grown || team_.is_stopped()) return;
    free_memory(hull);
    insert_all(grid);
  }

  // ------------------------------------------------------------- lattices

  // Whether the points lie on a lattice, so that its triangles are made, or the team is stopped.
  bool is_lattice() {
    const std::optional<Lattice> lattice = Lattice::of(rows_, team_);
    if (!lattice) return false;
    const LatticeCells cells(*lattice, team_);
    if (cells.points() < rows_.count || !is_mostly_certain(cells)) return false;
    HoleFilling holes(cells);
    for (std::int32_t row = 0; row < lattice->rows(); ++row) {
      if (!team_.keeps_going(0)) return true;
      holes.fill_small(row);
    }
    if (!fill_rest(*lattice, holes)) return true;
    result_.distinct_count = rows_.count;
    result_.triangle_count = cells.certain() + static_cast<std::int64_t>(holes.triangles().size());
    if (result_.triangle_count != triangle_count(rows_.count, holes.outside_edges())) {
      throw std::logic_error("the triangles of a lattice do not fill its hull");
    }
    const auto entries = static_cast<std::size_t>(3 * result_.triangle_count);
    result_.corners = quickly_streamed_array<std::int32_t>(entries);
    result_.neighbors = quickly_streamed_array<std::int32_t>(entries);
    write_lattice(cells, holes);
    return true;
  }

  // Holes cost more than growth where fewer of the triangles than this are certain.
  static constexpr double kLeastCertain = 0.8;

  static bool is_mostly_certain(const LatticeCells& cells) {
    const std::int64_t around = cells.lattice().columns() + cells.lattice().rows();
    const auto expected = static_cast<double>(2 * (cells.points() - around));
    return cells.certain() > 0 && static_cast<double>(cells.certain()) >= kLeastCertain * expected;
  }

  // Fill the holes that are not small. False if the team is stopped.
  bool fill_rest(const Lattice& lattice, HoleFilling& holes) {
    const std::vector<std::int32_t> places = holes.places_left();
    if (places.size() < 3) return true;
    std::vector<Point> points;
    points.reserve(places.size());
    for (const std::int32_t place : places) points.push_back(lattice.point(place));
    Options options;
    options.method = Method::kGrowthOrInsertion;
    options.threads = options_.threads;
    options.path = options_.path;
    const auto count = static_cast<std::int64_t>(points.size());
    const Triangulation made = Triangulator({&points[0].x, count, 2}, options, [this] {
                                 return team_.keeps_going(0);
                               }).run();
    if (!made.is_complete) return false;
    holes.fill_rest(places, made.corners.get(), made.neighbors.get(), made.triangle_count);
    return true;
  }

  void write_lattice(const LatticeCells& cells, const HoleFilling& holes) {
    const Lattice& lattice = cells.lattice();
    LatticeOrder order(cells, holes, team_);
    team_.expect(static_cast<std::int64_t>(2 * lattice.stripes().size()));
    if (!options_.keeps_sweep) {
      if (!order.number_all([](std::int32_t, std::int32_t) {})) return;
      order.write(result_.arrays(), [&](std::int32_t place) { return lattice.at(place); });
      return;
    }
    result_.rows = streamed_array<std::int32_t>(rows_.count);
    result_.places = streamed_array<Point>(rows_.count);
    const ScratchArray<std::int32_t> number = scratch_array<std::int32_t>(lattice.places());
    const bool is_numbered = order.number_all([&](std::int32_t position, std::int32_t place) {
      number[place] = position;
      result_.rows[position] = lattice.at(place);
      result_.places[position] = rows_[lattice.at(place)];
    });
    if (!is_numbered) return;
    order.write(result_.arrays(), [&](std::int32_t place) { return number[place]; });
  }

  // ------------------------------------------------------------- all other points

  static constexpr std::int32_t kLeastToInsert = 1000;

  // Whether growth is asked for, or may cost less than insertion.
  bool is_worth_growing(const PointGrid& grid) const {
    if (!may_insert()) return options_.method == Method::kGrowth;
    return grid.count() <= kLeastToInsert || !HullFinder::is_of_curve(grid);
  }

  bool may_insert() const {
    return options_.method == Method::kAutomatic || options_.method == Method::kGrowthOrInsertion;
  }

  // What a thread made of a task.
  struct alignas(kCacheLine) Grown {
    explicit Grown(TriangleStore made) : store(std::move(made)) {}
    TriangleStore store;
    int task = 0;
    Triangle last_shared = kNoTriangle;
    SearchCounts counts;
  };

  // Returns whether all triangles are made.
  template <typename Near>
  bool grow(const PointGrid& grid, const std::vector<Vertex>& hull) {
    allocate();
    WorkStealing work(grid.count(), team_.size());
    std::vector<std::vector<Grown>> grown(team_.size());
    std::atomic<bool> is_too_costly{false};
    team_.expect(grid.count());
    team_.run([&](int part) {
      for (int task = part; task != WorkStealing::kNone; task = work.steal()) {
        const Range own = work.range(task);
        grown[part].emplace_back(task == 0 ? TriangleStore(result_.arrays())
                                           : TriangleStore(expected_triangles(own)));
        Grown& made = grown[part].back();
        Growth<Near> growth(grid, hull, own, made.store);
        const Outcome outcome =
            growth.run([&] { return !is_too_costly && team_.keeps_going(part); }, may_insert(),
                       [&] {
                         const Range block = work.next_block(task);
                         team_.advance(block.size());
                         return block;
                       });
        if (outcome == Outcome::kTooCostly) is_too_costly = true;
        made.task = task;
        made.counts = growth.counts();
        made.last_shared = growth.last_shared();
        if (outcome != Outcome::kComplete) return;
      }
    });
    std::vector<Grown> all;
    for (std::vector<Grown>& part : grown) {
      for (Grown& made : part) {
        result_.counts += made.counts;
        all.push_back(std::move(made));
      }
    }
    if (is_too_costly || team_.is_stopped()) return false;
    stitch(work, all);
    return true;
  }

  // Two a vertex, with room for those that a neighbouring task finds too.
  static std::int64_t expected_triangles(Range own) {
    return std::int64_t{2} * own.size() + own.size() / 8 + 1024;
  }

  void stitch(WorkStealing& work, std::vector<Grown>& grown) {
    if (grown.size() == 1) return number_by_rows();
    std::sort(grown.begin(), grown.end(), [&](const Grown& a, const Grown& b) {
      return work.range(a.task).begin < work.range(b.task).begin;
    });
    const auto count = static_cast<int>(grown.size());
    std::vector<GrownPart> parts(grown.size());
    team_.run([&](int member) {
      for (int i = member; i < count; i += team_.size()) {
        parts[i] = GrownPart(work.range(grown[i].task), grown[i].store.arrays(),
                             grown[i].store.size(), grown[i].last_shared);
      }
    });
    std::vector<std::uint32_t> base{0};
    for (const GrownPart& part : parts) base.push_back(base.back() + part.kept());
    team_.run([&](int member) {
      for (int i = member; i < count; i += team_.size()) {
        parts[i].write(base[i], result_.arrays(), [this](Vertex v) {
          return options_.keeps_sweep ? Row{number(v)} : rows_of_[number(v)];
        });
      }
    });
    join_open_edges(parts, result_.arrays());
  }

  void allocate() {
    result_.corners = streamed_array<std::int32_t>(3 * result_.triangle_count);
    result_.neighbors = streamed_array<std::int32_t>(3 * result_.triangle_count);
  }

  // All memory of the growth, and of what is not needed for this, is given back first.
  void insert_all(PointGrid& grid) {
    result_.corners.reset();
    result_.neighbors.reset();
    grid.drop_cells();
    release_freed_memory();
    Insertion insertion(grid, team_);
    if (!insertion.run()) return;
    result_.counts.walk_steps = insertion.walk_steps();
    if (options_.is_for_mesh) {
      insertion.number_by(rows_of_);
      result_.inserted_count = insertion.triangles().count();
      result_.inserted = insertion.take();
      return;
    }
    insertion.number_by_sweep();
    CanonicalOrder order(grid, insertion.triangles(), team_);
    if (!order.count()) return;
    result_.triangle_count = order.triangles();
    allocate();
    if (!order.write(result_.arrays())) return;
    number_by_rows();
  }

  void keep_sweep(const PointGrid& grid) {
    const auto count = static_cast<std::size_t>(grid.count());
    result_.rows = streamed_array<std::int32_t>(count);
    result_.places = streamed_array<Point>(count);
    for (const Vertex v : Ids<Vertex>(grid.count())) {
      result_.rows[number(v)] = number(rows_of_[number(v)]);
      result_.places[number(v)] = grid.point(v);
    }
  }

  void list_sweep(const PointGrid& grid) {
    result_.sweep.reserve(grid.count());
    for (const Vertex v : Ids<Vertex>(grid.count())) {
      result_.sweep.push_back(Vertex{number(rows_of_[number(v)])});
    }
  }

  void number_by_rows() {
    if (options_.keeps_sweep) return;
    team_.run([this](int part) {
      const Range range = part_of(result_.triangle_count, part, team_.size());
      for (std::int64_t i = std::int64_t{3} * range.begin; i < std::int64_t{3} * range.end; ++i) {
        result_.corners[i] = number(rows_of_[result_.corners[i]]);
      }
    });
  }

  PointRows rows_;
  Options options_;
  Team team_;
  const Row* rows_of_ = nullptr;  // of each position, while the grid lives
  Triangulation result_;
};

}  // namespace tinsmith
