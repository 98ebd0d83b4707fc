// From each strip of a surface, and each vertex, to the next one down.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/base/range.hpp"
#include "descent.hpp"
#include "strips.hpp"

namespace tinsmith::hydrology {

// Nodes are the strips, then the vertices, then where water ends: the level ground that each vertex
// lies on, and the outside. -1 is no node, and no vertex.
struct Nodes {
  std::int32_t first_vertex, vertex_count;
  const std::int32_t* grounds;  // of vertices

  std::int32_t vertex(Vertex v) const { return first_vertex + number(v); }
  std::int32_t end(Vertex v) const { return first_vertex + vertex_count + grounds[number(v)]; }
  std::int32_t outside() const { return first_vertex + 2 * vertex_count; }
  std::int32_t count() const { return outside() + 1; }
};

// The node below, and the upper end of the channel that water takes to it, if it does.
struct Link {
  std::int32_t next;
  std::int32_t upper;
};

// Of a drop that has come to a vertex, to a channel or to an end.
inline Link link(const FallingSurface& falls, const Nodes& nodes, const Drop& drop) {
  if (drop.end == End::kBoundary) return {nodes.outside(), -1};
  if (drop.end != End::kMoving) {
    const Vertex at = drop.vertex != kNoVertex ? drop.vertex : falls.start(drop.place.edge);
    return {nodes.end(at), -1};
  }
  if (drop.vertex != kNoVertex) return {nodes.vertex(drop.vertex), -1};
  const Vertex start = falls.start(drop.place.edge), end = falls.end(drop.place.edge);
  return {nodes.vertex(drop.target), number(start == drop.target ? end : start)};
}

// Of every strip: the one that its water enters, or what is beyond an edge.
class StripLinks {
 public:
  StripLinks(const FallingSurface& falls, const Base* bases, const Filling& filling,
             const Strips& strips, const Nodes& nodes)
      : falls_(falls),
        bases_(bases),
        descent_(falls, bases, filling),
        strips_(strips),
        nodes_(nodes) {}

  // Each strip by itself, so that threads share them. Check `team.is_stopped()` afterwards.
  void run(std::int32_t* nexts, std::int32_t* uppers, Team& team) const {
    team.run([&](int part) {
      Pulse pulse(team, part);
      const Range range = part_of(falls_.surface.triangle_count, part, team.size());
      for (std::int32_t triangle = range.begin; triangle < range.end; ++triangle) {
        const Triangle t = triangle_numbered(triangle);
        for (std::int64_t i = strips_.begin(t); i < strips_.end(t); ++i) {
          if (!pulse.goes_on()) return;
          const Link found = find(t, (strips_.starts[i] + strips_.end_of(i, t)) / 2);
          nexts[i] = found.next;
          uppers[i] = found.upper;
        }
      }
    });
  }

 private:
  // By the water from the middle of a strip.
  Link find(Triangle t, double middle) const {
    const Base& base = bases_[number(t)];
    const Place at{half_edge(t, base.corner), middle};
    const Drop drop = descent_.arrive(base.drains ? at : base.follow(at));
    if (!drop.runs_on()) return link(falls_, nodes_, drop);
    const Triangle below = triangle_of(drop.place.edge);
    const Base& own = bases_[number(below)];
    const Place on = own.is_at(drop.place.edge) ? drop.place : own.follow(drop.place);
    return {static_cast<std::int32_t>(strips_.find(below, on.share)), -1};
  }

  const FallingSurface& falls_;
  const Base* bases_;
  const Descent descent_;
  const Strips& strips_;
  const Nodes& nodes_;
};

// Of every vertex: the vertex or end that its water comes to, across however many triangles.
class VertexLinks {
 public:
  VertexLinks(const FallingSurface& falls, const Base* bases, const Filling& filling,
              const ExitTable& exits, const Nodes& nodes)
      : falls_(falls), exits_(exits), descent_(falls, bases, filling), nodes_(nodes) {}

