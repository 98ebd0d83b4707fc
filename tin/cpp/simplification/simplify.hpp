// Simplification of a surface: few of its points, such that the others are near the surface of
// these.
//
// Greedy insertion of the points farthest from the surface so far (Garland and Heckbert, "Fast
// polygonal approximation of terrains and height fields", 1995), then removal of those that later
// ones made needless (the decimation of Schroeder, Zarge and Lorensen, "Decimation of triangle
// meshes", 1992, with the error measured at every point). What comes first is decided by errors and
// coordinates alone, so the result is a function of the points and the fixed edges.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "../base/ids.hpp"
#include "candidate_mesh.hpp"

namespace tinsmith {

struct SimplificationGoal {
  double tolerance;   // the largest error that may be left
  std::int32_t most;  // vertices are inserted up to so many
  SideWeights weights = {};
};

struct Simplified {
  std::vector<std::int32_t> rows;  // of the vertices
  std::int32_t removed = 0;
  bool is_complete = true;  // false if `keep_going` was
};

// The farthest of all candidates is inserted, again and again, until there are so many vertices or
// none is beyond the tolerance. The mesh is a CandidateMesh, or another with its names.
template <typename MeasuredMesh>
class InsertionByError {
 public:
  InsertionByError(MeasuredMesh& mesh, const SimplificationGoal& goal) : mesh_(mesh), goal_(goal) {
    for (const Triangle t : mesh.mesh().triangles()) enter(t);
  }

