// A mesh of some of the points of a surface, which knows how far the others are from it.
//
// Each point that is no vertex is a candidate of the triangle that holds it. Where the mesh
// changes, the candidates of the triangles that changed are dealt out anew, and no others are
// looked at (Garland and Heckbert, "Fast polygonal approximation of terrains and height fields",
// 1995; the lists are those of Heller, "Triangulation algorithms for adaptive terrain modeling",
// 1990). A candidate on an edge belongs to the triangle on the left of the edge as it runs from its
// lexicographically first end, so that nothing depends on the order in which points came.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "../base/ids.hpp"
#include "../index/hilbert_order.hpp"
#include "../mesh/mesh_editor.hpp"
#include "elevation_plane.hpp"
#include "star_gap.hpp"

namespace tinsmith {

using CandidateId = std::int32_t;
constexpr CandidateId kNoCandidate = -1;

struct Candidate {
  SurfacePoint point;
  CandidateId next;  // of the same triangle
  std::int32_t row;  // of the caller's points
};

// The candidates of a triangle, and the one farthest from it in elevation.
struct CandidateList {
  CandidateId first = kNoCandidate, worst = kNoCandidate;
  double error = 0.0;
};

class CandidateMesh {
 public:
  // Rows of easting, northing and elevation; those of the mesh's vertices.
  CandidateMesh(MeshEditor& editor, const double* points, std::int32_t count,
                const std::int32_t* vertex_rows, const SideWeights& weights = {})
      : editor_(editor), weights_(weights) {
    const auto vertices = static_cast<std::size_t>(editor.slots());
    row_of_.assign(vertex_rows, vertex_rows + vertices);
    std::vector<bool> is_vertex(static_cast<std::size_t>(count), false);
    for (const std::int32_t row : row_of_) {
      is_vertex[static_cast<std::size_t>(row)] = true;
      elevation_.push_back(points[3 * static_cast<std::size_t>(row) + 2]);
    }
    gather(points, is_vertex);
    editor_.watch();
    lists_.resize(editor.mesh().triangle_slots());
  }

  const MeshEditor& editor() const { return editor_; }
  const Mesh& mesh() const { return editor_.mesh(); }
  const CandidateList& list(Triangle t) const { return lists_[number(t)]; }
  const Candidate& candidate(CandidateId c) const {
    return candidates_[static_cast<std::size_t>(c)];
  }
  Point place(CandidateId c) const { return candidate(c).point.at; }
  bool comes_before(CandidateId c, CandidateId d) const {
    return lexicographically_before(place(c), place(d));
  }
  bool comes_before(Vertex v, Vertex w) const {
    return lexicographically_before(editor_.point(v), editor_.point(w));
  }
  std::int32_t row(Vertex v) const { return row_of_[static_cast<std::size_t>(number(v))]; }
  SurfacePoint surface_point(Vertex v) const {
    return {editor_.point(v), elevation_[static_cast<std::size_t>(number(v))]};
  }

  // Deal all candidates out; the triangle that holds each row of points, or has it on its edge.
  // False if `keep_going` was.
  template <typename KeepGoing>
  bool place_all(const std::int32_t* triangle_of_row, KeepGoing&& keep_going) {
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (c % kStepsBetween == 0 && !keep_going()) return false;
      const Triangle t = triangle_numbered(triangle_of_row[candidates_[c].row]);
      const MeshLocation at = location(candidates_[c].point.at, t);
      const bool is_on_edge = at.where == MeshLocation::Where::kOnEdge;
      push(is_on_edge ? owner_of(at.edge) : t, static_cast<CandidateId>(c));
    }
    for (const Triangle t : mesh().triangles()) measure(t);
    return true;
  }

  // A candidate of the triangle is likely to be the next.
  void expect(Triangle) const {}

  // Make a candidate a vertex; `visit` is called for every triangle that is new.
  template <typename Visit>
  Vertex insert(Triangle t, CandidateId c, Visit&& visit) {
    const Candidate& chosen = candidate(c);
    elevation_.push_back(chosen.point.z);
    row_of_.push_back(chosen.row);
    const Vertex v =
        editor_.insert_at(location(chosen.point.at, t), chosen.point.at, editor_.add_slot());
    lists_.resize(mesh().triangle_slots());
    deal_out(v, c);
    for (const Triangle made : star_) visit(made);
    return v;
  }

