// The vertices of a surface that are seen from an eye: a sweep of directions about it.
//
// A ray turns about the eye. The edges that it crosses do not cross each other, so they keep their
// order of distance while it turns, in a tree (as in the sweep of van Kreveld, "Variations on sweep
// algorithms: efficient computation of extended viewsheds and class intervals", 1996, for
// rasters). At a vertex all nearer edges are asked whether one is above the line of sight, but
// parts of the tree none of whose edges comes up to it anywhere are left out. Nothing is asked of
// the surface but that its edges do not cross: it may have holes, and lines that are not Delaunay.
//
// A sector of directions begins with the edges that its first one crosses, so sectors are swept
// independently of each other.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/location/surface.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"
#include "directions.hpp"
#include "edge_tree.hpp"
#include "eye.hpp"
#include "rules.hpp"
#include "sight_edges.hpp"

namespace tinsmith::sight {

struct View {
  SurfacePoint eye;
  double target_height;
  double radius;  // infinite for none
};

// An edge that crosses the first direction of a sector.
struct CrossingEdge {
  std::uint32_t number;
  Vertex from;
};

// Those of each sector.
inline std::vector<std::vector<CrossingEdge>> list_crossing(const Directions& directions,
                                                            const SightEdges& edges) {
  const auto& sectors = directions.sectors();
  const std::size_t count = sectors.size() - 1;
  std::vector<std::vector<CrossingEdge>> crossing(count);
  std::vector<std::int32_t> sector_of(static_cast<std::size_t>(directions.size()));
  for (std::size_t s = 0; s < count; ++s) {
    std::fill(sector_of.begin() + sectors[s], sector_of.begin() + sectors[s + 1],
              static_cast<std::int32_t>(s));
  }
  for (std::int32_t at = 0; at < directions.size(); ++at) {
    const Vertex from = directions.vertex(at);
    const std::int32_t start = directions.slot(from);
    for (std::uint32_t e = edges.begin(at); e < edges.end(at); ++e) {
      const std::int32_t end = directions.slot(edges.to(e));
      const bool is_around = start > end;
      const std::size_t last = sector_of[end] + (is_around ? count : 0);
      for (std::size_t s = sector_of[start] + std::size_t{1}; s <= last; ++s) {
        const std::int32_t first = sectors[s % count];
        const bool is_inside =
            is_around ? first > start || first < end : first > start && first < end;
        if (is_inside) crossing[s % count].push_back({e, from});
      }
    }
  }
  return crossing;
}

template <typename Rule>
class Sweep {
 public:
  Sweep(const Surface& surface, const View& view, const Rule& rule, const Directions& directions,
        const SightEdges& edges)
      : surface_(surface),
        view_(view),
        rule_(rule),
        directions_(directions),
        edges_(edges),
        tree_(view.eye.at) {}

  // Of the vertices at positions from `begin` to `end`; `seen` says which are asked for.
  void run(std::int32_t begin, std::int32_t end, const std::vector<CrossingEdge>& crossing,
           Sight* seen, Pulse& pulse) {
    start(begin, end, crossing);
    for (std::int32_t at = begin, next = begin; at < end && pulse.goes_on(); at = next) {
      while (next < end && directions_.slot(directions_.vertex(next)) == at) ++next;
      for (std::int32_t i = at; i < next; ++i) erase_ending(i);
      look(at, next, seen);
      for (std::int32_t i = at; i < next; ++i) insert_beginning(i);
    }
  }

 private:
  using Handle = EdgeTree::Handle;

  struct Nearer {
    SurfacePoint place;
    double reach;
  };

  void start(std::int32_t begin, std::int32_t end, const std::vector<CrossingEdge>& crossing) {
    tree_.clear();
    first_ = edges_.begin(begin);
    handles_.assign(edges_.end(end - 1) - first_, EdgeTree::kNone);
    handles_before_.clear();
    for (const CrossingEdge& edge : crossing) {
      handles_before_[edge.number] = insert(edge.number, edge.from);
    }
  }

  Handle insert(std::uint32_t number, Vertex from) {
    SightEdge edge{surface_.surface_point(from), surface_.surface_point(edges_.to(number)), 0.0,
                   edges_.reach(number)};
    edge.bound = rule_.bound(edge);
    return tree_.insert(edge, number);
  }

  void insert_beginning(std::int32_t position) {
    const Vertex from = directions_.vertex(position);
    for (std::uint32_t e = edges_.begin(position); e < edges_.end(position); ++e) {
      handles_[e - first_] = insert(e, from);
    }
  }

  // An edge that is around may begin in this sector, behind, and end in it: it is not there yet.
  void erase_ending(std::int32_t position) {
    edges_.visit_ending(position, [&](std::uint32_t e) {
      const auto before = handles_before_.find(e);
      if (before != handles_before_.end()) {
        tree_.erase(before->second);
        handles_before_.erase(before);
      } else if (e >= first_ && e - first_ < handles_.size()) {
        Handle& handle = handles_[e - first_];
        if (handle != EdgeTree::kNone) tree_.erase(handle);
        handle = EdgeTree::kNone;
      }
    });
  }

  // At the vertices in one direction, the nearest first.
  void look(std::int32_t begin, std::int32_t end, Sight* seen) {
    nearer_.clear();
    for (std::int32_t i = begin; i < end; ++i) {
      const Vertex v = directions_.vertex(i);
      if (i > begin) add_nearer(i - 1);
      if (seen[number(v)] != Sight::kSeen) continue;
      SurfacePoint target = surface_.surface_point(v);
      target.z += view_.target_height;
      Sight found = Sight::kSeen;
      for (const Nearer& nearer : nearer_) {
        if (found != Sight::kHidden) worsen(found, rule_.judge(nearer.place, nearer.reach, target));
      }
      if (found != Sight::kHidden) search(target, found);
      seen[number(v)] = found;
    }
  }

