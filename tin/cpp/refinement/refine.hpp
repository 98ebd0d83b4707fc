// Refinement of a surface as arrays: what a refiner did, numbered without gaps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../mesh/checked_mesh.hpp"
#include "refiner.hpp"

namespace tinsmith {

// New vertices are numbered after the given ones.
struct Refined {
  std::vector<Point> points;         // of the new vertices
  std::vector<Vertex> splits;        // of segments: from, to, middle
  std::vector<std::int32_t> misses;  // triangles that miss the goal: three corners, why
  std::int64_t triangle_count = 0;
  Refiner::Ended ended = Refiner::Ended::kDone;
};

// Segments between the pairs `kept_whole` are not split.
inline Refined refine(MeshEditor& editor, const RefinementGoal& goal, const VertexPairs& kept_whole,
                      std::int32_t most_vertices, Team& team) {
  const std::int32_t given = editor.slots();
  Refiner refiner(editor, goal);
  for (std::size_t i = 0; i < kept_whole.count; ++i) {
    refiner.keep_whole(kept_whole.from(i), kept_whole.to(i));
  }
  Refined refined;
  refined.ended = refiner.run(most_vertices, team);
  const Mesh& mesh = editor.mesh();
  std::vector<Vertex> number_of(editor.slots());
  for (const Vertex v : editor.vertices()) {
    const bool is_given = number(v) < given;
    number_of[number(v)] =
        is_given ? v : Vertex{given + static_cast<std::int32_t>(refined.points.size())};
    if (!is_given && mesh.is_alive(v)) refined.points.push_back(editor.point(v));
  }
  for (const Refiner::Split& split : refiner.splits()) {
    for (const Vertex v : {split.from, split.to, split.middle}) {
      refined.splits.push_back(number_of[number(v)]);
    }
  }
  for (const Triangle t : mesh.triangles()) {
    refined.triangle_count += !mesh.is_free(t) && !mesh.is_ghost(t);
  }
  refiner.visit_left([&](Triangle t, Refiner::Why why) {
    for (const Vertex v : mesh[t].corner) refined.misses.push_back(number(number_of[number(v)]));
    refined.misses.push_back(static_cast<std::int32_t>(why));
  });
  return refined;
}

}  // namespace tinsmith