  // The largest error that a candidate or the vertex itself would have without the vertex, which
  // has no fixed edge; infinity as soon as one is above the limit. Nothing is changed.
  double error_without(Vertex v, double limit) {
    const SurfacePoint kept = surface_point(v);
    save_star(v);
    if (star_gap_.find(editor_, v)) {
      list_gap(star_gap_.triangles());
      return error_in_gap(kept, limit);
    }
    editor_.remove(v);
    find_gap();
    const double error = error_in_gap(kept, limit);
    editor_.insert_at(location(kept.at, gap_[holder_in_gap(kept.at)]), kept.at, v);
    restore_star(v);
    return error;
  }

  // Make a vertex without fixed edges a candidate again.
  void remove(Vertex v) {
    const SurfacePoint kept = surface_point(v);
    save_star(v);
    editor_.remove(v);
    find_gap();
    for (const Triangle t : touched_) lists_[number(t)] = {};
    for (const Spared& spared : spared_) {
      for (CandidateId c = spared.list.first; c != kNoCandidate;) {
        const CandidateId next = candidate(c).next;
        push(gap_[holder_in_gap(candidate(c).point.at)], c);
        c = next;
      }
    }
    const auto again = static_cast<CandidateId>(candidates_.size());
    candidates_.push_back({kept, kNoCandidate, row(v)});
    push(gap_[holder_in_gap(kept.at)], again);
    for (const Triangle t : gap_) measure(t);
  }

 private:
  static constexpr std::size_t kStepsBetween = 1u << 14;

  struct Spoke {
    Point end;
    Triangle triangle;  // on its left
  };
  struct Spared {
    Vertex from, to;  // the edge opposite the vertex in the middle
    CandidateList list;
  };

  void gather(const double* points, const std::vector<bool>& is_vertex) {
    std::vector<Point> places;
    std::vector<std::int32_t> rows;
    for (std::size_t row = 0; row < is_vertex.size(); ++row) {
      if (is_vertex[row]) continue;
      places.push_back({points[3 * row], points[3 * row + 1]});
      rows.push_back(static_cast<std::int32_t>(row));
    }
    const auto count = static_cast<std::int32_t>(places.size());
    candidates_.reserve(places.size());
    if (count == 0) return;
    const HilbertOrder order(places.data(), count);
    for (std::int32_t i = 0; i < count; ++i) {
      const auto item = static_cast<std::size_t>(order[i]);
      const std::int32_t row = rows[item];
      const double z = points[3 * static_cast<std::size_t>(row) + 2];
      candidates_.push_back({{places[item], z}, kNoCandidate, row});
    }
  }

  // ----------------------------------------------------------------- lists

  void push(Triangle t, CandidateId c) {
    CandidateList& list = lists_[number(t)];
    candidates_[static_cast<std::size_t>(c)].next = list.first;
    list.first = c;
  }

  ElevationPlane plane(Triangle t) const {
    const Vertex* const corner = mesh()[t].corner;
    return {surface_point(corner[0]), surface_point(corner[1]), surface_point(corner[2])};
  }

  // Whether a candidate of this error comes before the worst one of a list.
  bool is_worse(double error, CandidateId c, const CandidateList& list) const {
    if (error != list.error || list.worst == kNoCandidate) {
      return error > list.error || list.worst == kNoCandidate;
    }
    return lexicographically_before(candidate(c).point.at, candidate(list.worst).point.at);
  }
  void note(CandidateList& list, CandidateId c, double error) const {
    if (!is_worse(error, c, list)) return;
    list.worst = c;
    list.error = error;
  }

  void measure(Triangle t) {
    if (mesh().is_free(t) || mesh().is_ghost(t)) return;
    CandidateList& list = lists_[number(t)];
    if (list.first == kNoCandidate) return;
    const ElevationPlane over = plane(t);
    list.worst = kNoCandidate;
    for (CandidateId c = list.first; c != kNoCandidate; c = candidate(c).next) {
      note(list, c, over.error(candidate(c).point.at, candidate(c).point.z, weights_));
    }
  }

