// A mesh for callers who may be mistaken: lists of points and segments, checked, one after another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../index/hilbert_order.hpp"
#include "mesh_editor.hpp"

namespace tinsmith {

// Two vertices each, as the caller numbers them.
struct VertexPairs {
  const std::int32_t* ends;
  std::size_t count;

  Vertex from(std::size_t i) const { return Vertex{ends[2 * i]}; }
  Vertex to(std::size_t i) const { return Vertex{ends[2 * i + 1]}; }
};

// Throws std::invalid_argument where a vertex is named that is not there.
class CheckedMesh {
 public:
  explicit CheckedMesh(MeshEditor editor) : editor_(std::move(editor)) {}
  // With the vertices in the order of the sweep, where they are known.
  CheckedMesh(MeshEditor editor, std::vector<Vertex> sweep)
      : editor_(std::move(editor)), sweep_(std::move(sweep)) {}

  const MeshEditor& editor() const { return editor_; }
  MeshEditor& editor_to_change() {  // for those who are never mistaken
    free_memory(sweep_);
    return editor_;
  }
  const std::vector<Vertex>& sweep() const { return sweep_; }  // empty if it is not known

  // The vertex at each point, in the order given: a new slot's, or the one that is there already.
  void insert(const Point* points, std::int32_t count, std::int32_t* result) {
    if (std::int64_t{count} + editor_.slots() > kMostPoints) {
      throw std::invalid_argument("more points than 32-bit indices can number");
    }
    free_memory(sweep_);
    const std::int32_t first = editor_.slots();
    for (std::int32_t i = 0; i < count; ++i) editor_.add_slot();
    const HilbertOrder order(points, count);
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t item = order[i];
      result[item] = number(editor_.insert(points[item], Vertex{first + item}));
    }
  }

  // Put a vertex that was removed at another point; returns the one that stands there.
  Vertex put(Vertex slot, Point p) {
    if (!is_slot(slot) || editor_.mesh().is_alive(slot)) {
      throw std::invalid_argument("the slot must be one whose vertex was removed");
    }
    free_memory(sweep_);
    return editor_.insert(p, slot);
  }

  // Whether all were removed; stops at the first without which there would be no triangle.
  bool remove(const std::int32_t* vertices, std::size_t count) {
    if (count > 0) free_memory(sweep_);
    for (std::size_t i = 0; i < count; ++i) {
      const Vertex v = checked(Vertex{vertices[i]});
      if (editor_.has_fixed_edge(v)) throw std::invalid_argument("a fixed edge ends at the vertex");
      if (!editor_.can_remove(v)) return false;
      editor_.remove(v);
    }
    return true;
  }

  // Vertices on the way of each segment, as (segment, vertex) pairs; and the segments that a fixed
  // edge stops.
  struct Forced {
    std::vector<std::int32_t> passed, blocked;
    bool is_complete = true;  // false if `keep_going` was
  };
  template <typename KeepGoing>
  Forced force(const VertexPairs& segments, KeepGoing&& keep_going) {
    for (std::size_t i = 0; i < segments.count; ++i) require(segments, i);
    Forced forced;
    for (std::size_t i = 0; i < segments.count; ++i) {
      if (i % kSegmentsPerQuestion == kSegmentsPerQuestion - 1 && !keep_going()) {
        forced.is_complete = false;
        break;
      }
      const auto segment = static_cast<std::int32_t>(i);
      const Vertex end = segments.to(i);
      const auto visit = [&](Vertex v) {
        if (v != end) forced.passed.insert(forced.passed.end(), {segment, number(v)});
      };
      const auto outcome = editor_.force(segments.from(i), end, visit);
      if (outcome == MeshEditor::Forced::kBlocked) forced.blocked.push_back(segment);
    }
    return forced;
  }

  // The edges that each segment crosses, in order: (segment, from, to).
  std::vector<std::int32_t> crossed(const VertexPairs& segments, bool only_fixed) const {
    std::vector<std::int32_t> found;
    for (std::size_t i = 0; i < segments.count; ++i) {
      require(segments, i);
      editor_.cross(segments.from(i), segments.to(i), [&](Vertex from, Vertex to, bool is_fixed) {
        if (only_fixed && !is_fixed) return;
        found.insert(found.end(), {static_cast<std::int32_t>(i), number(from), number(to)});
      });
    }
    return found;
  }

  // The number of segments that were fixed edges.
  std::int32_t release(const VertexPairs& segments) {
    std::int32_t released = 0;
    for (std::size_t i = 0; i < segments.count; ++i) {
      require(segments, i);
      released += editor_.release(segments.from(i), segments.to(i));
    }
    return released;
  }

  void release_all() { editor_.release_all(); }

  // The fixed edges that are not Delaunay, as (from, to) pairs.
  std::vector<std::int32_t> illegal_fixed_edges() {
    std::vector<std::int32_t> illegal;
    editor_.visit_illegal_fixed_edges(
        [&](Vertex from, Vertex to) { illegal.insert(illegal.end(), {number(from), number(to)}); });
    return illegal;
  }

  std::vector<Vertex> fixed_neighbors(Vertex v) const {
    return editor_.fixed_neighbors(checked(v));
  }
  std::vector<Vertex> apexes_beside(Vertex a, Vertex b) const {
    return editor_.apexes_beside(checked(a), checked(b));
  }
  double clearance(Vertex v) const { return editor_.clearance(checked(v)); }
  bool has_fixed_edge(Vertex v) const { return editor_.has_fixed_edge(checked(v)); }

  // Which slots hold a vertex.
  void write_alive(bool* flags) const {
    for (const Vertex v : editor_.vertices()) flags[number(v)] = editor_.mesh().is_alive(v);
  }

 private:
  static constexpr std::size_t kSegmentsPerQuestion = 4096;

  bool is_slot(Vertex v) const { return v >= Vertex{0} && number(v) < editor_.slots(); }

  Vertex checked(Vertex v) const {
    if (!is_slot(v) || !editor_.mesh().is_alive(v)) {
      throw std::invalid_argument("there is no such vertex");
    }
    return v;
  }
  void require(const VertexPairs& segments, std::size_t i) const {
    checked(segments.from(i));
    checked(segments.to(i));
  }

  MeshEditor editor_;
  std::vector<Vertex> sweep_;
};

}  // namespace tinsmith
