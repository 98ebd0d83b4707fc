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

// Vertices are inserted until no candidate is beyond the tolerance.
class GreedyInsertion {
 public:
  GreedyInsertion(CandidateMesh& mesh, const SimplificationGoal& goal) : mesh_(mesh), goal_(goal) {
    for (const Triangle t : mesh.mesh().triangles()) enter(t);
  }

  template <typename KeepGoing>
  bool run(KeepGoing&& keep_going) {
    std::uint32_t steps = 0;
    while (!queue_.empty() && mesh_.editor().count() < goal_.most) {
      const Entry next = queue_.top();
      queue_.pop();
      if (mesh_.list(next.triangle).worst != next.candidate) continue;
      if (++steps % kStepsBetween == 0 && !keep_going()) return false;
      mesh_.insert(next.triangle, next.candidate, [this](Triangle t) { enter(t); });
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kStepsBetween = 64;

  struct Entry {
    double error;
    Point at;
    CandidateId candidate;
    Triangle triangle;

    bool operator<(const Entry& other) const {  // the largest comes first
      if (error != other.error) return error < other.error;
      return lexicographically_before(other.at, at);
    }
  };

  void enter(Triangle t) {
    const CandidateList& list = mesh_.list(t);
    if (list.worst == kNoCandidate || !(list.error > goal_.tolerance)) return;
    queue_.push({list.error, mesh_.candidate(list.worst).point.at, list.worst, t});
  }

  CandidateMesh& mesh_;
  SimplificationGoal goal_;
  std::priority_queue<Entry> queue_;
};

// Vertices are removed, those that are missed least first, until each is needed.
class GreedyRemoval {
 public:
  // The vertices before `first` stay, and so do those with a fixed edge.
  GreedyRemoval(CandidateMesh& mesh, Vertex first, double tolerance)
      : mesh_(mesh), first_(first), tolerance_(tolerance), version_(mesh.editor().slots(), 0) {}

  // The number removed; -1 if `keep_going` was false.
  template <typename KeepGoing>
  std::int32_t run(KeepGoing&& keep_going) {
    std::uint32_t steps = 0;
    for (const Vertex v : mesh_.editor().vertices()) {
      if (++steps % kStepsBetween == 0 && !keep_going()) return -1;
      enter(v);
    }
    std::int32_t removed = 0;
    while (!queue_.empty()) {
      const Entry next = queue_.top();
      queue_.pop();
      if (next.version != version_[number(next.vertex)]) continue;
      if (++steps % kStepsBetween == 0 && !keep_going()) return -1;
      remove(next.vertex);
      ++removed;
    }
    return removed;
  }

 private:
  static constexpr std::uint32_t kStepsBetween = 64;

  struct Entry {
    double error;
    Point at;
    Vertex vertex;
    std::int32_t version;

    bool operator<(const Entry& other) const {  // the smallest comes first
      if (error != other.error) return error > other.error;
      return lexicographically_before(other.at, at);
    }
  };

  void enter(Vertex v) {
    const MeshEditor& editor = mesh_.editor();
    if (v < first_ || !editor.mesh().is_alive(v) || editor.has_fixed_edge(v)) return;
    const std::int32_t version = ++version_[number(v)];
    const double error = mesh_.error_without(v, tolerance_);
    if (error <= tolerance_) queue_.push({error, editor.point(v), v, version});
  }

  void remove(Vertex v) {
    neighbors_.clear();
    for (const HalfEdge e : mesh_.mesh().around(v)) neighbors_.push_back(mesh_.mesh().to(e));
    mesh_.remove(v);
    ++version_[number(v)];
    for (const Vertex neighbor : neighbors_) enter(neighbor);
  }

  CandidateMesh& mesh_;
  Vertex first_;
  double tolerance_;
  std::vector<std::int32_t> version_;  // of each vertex, from when its triangles last changed
  std::vector<Vertex> neighbors_;
  std::priority_queue<Entry> queue_;
};

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
  Simplified found;
  found.is_complete =
      mesh.place_all(rows.triangles, keep_going) && GreedyInsertion(mesh, goal).run(keep_going);
  if (found.is_complete && prunes) {
    found.removed = GreedyRemoval(mesh, first, goal.tolerance).run(keep_going);
    found.is_complete = found.removed >= 0;
  }
  for (const Vertex v : editor.vertices()) {
    if (editor.mesh().is_alive(v)) found.rows.push_back(mesh.row(v));
  }
  std::sort(found.rows.begin(), found.rows.end());
  return found;
}

}  // namespace tinsmith