  template <typename KeepGoing>
  bool run(KeepGoing&& keep_going) {
    std::uint32_t steps = 0;
    while (!heap_.empty() && mesh_.editor().count() < goal_.most) {
      const Entry next = pop();
      if (!is_current(next)) continue;
      if (!heap_.empty()) mesh_.expect(heap_.front().triangle);
      if (++steps % kStepsBetween == 0 && !keep_going()) return false;
      mesh_.insert(next.triangle, next.candidate, [this](Triangle t) { enter(t); });
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kStepsBetween = 64;

  struct Entry {
    double error;
    CandidateId candidate;
    Triangle triangle;
  };

  // The largest error comes first; of equal ones that of the lexicographically first candidate.
  auto comparison() const {
    return [this](const Entry& a, const Entry& b) {
      if (a.error != b.error) return a.error < b.error;
      return lexicographically_before(mesh_.place(b.candidate), mesh_.place(a.candidate));
    };
  }
  Entry pop() {
    std::pop_heap(heap_.begin(), heap_.end(), comparison());
    const Entry first = heap_.back();
    heap_.pop_back();
    return first;
  }

  // Whether the triangle has not changed since; if it has, the candidate may be nearer to it now.
  bool is_current(const Entry& entry) const {
    const auto& list = mesh_.list(entry.triangle);
    return list.worst == entry.candidate && list.error == entry.error;
  }

  void enter(Triangle t) {
    const auto& list = mesh_.list(t);
    if (list.worst == kNoCandidate || !(list.error > goal_.tolerance)) return;
    heap_.push_back({list.error, list.worst, t});
    std::push_heap(heap_.begin(), heap_.end(), comparison());
  }

  MeasuredMesh& mesh_;
  SimplificationGoal goal_;
  std::vector<Entry> heap_;
};

// Candidates are inserted until none is beyond the tolerance: those beyond a high level first, then
// those beyond lower ones. The candidates of a level come in rounds, each row by row, so that what is
// touched one after another is near in memory: down to 0.4 of the time of an insertion by error, for as
// many vertices when the needless ones are gone.
template <typename MeasuredMesh>
class InsertionByLevel {
 public:
  InsertionByLevel(MeasuredMesh& mesh, double tolerance)
      : mesh_(mesh), tolerance_(tolerance), level_(std::numeric_limits<double>::infinity()) {
    for (const Triangle t : mesh.mesh().triangles()) enter(t);
  }

  template <typename KeepGoing>
  bool run(KeepGoing&& keep_going) {
    std::uint32_t steps = 0;
    while (lower_level()) {
      while (!round_.empty()) {
        for (const Entry& next : take_round()) {
          if (!is_above_level(next)) continue;
          if (++steps % kStepsBetween == 0 && !keep_going()) return false;
          mesh_.insert(next.triangle, next.candidate, [this](Triangle t) { enter(t); });
        }
      }
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kStepsBetween = 64;
  static constexpr double kNextLevel = 0.7;  // of the largest error; half as much leaves 1 % more

  struct Entry {
    CandidateId candidate;
    Triangle triangle;
  };

  // Whether the triangle has not changed since, but to have the same candidate.
  bool is_current(const Entry& entry) const {
    return mesh_.list(entry.triangle).worst == entry.candidate;
  }
  double error(const Entry& entry) const { return mesh_.list(entry.triangle).error; }
  bool is_above_level(const Entry& entry) const {
    return is_current(entry) && error(entry) > level_;
  }

  void enter(Triangle t) {
    const auto& list = mesh_.list(t);
    if (list.worst == kNoCandidate || !(list.error > tolerance_)) return;
    (list.error > level_ ? round_ : later_).push_back({list.worst, t});
  }

  // False if nothing is left.
  bool lower_level() {
    double largest = tolerance_;
    for (const Entry& entry : later_) {
      if (is_current(entry)) largest = std::max(largest, error(entry));
    }
    level_ = std::max(kNextLevel * largest, tolerance_);
    if (!(level_ < largest)) level_ = tolerance_;  // the smallest of doubles, and infinity
    std::vector<Entry> waiting;
    waiting.swap(later_);
    for (const Entry& entry : waiting) {
      if (is_current(entry) && error(entry) > tolerance_) enter(entry.triangle);
    }
    return !round_.empty();
  }

  std::vector<Entry> take_round() {
    std::vector<Entry> taken;
    taken.swap(round_);
    std::sort(taken.begin(), taken.end(), [this](const Entry& a, const Entry& b) {
      return mesh_.comes_before(a.candidate, b.candidate);
    });
    return taken;
  }

  MeasuredMesh& mesh_;
  double tolerance_, level_;
  std::vector<Entry> round_, later_;  // beyond the level; beyond the tolerance alone
};

// Vertices without which nothing is beyond the tolerance are removed, row by row; then those are
// looked at again whose triangles have changed, until each is needed. To remove those first that are
// missed least left as many and took longer.
template <typename MeasuredMesh>
class Removal {
 public:
  // The vertices before `first` stay, and so do those with a fixed edge.
  Removal(MeasuredMesh& mesh, Vertex first, double tolerance)
      : mesh_(mesh), first_(first), tolerance_(tolerance) {
    const MeshEditor& editor = mesh.editor();
    is_changed_.resize(static_cast<std::size_t>(editor.slots()), false);
    for (std::int32_t v = number(first); v < editor.slots(); ++v) change(Vertex{v});
  }

  // The number removed; -1 if `keep_going` was false.
  template <typename KeepGoing>
  std::int32_t run(KeepGoing&& keep_going) {
    std::uint32_t steps = 0;
    std::int32_t removed = 0;
    while (!changed_.empty()) {
      for (const Vertex v : take_changed()) {
        if (++steps % kStepsBetween == 0 && !keep_going()) return -1;
        is_changed_[static_cast<std::size_t>(number(v))] = false;
        if (is_needed(v)) continue;
        remove(v);
        ++removed;
      }
    }
    return removed;
  }

 private:
  static constexpr std::uint32_t kStepsBetween = 64;

  void change(Vertex v) {
    if (v < first_ || is_changed_[static_cast<std::size_t>(number(v))]) return;
    is_changed_[static_cast<std::size_t>(number(v))] = true;
    changed_.push_back(v);
  }

  std::vector<Vertex> take_changed() {
    std::vector<Vertex> taken;
    taken.swap(changed_);
    std::sort(taken.begin(), taken.end(),
              [this](Vertex v, Vertex w) { return mesh_.comes_before(v, w); });
    return taken;
  }

  bool is_needed(Vertex v) {
    return mesh_.editor().has_fixed_edge(v) || !(mesh_.error_without(v, tolerance_) <= tolerance_);
  }

  void remove(Vertex v) {
    for (const HalfEdge e : mesh_.mesh().around(v)) change(mesh_.mesh().to(e));
    mesh_.remove(v);
  }

  MeasuredMesh& mesh_;
  Vertex first_;
  double tolerance_;
  std::vector<bool> is_changed_;  // of each vertex, whether it was not looked at since
  std::vector<Vertex> changed_;
};

// Insert what is beyond the tolerance and remove what became needless; or insert up to the number of
// vertices, if none is to be removed. The vertices before `first` stay.
template <typename MeasuredMesh, typename KeepGoing>
Simplified simplify_mesh(MeasuredMesh& mesh, Vertex first, const SimplificationGoal& goal,
                         bool prunes, KeepGoing&& keep_going) {
  Simplified found;
  if (prunes) {
    found.is_complete = InsertionByLevel(mesh, goal.tolerance).run(keep_going);
    found.removed = found.is_complete ? Removal(mesh, first, goal.tolerance).run(keep_going) : -1;
    found.is_complete = found.removed >= 0;
  } else {
    found.is_complete = InsertionByError(mesh, goal).run(keep_going);
  }
  for (const Vertex v : mesh.editor().vertices()) {
    if (mesh.mesh().is_alive(v)) found.rows.push_back(mesh.row(v));
  }
  std::sort(found.rows.begin(), found.rows.end());
  return found;
}

// What is to be simplified: rows of easting, northing and elevation, those of the mesh's vertices,
// and the triangle that holds each.
struct SurfaceRows {
  const double* points;
  std::int32_t count;
  const std::int32_t* vertex_rows;
  const std::int32_t* triangles;
};

// The vertices of the mesh stay. Needless vertices are removed if that is asked for.
template <typename KeepGoing>
Simplified simplify(MeshEditor& editor, const SurfaceRows& rows, const SimplificationGoal& goal,
                    bool prunes, KeepGoing&& keep_going) {
  const Vertex first{editor.slots()};
  CandidateMesh mesh(editor, rows.points, rows.count, rows.vertex_rows, goal.weights);
  if (!mesh.place_all(rows.triangles, keep_going)) return {{}, 0, false};
  return simplify_mesh(mesh, first, goal, prunes, keep_going);
}

}  // namespace tinsmith
