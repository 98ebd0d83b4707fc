// Simplification of a surface: few of its points, such that the others are near the surface of
// these.
//
// Greedy insertion of the point farthest from the surface so far (Garland and Heckbert, "Fast
// polygonal approximation of terrains and height fields", 1995), then greedy removal of those
// that later ones made needless (the decimation of Schroeder, Zarge and Lorensen, "Decimation of
// triangle meshes", 1992, with the error measured at every point). Equal errors are told apart by
// the points' coordinates, so the result is a function of the points and the fixed edges.
#pragma once

#include <algorithm>
#include <cstdint>
#include <queue>
#include <vector>

#include "../base/ids.hpp"
#include "candidate_mesh.hpp"

namespace tinsmith {

struct SimplificationGoal {
  double tolerance;   // the largest error that may be left
  std::int32_t most;  // vertices are inserted up to so many
};

struct Simplified {
  std::vector<std::int32_t> rows;  // of the vertices
  std::int32_t removed = 0;
  bool is_complete = true;  // false if `keep_going` was
};

// Vertices are inserted until no candidate is beyond the tolerance. The mesh is a CandidateMesh, or
// another with its names.
template <typename MeasuredMesh>
class GreedyInsertion {
 public:
  GreedyInsertion(MeasuredMesh& mesh, const SimplificationGoal& goal) : mesh_(mesh), goal_(goal) {
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

// Vertices are removed, those that are missed least first, until each is needed. One whose triangles
// have changed is measured again when its turn comes, or else when none is left that can go.
template <typename MeasuredMesh>
class GreedyRemoval {
 public:
  // The vertices before `first` stay, and so do those with a fixed edge.
  GreedyRemoval(MeasuredMesh& mesh, Vertex first, double tolerance)
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
    do {
      for (const Vertex v : take_changed()) {
        if (++steps % kStepsBetween == 0 && !keep_going()) return -1;
        enter(v);
      }
      while (!queue_.empty()) {
        const Vertex next = queue_.top().vertex;
        queue_.pop();
        if (++steps % kStepsBetween == 0 && !keep_going()) return -1;
        if (is_changed(next)) {
          enter(next);
        } else {
          remove(next);
          ++removed;
        }
      }
    } while (!changed_.empty());
    return removed;
  }

 private:
  static constexpr std::uint32_t kStepsBetween = 64;

  struct Entry {
    double error;
    Point at;
    Vertex vertex;

    bool operator<(const Entry& other) const {  // the smallest comes first
      if (error != other.error) return error > other.error;
      return lexicographically_before(other.at, at);
    }
  };

  bool is_changed(Vertex v) const { return is_changed_[static_cast<std::size_t>(number(v))]; }

  void change(Vertex v) {
    if (v < first_ || is_changed(v)) return;
    is_changed_[static_cast<std::size_t>(number(v))] = true;
    changed_.push_back(v);
  }

  // Those that were not measured since, from west to east: neighbours soon after each other, while
  // what they touch is in the cache.
  std::vector<Vertex> take_changed() {
    const MeshEditor& editor = mesh_.editor();
    std::vector<Vertex> taken;
    for (const Vertex v : changed_) {
      if (is_changed(v) && editor.mesh().is_alive(v)) taken.push_back(v);
    }
    changed_.clear();
    std::sort(taken.begin(), taken.end(), [&](Vertex v, Vertex w) {
      return lexicographically_before(editor.point(v), editor.point(w));
    });
    taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
    return taken;
  }

  void enter(Vertex v) {
    is_changed_[static_cast<std::size_t>(number(v))] = false;
    if (mesh_.editor().has_fixed_edge(v)) return;
    const double error = mesh_.error_without(v, tolerance_);
    if (error <= tolerance_) queue_.push({error, mesh_.editor().point(v), v});
  }

  void remove(Vertex v) {
    for (const HalfEdge e : mesh_.mesh().around(v)) change(mesh_.mesh().to(e));
    mesh_.remove(v);
  }

  MeasuredMesh& mesh_;
  Vertex first_;
  double tolerance_;
  std::vector<bool>
      is_changed_;  // of each vertex, whether its triangles have since it was measured
  std::vector<Vertex> changed_;
  std::priority_queue<Entry> queue_;
};

// Insert what is beyond the tolerance, and remove what became needless if that is asked for; the
// vertices before `first` stay.
template <typename MeasuredMesh, typename KeepGoing>
Simplified simplify_mesh(MeasuredMesh& mesh, Vertex first, const SimplificationGoal& goal,
                         bool prunes, KeepGoing&& keep_going) {
  Simplified found;
  found.is_complete = GreedyInsertion(mesh, goal).run(keep_going);
  if (found.is_complete && prunes) {
    found.removed = GreedyRemoval(mesh, first, goal.tolerance).run(keep_going);
    found.is_complete = found.removed >= 0;
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
  CandidateMesh mesh(editor, rows.points, rows.count, rows.vertex_rows);
  if (!mesh.place_all(rows.triangles, keep_going)) return {{}, 0, false};
  return simplify_mesh(mesh, first, goal, prunes, keep_going);
}

}  // namespace tinsmith
