// Insertion: the same triangulation by local change, one point at a time, for points so uneven
// that a grid does not help the growth.
//
// A new point alters only its domain of influence: the triangles whose circle holds it. They are
// removed and the hole is filled with a fan about the point (cavity.hpp). Ties are decided by the
// point set alone (is_in_circle), so the result is the growth's. The order of insertion
// (insertion_rounds.hpp) only sets the speed, and so do the parts of the plane that threads
// triangulate each by itself before they are merged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../index/grid.hpp"
#include "canonical_order.hpp"
#include "curve_order.hpp"
#include "ghost_mesh.hpp"
#include "part_insertion.hpp"
#include "part_merge.hpp"

namespace tinsmith {

class Insertion {
 public:
  Insertion(const PointGrid& grid, Team& team)
      : team_(team), count_(grid.count()), order_(grid, team) {}

  // Returns false if the team is stopped, or all points are collinear.
  bool run() {
    if (!team_.keeps_going(0) || !order_.put_in_order() || order_.parts().empty()) return false;
    triangles_ = scratch_array<GhostTriangle>(triangle_count());
    team_.expect(count_);
    if (!insert_parts() || !merge_parts()) return false;
    order_.points.release();
    return true;
  }

  // The corners are numbered by their positions in the sweep, or as `number_of` each of these. The
  // triangulation lasts as long as this lives, or is taken.
  void number_by_sweep() {
    number_corners([this](Vertex v) { return order_.sweep_of[v]; });
    order_.sweep_of.release();
  }
  void number_by(const Row* number_of) {
    number_corners([this, number_of](Vertex v) {
      if (v == kGhost) return kGhost;
      return Vertex{number(number_of[number(order_.sweep_of[v])])};
    });
  }
  SweptTriangles triangles() const { return {triangles_.get(), triangle_count()}; }
  ScratchArray<GhostTriangle> take() { return std::move(triangles_); }

  // Triangles that were walked through to find where points go.
  std::int64_t walk_steps() const { return walk_steps_; }

 private:
  std::uint32_t triangle_count() const { return 2 * static_cast<std::uint32_t>(count_) - 2; }

  struct Ends {  // of a part: its first and last vertex along the side that parts divide
    PartMerge::OnHull first, last;
  };

  bool insert_parts() {
    const std::size_t parts = order_.parts().size();
    ends_.resize(parts);
    std::vector<std::int64_t> steps(parts);
    team_.run([&](int member) {
      for (std::size_t part = member; part < parts; part += team_.size()) {
        PartInsertion insertion(order_, order_.parts()[part], triangles_.get());
        const auto keep_going = [&](std::int32_t inserted) {
          team_.advance(inserted);
          return team_.keeps_going(member);
        };
        if (!insertion.run(keep_going)) return;
        if (parts > 1) ends_[part] = ends_of(order_.parts()[part], insertion);
        steps[part] = insertion.walk_steps();
      }
    });
    for (const std::int64_t part : steps) walk_steps_ += part;
    return !team_.is_stopped();
  }

  Ends ends_of(Range part, PartInsertion& insertion) const {
    Vertex first{part.begin}, last{part.begin};
    const auto at = [&](Vertex v) { return order_.coordinate(order_.points[v]); };
    for (const Vertex v : Ids<Vertex>(part.begin, part.end)) {
      if (at(v) < at(first)) first = v;
      if (at(v) > at(last)) last = v;
    }
    const PartMerge merge(triangles_.get(), order_.points.begin());
    return {merge.on_hull(first, insertion.triangle_at(first)),
            merge.on_hull(last, insertion.triangle_at(last))};
  }

  // One after the other: a merge changes few triangles beside the line, unless most lie on a curve.
  bool merge_parts() {
    PartMerge merge(triangles_.get(), order_.points.begin());
    for (std::size_t part = 0; part + 1 < ends_.size(); ++part) {
      if (!team_.keeps_going(0)) return false;
      const std::int64_t unused = std::int64_t{2} * order_.parts()[part].end - 2;
      merge.run(ends_[part].last, ends_[part + 1].first, triangle_numbered(unused),
                triangle_numbered(unused + 1));
    }
    return true;
  }

  template <typename NumberOf>
  void number_corners(const NumberOf& number_of) {
    team_.run([&](int member) {
      const Range own = part_of(triangle_count(), member, team_.size());
      for (std::int32_t t = own.begin; t < own.end; ++t) {
        for (Vertex& corner : triangles_[t].corner) corner = number_of(corner);
      }
    });
  }

  Team& team_;
  std::int32_t count_;
  CurveOrder order_;
  ScratchArray<GhostTriangle> triangles_;
  std::vector<Ends> ends_;
  std::int64_t walk_steps_ = 0;
};

}  // namespace tinsmith