  // ------------------------------------------------------------- location

  // The triangle that the points on an edge belong to.
  Triangle owner_of(HalfEdge e) const {
    const Vertex from = mesh().from(e), to = mesh().to(e);
    const bool is_forward = lexicographically_before(editor_.point(from), editor_.point(to));
    const HalfEdge owner = is_forward ? e : mesh().twin(e);
    return triangle_of(mesh().apex(owner) == kGhost ? mesh().twin(owner) : owner);
  }

  // Where a candidate of a triangle is in it.
  MeshLocation location(Point p, Triangle t) const {
    for (const HalfEdge e : half_edges(t)) {
      const Point from = editor_.point(mesh().from(e)), to = editor_.point(mesh().to(e));
      if (orientation(from, to, p) == 0) return {MeshLocation::Where::kOnEdge, e};
    }
    return {MeshLocation::Where::kInside, half_edge(t, 0)};
  }

  // ------------------------------------------------------------ insertion

  // Deal the candidates around a new vertex out to its triangles, but for the one that it was.
  void deal_out(Vertex v, CandidateId gone) {
    gather_star(v);
    moved_.clear();
    for (const Triangle t : star_) {
      for (CandidateId c = lists_[number(t)].first; c != kNoCandidate; c = candidate(c).next) {
        if (c != gone) moved_.push_back(c);
      }
      lists_[number(t)] = {};
    }
    planes_.clear();
    for (const Triangle t : star_) planes_.push_back(plane(t));
    const Point middle = editor_.point(v);
    std::size_t at = 0;
    for (const CandidateId c : moved_) {
      const SurfacePoint& p = candidate(c).point;
      at = sector(middle, p.at, at);
      push(star_[at], c);
      note(lists_[number(star_[at])], c, planes_[at].error(p.at, p.z, weights_));
    }
  }

  // The triangles at a vertex counter-clockwise, and the ends of its edges: one more at the hull.
  void gather_star(Vertex v) {
    star_.clear();
    spokes_.clear();
    HalfEdge first = mesh().leaving(v);
    is_open_ = false;
    for (const HalfEdge e : mesh().around(v)) {
      if (!mesh().is_ghost(triangle_of(mesh().twin(e))) || mesh().is_ghost(triangle_of(e)))
        continue;
      first = e;
      is_open_ = true;
    }
    HalfEdge e = first;
    do {
      star_.push_back(triangle_of(e));
      spokes_.push_back(editor_.point(mesh().to(e)));
      e = mesh().next_leaving(e);
    } while (e != first && !mesh().is_ghost(triangle_of(e)));
    spokes_.push_back(editor_.point(mesh().to(e)));
  }

  // The place in the star of a point that is in it; the search begins at a place nearby.
  std::size_t sector(Point middle, Point p, std::size_t at) const {
    const std::size_t count = star_.size();
    if (orientation(middle, spokes_[at], p) < 0) {
      do {
        if (at == 0 && is_open_) return 0;
        at = (at == 0 ? count : at) - 1;
      } while (orientation(middle, spokes_[at], p) < 0);
      return is_on_spoke(middle, p, at) ? owner_at(middle, at) : at;
    }
    while (true) {
      const int side = orientation(middle, spokes_[at + 1], p);
      if (side < 0) return is_on_spoke(middle, p, at) ? owner_at(middle, at) : at;
      if (at + 1 == count && is_open_) return at;
      at = at + 1 == count ? 0 : at + 1;
    }
  }

  // Of a point that is not right of a spoke, and right of the next one.
  bool is_on_spoke(Point middle, Point p, std::size_t at) const {
    return orientation(middle, spokes_[at], p) == 0;
  }
  std::size_t owner_at(Point middle, std::size_t spoke) const {
    if (lexicographically_before(middle, spokes_[spoke])) return spoke;
    if (spoke > 0) return spoke - 1;
    return is_open_ ? 0 : star_.size() - 1;
  }

  // -------------------------------------------------------------- removal

  void save_star(Vertex v) {
    spared_.clear();
    for (const HalfEdge e : mesh().around(v)) {
      const HalfEdge opposite = Mesh::after(e);
      spared_.push_back({mesh().from(opposite), mesh().to(opposite), list(triangle_of(e))});
    }
    editor_.take_touched(touched_);
  }