  // Of the vertices in one direction the steepest alone matters, where that can be decided.
  void add_nearer(std::int32_t position) {
    const SurfacePoint place = surface_.surface_point(directions_.vertex(position));
    if (!Rule::kIsExact || nearer_.empty()) {
      nearer_.push_back({place, reach_at(position)});
    } else if (compare_steepness(view_.eye, place, nearer_.front().place) > 0) {
      nearer_.front().place = place;
    }
  }

  static void worsen(Sight& found, Sight other) {
    if (other == Sight::kHidden || found == Sight::kSeen) found = other;
  }

  double reach_at(std::int32_t position) const {
    double reach = 0.0;
    const auto extend = [&](std::uint32_t e) { reach = std::max(reach, edges_.reach(e)); };
    for (std::uint32_t e = edges_.begin(position); e < edges_.end(position); ++e) extend(e);
    edges_.visit_ending(position, extend);
    return reach;
  }

  // For an edge in front of the target that hides it.
  void search(const SurfacePoint& target, Sight& found) {
    const double steepness = rule_.steepness(target);
    const auto may_hide = [&](Handle h) { return tree_.highest(h) > steepness; };
    parts_.clear();
    for (Handle h = tree_.root(); may_hide(h);) {
      const SightEdge& edge = tree_.edge(h);
      if (orientation(edge.from.at, edge.to.at, target.at) >= 0) {
        h = tree_.nearer(h);
        continue;
      }
      if (edge.bound > steepness) worsen(found, rule_.judge(edge, target));
      if (found == Sight::kHidden) return;
      if (may_hide(tree_.nearer(h))) parts_.push_back(tree_.nearer(h));
      h = tree_.farther(h);
    }
    while (!parts_.empty()) {
      const Handle h = parts_.back();
      parts_.pop_back();
      const SightEdge& edge = tree_.edge(h);
      if (edge.bound > steepness) worsen(found, rule_.judge(edge, target));
      if (found == Sight::kHidden) return;
      for (const Handle part : {tree_.nearer(h), tree_.farther(h)}) {
        if (may_hide(part)) parts_.push_back(part);
      }
    }
  }

  const Surface& surface_;
  const View& view_;
  const Rule& rule_;
  const Directions& directions_;
  const SightEdges& edges_;
  EdgeTree tree_;
  std::uint32_t first_ = 0;      // of the edges that begin in the sector
  std::vector<Handle> handles_;  // theirs
  std::unordered_map<std::uint32_t, Handle> handles_before_;  // of those that begin before it
  std::vector<Handle> parts_;
  std::vector<Nearer> nearer_;  // vertices in the direction of the one looked at
};

// The ends of edges, each once; those at the eye are not in any direction.
inline std::vector<Vertex> list_ends(const Surface& surface, const View& view) {
  std::vector<bool> is_end(static_cast<std::size_t>(surface.point_count), false);
  visit_edges(surface, view.eye.at, view.radius, [&](Vertex from, Vertex to, HalfEdge) {
    is_end[number(from)] = is_end[number(to)] = true;
  });
  std::vector<Vertex> ends;
  for (const Vertex v : Ids<Vertex>(surface.point_count)) {
    if (is_end[number(v)]) ends.push_back(v);
  }
  return ends;
}

// Of the ends of edges; nothing where there are none, or the team is stopped.
inline std::optional<Directions> sort_ends(const Surface& surface, const View& view, Team& team) {
  const auto ends = list_ends(surface, view);
  if (ends.empty() || !team.keeps_going(0)) return std::nullopt;
  std::optional<Directions> directions(std::in_place, surface, view.eye.at, ends, team);
  if (!team.keeps_going(0)) directions.reset();
  return directions;
}

// `seen` is kSeen for the vertices that are asked for, which have triangles and are not at the
// eye; it becomes kHidden where one is hidden. Check `team.is_stopped()` afterwards.
template <typename Rule>
void find_seen(const Surface& surface, const View& view, const Rule& rule, Sight* seen,
               Team& team) {
  const auto directions = sort_ends(surface, view, team);
  if (!directions) return;
  const SightEdges edges(surface, view.eye.at, view.radius, *directions,
                         Rule::kIsExact ? SightEdges::Extra::kNothing : SightEdges::Extra::kReach);
  if (!team.keeps_going(0)) return;
  const auto crossing = list_crossing(*directions, edges);
  const auto& sectors = directions->sectors();
  std::atomic<std::size_t> next{0};
  team.run([&](int part) {
    Sweep<Rule> sweep(surface, view, rule, *directions, edges);
    Pulse pulse(team, part);
    for (std::size_t s; (s = next++) < crossing.size() && pulse.goes_on();) {
      sweep.run(sectors[s], sectors[s + 1], crossing[s], seen, pulse);
    }
  });
}

inline void find_seen_vertices(const Surface& surface, const View& view, double fall, Sight* seen,
                               Team& team) {
  if (fall == 0.0) {
    find_seen(surface, view, PlaneRule(view.eye), seen, team);
  } else {
    find_seen(surface, view, CurvedRule(view.eye, fall), seen, team);
  }
}

}  // namespace tinsmith::sight
