// The vertices joined to each by an edge, in the order of their coordinates.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/range.hpp"
#include "../../../tin/cpp/location/surface.hpp"

namespace tinsmith {

// The triangles at each vertex.
class VertexTriangles {
 public:
  explicit VertexTriangles(const Surface& surface)
      : begin_(scratch_array<std::uint32_t>(static_cast<std::size_t>(surface.point_count) + 1)),
        triangles_(scratch_array<Triangle>(std::size_t{3} * surface.triangle_count)) {
    const std::size_t entries = std::size_t{3} * surface.triangle_count;
    std::fill_n(begin_.get(), static_cast<std::size_t>(surface.point_count) + 1, 0u);
    for (std::size_t i = 0; i < entries; ++i) ++begin_[surface.corners[i]];
    std::uint32_t total = 0;
    for (std::int32_t v = 0; v <= surface.point_count; ++v) begin_[v] = total += begin_[v];
    for (std::size_t i = entries; i-- > 0;) {
      triangles_[--begin_[surface.corners[i]]] = triangle_of(half_edge_at(i));
    }
  }

  // Of the triangles in one array, those of a vertex.
  std::uint32_t place(Vertex v) const { return begin_[number(v)]; }
  const Triangle* begin(Vertex v) const { return triangles_.get() + place(v); }
  const Triangle* end(Vertex v) const { return triangles_.get() + begin_[number(v) + 1]; }
  std::uint32_t entry_count(Vertex v) const { return begin_[number(v) + 1] - place(v); }

 private:
  ScratchArray<std::uint32_t> begin_;  // of each vertex, and the end of the last
  ScratchArray<Triangle> triangles_;
};

class VertexNeighbors {
 public:
  // Check `team.is_stopped()` afterwards.
  VertexNeighbors(const Surface& surface, Team& team)
      : begin_(scratch_array<std::size_t>(surface.point_count)),
        count_(scratch_array<std::uint32_t>(surface.point_count)),
        neighbors_(scratch_array<Vertex>(std::size_t{6} * surface.triangle_count)) {
    const VertexTriangles around(surface);
    team.run([&](int part) {
      const Range range = part_of(surface.point_count, part, team.size());
      for (std::int32_t i = range.begin; i < range.end; ++i) {
        if (i % kBetweenQuestions == 0 && !team.keeps_going(part)) return;
        list_neighbors(surface, around, Vertex{i});
      }
    });
  }

  const Vertex* begin(Vertex v) const { return neighbors_.get() + begin_[number(v)]; }
  const Vertex* end(Vertex v) const { return begin(v) + count_[number(v)]; }

 private:
  static constexpr std::int32_t kBetweenQuestions = 1 << 16;
  static constexpr std::uint32_t kFew = 16;  // triangles, whose corners are looked through at once

  // Each triangle has two of the neighbours, and most neighbours are in two triangles.
  void list_neighbors(const Surface& surface, const VertexTriangles& around, Vertex v) {
    begin_[number(v)] = 2 * std::size_t{around.place(v)};
    Vertex* const first = neighbors_.get() + begin_[number(v)];
    Vertex* last = first;
    const bool are_few = around.entry_count(v) <= kFew;
    for (const Triangle* t = around.begin(v); t != around.end(v); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Vertex w = surface.vertex(*t, k);
        if (w != v && !(are_few && std::find(first, last, w) != last)) *last++ = w;
      }
    }
    std::sort(first, last, [&](Vertex a, Vertex b) {
      return lexicographically_before(surface.point(a), surface.point(b));
    });
    count_[number(v)] = static_cast<std::uint32_t>(std::unique(first, last) - first);
  }

  ScratchArray<std::size_t> begin_;
  ScratchArray<std::uint32_t> count_;
  ScratchArray<Vertex> neighbors_;  // with room for each to be named twice
};

}  // namespace tinsmith