  // After the vertex was put back, its triangles hold what they held.
  void restore_star(Vertex v) {
    const auto comes_before = [](const Spared& one, const Spared& other) {
      return one.from < other.from;
    };
    std::sort(spared_.begin(), spared_.end(), comes_before);
    for (const HalfEdge e : mesh().around(v)) {
      const Spared same{mesh().from(Mesh::after(e)), kGhost, {}};
      const auto at = std::lower_bound(spared_.begin(), spared_.end(), same, comes_before);
      if (at != spared_.end() && at->from == same.from) lists_[number(triangle_of(e))] = at->list;
    }
    editor_.take_touched(touched_);
  }

  // The triangles in the place of the star of a vertex that was removed.
  void find_gap() {
    editor_.take_touched(touched_);
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    gap_.clear();
    made_.clear();
    for (const Triangle t : touched_) {
      if (mesh().is_free(t) || mesh().is_ghost(t)) continue;
      const auto& corner = mesh()[t].corner;
      gap_.push_back(t);
      made_.push_back({{corner[0], corner[1], corner[2]}});
    }
    list_gap(made_);
  }

  // Triangles in the place of a star, of the mesh or only thought of.
  void list_gap(const std::vector<GapTriangle>& triangles) {
    in_gap_.clear();
    planes_.clear();
    for (const GapTriangle& t : triangles) {
      const SurfacePoint a = surface_point(t.corner[0]), b = surface_point(t.corner[1]);
      const SurfacePoint c = surface_point(t.corner[2]);
      in_gap_.push_back({{a.at, b.at, c.at}});
      planes_.emplace_back(a, b, c);
    }
    last_ = 0;
  }

  double error_in_gap(const SurfacePoint& gone, double limit) {
    double worst = error_of(gone);
    for (const Spared& spared : spared_) {
      for (CandidateId c = spared.list.first; c != kNoCandidate && worst <= limit;) {
        worst = std::max(worst, error_of(candidate(c).point));
        c = candidate(c).next;
      }
    }
    return worst <= limit ? worst : std::numeric_limits<double>::infinity();
  }
  double error_of(const SurfacePoint& p) {
    return planes_[holder_in_gap(p.at)].error(p.at, p.z, weights_);
  }

  // The triangle of the gap that a point belongs to; one on the edge of the gap is its own.
  std::size_t holder_in_gap(Point p) {
    for (const bool is_on_border : {false, true}) {
      for (std::size_t i = 0; i < in_gap_.size(); ++i) {
        const std::size_t k = (last_ + i) % in_gap_.size();
        if (holds(in_gap_[k], p, is_on_border)) return last_ = k;
      }
    }
    throw std::logic_error("no triangle holds a point of those that went");
  }

  struct Corners {
    Point at[3];  // counter-clockwise
  };

  // Whether a point is in a triangle, or on an edge that runs on from its lexicographically first
  // end, or on any.
  static bool holds(const Corners& t, Point p, bool is_on_border) {
    for (int k = 0; k < 3; ++k) {
      const Point from = t.at[k], to = t.at[k < 2 ? k + 1 : 0];
      const int side = orientation(from, to, p);
      if (side < 0) return false;
      if (side == 0 && !is_on_border && !lexicographically_before(from, to)) return false;
    }
    return true;
  }

  MeshEditor& editor_;
  const SideWeights weights_;
  std::vector<double> elevation_;     // by slot
  std::vector<std::int32_t> row_of_;  // likewise
  std::vector<Candidate> candidates_;
  std::vector<CandidateList> lists_;  // by triangle

  // Of the change at hand.
  std::vector<Triangle> star_, touched_, gap_;
  StarGap star_gap_;
  std::vector<GapTriangle> made_;  // gap_ by corners
  std::vector<Corners> in_gap_;
  std::vector<Point> spokes_;  // spoke i is on the right of triangle i, i + 1 on its left
  bool is_open_ = false;       // whether the star is at the hull
  std::vector<CandidateId> moved_;
  std::vector<ElevationPlane> planes_;
  std::vector<Spared> spared_;
  std::size_t last_ = 0;
};

}  // namespace tinsmith