  // Returns the vertices that are undecided. They are visited in the order of the triangles, for
  // paths that begin near each other cross the same ones: each by the thread that comes first, and
  // with the same result by any. Check `team.is_stopped()` afterwards.
  std::vector<Vertex> run(std::int32_t* nexts, std::int32_t* uppers, Team& team) const {
    std::vector<std::atomic<bool>> is_visited(static_cast<std::size_t>(nodes_.vertex_count));
    const auto visit = [&](Vertex v, Pulse& pulse) {
      std::atomic<bool>& mine = is_visited[number(v)];
      if (mine.load(std::memory_order_relaxed) || mine.exchange(true)) return;
      const Link found = find(v, pulse).value_or(Link{kUndecided, -1});
      nexts[number(v)] = found.next;
      uppers[number(v)] = found.upper;
    };
    team.run([&](int part) {
      Pulse pulse(team, part);
      const Range range = part_of(falls_.surface.triangle_count, part, team.size());
      for (std::int32_t t = range.begin; t < range.end && pulse.goes_on(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
          visit(falls_.surface.vertex(triangle_numbered(t), k), pulse);
        }
      }
    });
    Pulse pulse(team);
    std::vector<Vertex> undecided;
    for (const Vertex v : Ids<Vertex>(nodes_.vertex_count)) {
      if (team.is_stopped()) return {};
      visit(v, pulse);  // some are in no triangle
      if (nexts[number(v)] == kUndecided) undecided.push_back(v);
    }
    return undecided;
  }

 private:
  static constexpr std::int32_t kUndecided = -1;

  std::optional<Link> find(Vertex v, Pulse& pulse) const {
    const std::optional<Exit> exit = exits_.find(v);
    if (!exit) return {};
    if (exit->vertex != kNoVertex) return Link{nodes_.vertex(exit->vertex), number(v)};
    if (exit->leaves) return Link{nodes_.outside(), -1};
    if (exit->triangle == kNoTriangle) return Link{nodes_.end(v), -1};
    const HalfEdge out = half_edge(exit->triangle, falls_.surface.corner_at(exit->triangle, v));
    Drop drop = descent_.arrive({out, falls_.split(out)});
    // A fall line that ends in a corner runs along an edge.
    if (drop.vertex != kNoVertex) return Link{nodes_.vertex(drop.vertex), number(v)};
    while (drop.runs_on() && pulse.goes_on()) {
      const std::optional<Drop> next = descent_.cross(drop.place);
      if (!next) return {};
      drop = *next;
    }
    return link(falls_, nodes_, drop);
  }

  const FallingSurface& falls_;
  const ExitTable& exits_;
  const Descent descent_;
  const Nodes& nodes_;
};

// The node at which the water of each ends, -1 where it runs in a circle.
inline void find_ends(const std::int32_t* nexts, std::int32_t count, std::int32_t* ends,
                      Pulse& pulse) {
  constexpr std::int32_t kUnknown = -2, kOnTheWay = -1;
  std::fill_n(ends, count, kUnknown);
  for (std::int32_t first = 0; first < count; ++first) {
    std::int32_t at = first;
    while (ends[at] == kUnknown && nexts[at] != at && pulse.goes_on()) {
      ends[at] = kOnTheWay;
      at = nexts[at];
    }
    const std::int32_t end = ends[at] == kUnknown ? at : ends[at];
    ends[at] = end;
    for (at = first; ends[at] == kOnTheWay && end != kOnTheWay; at = nexts[at]) ends[at] = end;
    if (!pulse.goes_on()) return;
  }
}

// Adds to every node what comes to it from above. Nodes that nothing comes to are taken away, then
// those that this leaves so, and so on; the order of the sums is that order.
inline void accumulate(const std::int32_t* nexts, std::int32_t count, double* totals,
                       Pulse& pulse) {
  const auto waits = scratch_array<std::uint32_t>(count);
  const auto ready = scratch_array<std::int32_t>(count);
  std::fill_n(waits.get(), count, 0u);
  for (std::int32_t i = 0; i < count; ++i) waits[nexts[i]] += nexts[i] != i;
  std::int32_t last = 0;
  for (std::int32_t i = 0; i < count; ++i) {
    if (waits[i] == 0 && nexts[i] != i) ready[last++] = i;
  }
  for (std::int32_t i = 0; i < last && pulse.goes_on(); ++i) {
    const std::int32_t below = nexts[ready[i]];
    totals[below] += totals[ready[i]];
    if (--waits[below] == 0 && nexts[below] != below) ready[last++] = below;
  }
}

}  // namespace tinsmith::hydrology
