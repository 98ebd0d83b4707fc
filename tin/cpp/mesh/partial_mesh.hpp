// A mesh of given arrays of which only the triangles that change are copied: the first edits of a
// large surface do not wait for a copy of all of it.
//
// Triangles have the numbers of the arrays; ghosts and those that are made come behind them. A
// vertex that was in no change has the triangles of the arrays. A triangle that was in none is read
// where it is: whoever changes one changes its neighbours too, so theirs are as the arrays say.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../location/visibility_walk.hpp"
#include "../predicates/predicates.hpp"
#include "given_triangles.hpp"
#include "mesh.hpp"
#include "mesh_editor.hpp"
#include "number_table.hpp"
#include "triangle_samples.hpp"

namespace tinsmith {

// What is added stays where it is.
template <typename T>
class Blocks {
 public:
  std::uint32_t size() const { return size_; }
  T& operator[](std::uint32_t i) const { return blocks_[i / kBlock][i % kBlock]; }
  // The number of one more, which is anything.
  std::uint32_t add() {
    if (size_ % kBlock == 0) blocks_.emplace_back(new T[kBlock]);
    return size_++;
  }

 private:
  static constexpr std::uint32_t kBlock = 256;

  std::vector<std::unique_ptr<T[]>> blocks_;
  std::uint32_t size_ = 0;
};

class TouchedTriangles {
 public:
  static constexpr bool kFindsVertices = true;

  // Rows and arrays stay as they are and as long as this does.
  TouchedTriangles(const PointRows& rows, const GivenTriangles& given)
      : rows_(rows), given_(given) {
    const std::size_t count = page_of(Triangle{first_own()}) + 1;
    pages_.reset(static_cast<Cell**>(std::calloc(count, sizeof(Cell*))));
    if (!pages_) throw std::bad_alloc();
  }

  // Searches that went through all triangles.
  int scans() const { return scans_; }

  std::uint32_t slots() const { return first_own() + own_.size(); }
  GhostTriangle& operator[](Triangle t) { return cell(t).triangle; }
  Vertex corner(Triangle t, std::uint32_t k) const {
    return is_as_given(t) ? given_corner(t, k) : cell(t).triangle.corner[k];
  }
  HalfEdge twin(HalfEdge e) const {
    const Triangle t = triangle_of(e);
    return is_as_given(t) ? given_or_ghost_twin(e) : twin(e, cell(t).triangle);
  }
  const GhostTriangle& complete(Triangle t) const {
    GhostTriangle& found = cell(t).triangle;
    for (const HalfEdge e : half_edges(t)) twin(e, found);
    return found;
  }
  std::uint8_t bits(Triangle t) const {
    return is_as_given(t) ? given_.fixed_bits(t) : cell(t).bits;
  }
  std::uint8_t& bits(Triangle t) { return cell(t).bits; }

  Triangle add() { return add_cell(); }

  HalfEdge leaving(Vertex v) const {
    const std::uint32_t* const known = leaving_.find(key(v));
    if (known != nullptr) return HalfEdge{*known};
    if (number(v) >= rows_.count) return kNoHalfEdge;
    const HalfEdge found = find_leaving(v);
    leaving_.put(key(v), number(found));
    return found;
  }
  void set_leaving(Vertex v, HalfEdge e) { leaving_.put(key(v), number(e)); }
  void add_vertices(std::size_t) {}
  void drop_last_vertex() {}  // which was removed, so that no edge leaves it

  // One of the arrays' that may be near, and may be gone.
  Vertex vertex_near(Point p) const {
    const Triangle t = triangle_near(p);
    const Vertex v = given_corner(t, 0);
    if (leaving_.find(key(v)) == nullptr) leaving_.put(key(v), number(half_edge(t, 2)));
    return v;
  }

 private:
  static constexpr int kMostSteps = 1000;
  static constexpr std::int32_t kBeside = 10;

  struct Cell {
    GhostTriangle triangle;
    std::uint8_t bits;
  };

  // Triangles of the arrays are copied by pages of some that follow each other.
  static constexpr std::uint32_t kPage = 4;
  struct Page {
    Cell cells[kPage];
  };
  static std::size_t page_of(Triangle t) { return number(t) / kPage; }

  static std::uint32_t key(Vertex v) { return static_cast<std::uint32_t>(number(v)); }
  Vertex given_corner(Triangle t, std::uint32_t k) const {
    return Vertex{given_.corners[entry_of(t, k)]};
  }

  bool is_given(Triangle t) const { return index_of(t) < given_.count; }
  bool is_as_given(Triangle t) const { return is_given(t) && pages_[page_of(t)] == nullptr; }

  Cell& cell(Triangle t) const {
    if (!is_given(t)) return own_[number(t) - first_own()];
    Cell*& page = pages_[page_of(t)];
    if (page == nullptr) page = copy_page(number(t) - number(t) % kPage);
    return page[number(t) % kPage];
  }

  Cell* copy_page(std::uint32_t first) const {
    Cell* const page = copies_[copies_.add()].cells;
    const std::uint32_t count = std::min(kPage, first_own() - first);
    for (std::uint32_t i = 0; i < count; ++i) copy(Triangle{first + i}, page[i]);
    return page;
  }

  // Those behind the arrays.
  std::uint32_t first_own() const { return static_cast<std::uint32_t>(given_.count); }
  Triangle add_cell() const {
    const std::uint32_t place = own_.add();
    own_[place] = {};
    return Triangle{first_own() + place};
  }

  // Which corner of the triangle across an edge is opposite to it, nobody knows who does not look
  // at that triangle; twin() does when it is asked, and what is not known to it has no corner yet.
  void copy(Triangle t, Cell& made) const {
    for (std::uint32_t k = 0; k < 3; ++k) {
      made.triangle.corner[k] = given_corner(t, k);
      made.triangle.twin[k] = unentered(triangle_numbered(given_.neighbors[entry_of(t, k)]));
    }
    made.bits = given_.fixed_bits(t);
  }
  static_assert(unentered(kNoTriangle) == kNoHalfEdge && corner_of(kNoHalfEdge) == kNoCorner);

  HalfEdge twin(HalfEdge e, GhostTriangle& triangle) const {
    HalfEdge& known = triangle.twin[corner_of(e)];
    if (corner_of(known) != kNoCorner) return known;
    known = is_given(triangle_of(e)) ? given_or_ghost_twin(e) : ghost_twin(e);
    return known;
  }
  HalfEdge given_or_ghost_twin(HalfEdge e) const {
    return is_outer(e) ? half_edge(ghost_at(e), 0) : given_twin(e);
  }

  // As Mesh holds them, of the arrays.
  bool is_outer(HalfEdge e) const { return given_.neighbors[entry_of(e)] == kNoNeighbor; }
  HalfEdge given_twin(HalfEdge e) const {
    return given_.twin(triangle_of(e), triangle_numbered(given_.neighbors[entry_of(e)]));
  }
  static HalfEdge after(HalfEdge e) { return BasicMesh<TouchedTriangles>::after(e); }
  static HalfEdge before(HalfEdge e) { return BasicMesh<TouchedTriangles>::before(e); }

  // Beyond an edge of the boundary.
  Triangle ghost_at(HalfEdge e) const {
    const std::uint32_t* const known = ghosts_.find(number(e));
    if (known != nullptr) return Triangle{*known};
    const Triangle ghost = add_cell(), t = triangle_of(e);
    ghosts_.put(number(e), number(ghost));
    outer_edges_.put(number(ghost), number(e));
    const std::uint32_t k = corner_of(e);
    Cell& made = cell(ghost);
    made.triangle = {{kGhost, given_corner(t, corner_before(k)), given_corner(t, corner_after(k))},
                     {e, kNoHalfEdge, kNoHalfEdge}};
    made.bits = static_cast<std::uint8_t>(given_.fixed_bits(t) >> k & 1);
    return ghost;
  }
  // Of the ghost before or after it along the boundary, joined as those of mesh_arrays.hpp.
  HalfEdge ghost_twin(HalfEdge e) const {
    const HalfEdge outer{*outer_edges_.find(number(triangle_of(e)))};
    const bool is_next = corner_of(e) == 2;
    HalfEdge beside = is_next ? after(outer) : before(outer);
    while (!is_outer(beside)) {
      beside = is_next ? after(given_twin(beside)) : before(given_twin(beside));
    }
    return half_edge(ghost_at(beside), is_next ? 1 : 2);
  }

  // ------------------------------------------------------------------ finding

  Triangle triangle_near(Point p) const {
    if (!samples_.are_set()) samples_.set(rows_, given_);
    return samples_.near(rows_, given_, p);
  }

  // In the arrays: among those that follow each other about where it should be; else by a walk
  // that any edge will do for; and should that stray, by looking at all.
  HalfEdge find_leaving(Vertex v) const {
    const Point p = rows_[number(v)];
    Triangle t = triangle_near(p);
    const std::int32_t begin = std::max(0, index_of(t) - kBeside);
    const HalfEdge beside = scan(v, begin, std::min(given_.count, index_of(t) + kBeside));
    if (beside != kNoHalfEdge) return beside;
    for (int step = 0; step < kMostSteps; ++step) {
      const std::uint32_t k = corner_at(t, v);
      if (k != kNoCorner) return half_edge(t, corner_before(k));
      const std::int32_t beyond = towards(t, p, static_cast<std::uint32_t>(step % 3));
      if (beyond == kNoNeighbor) break;
      t = triangle_numbered(beyond);
    }
    ++scans_;
    return scan(v, 0, given_.count);
  }

  std::uint32_t corner_at(Triangle t, Vertex v) const {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (given_corner(t, k) == v) return k;
    }
    return kNoCorner;
  }

  // The triangle across an edge that has p on its other side, tried from a corner on.
  std::int32_t towards(Triangle t, Point p, std::uint32_t k) const {
    for (int i = 0; i < 3; ++i, k = corner_after(k)) {
      const Point a = rows_[number(given_corner(t, corner_after(k)))];
      const Point b = rows_[number(given_corner(t, corner_before(k)))];
      if (orientation(a, b, p) < 0) return given_.neighbors[entry_of(t, k)];
    }
    return kNoNeighbor;
  }

  // Of the triangles from one on up to, but without another.
  HalfEdge scan(Vertex v, std::int32_t first, std::int32_t beyond) const {
    const std::size_t begin = entry_of(triangle_numbered(first), 0);
    const std::size_t end = entry_of(triangle_numbered(beyond), 0);
    const std::int32_t* const found =
        std::find(given_.corners + begin, given_.corners + end, number(v));
    if (found == given_.corners + end) return kNoHalfEdge;
    const HalfEdge e = half_edge_at(static_cast<std::size_t>(found - given_.corners));
    return half_edge(triangle_of(e), corner_before(corner_of(e)));
  }

  PointRows rows_;
  GivenTriangles given_;
  // What is copied when it changes, and ghosts made when they are looked at.
  mutable std::unique_ptr<Cell*[], FreeMemory> pages_;
  mutable Blocks<Page> copies_;
  mutable Blocks<Cell> own_;
  mutable NumberTable leaving_, ghosts_, outer_edges_;
  mutable TriangleSamples samples_;
  mutable int scans_ = 0;
};

// The given rows, but for vertices that were put elsewhere, and those that came.
class TouchedPoints {
 public:
  explicit TouchedPoints(const PointRows& rows)
      : rows_(rows), is_moved_(static_cast<std::size_t>(rows.count)) {}

  Point operator[](Vertex v) const {
    const auto slot = static_cast<std::size_t>(number(v));
    if (number(v) >= rows_.count) return added_[slot - is_moved_.size()];
    return is_moved_[slot] ? moved_[*place_of_.find(static_cast<std::uint32_t>(slot))]
                           : rows_[number(v)];
  }
  std::int32_t slots() const { return static_cast<std::int32_t>(rows_.count + added_.size()); }

  Vertex add(Point p) {
    added_.push_back(p);
    return Vertex{slots() - 1};
  }
  void drop_last() { added_.pop_back(); }

  void put(Vertex v, Point p) {
    const auto slot = static_cast<std::size_t>(number(v));
    if (number(v) >= rows_.count) {
      added_[slot - is_moved_.size()] = p;
    } else if (is_moved_[slot]) {
      moved_[*place_of_.find(static_cast<std::uint32_t>(slot))] = p;
    } else {
      is_moved_[slot] = true;
      place_of_.put(static_cast<std::uint32_t>(slot), static_cast<std::uint32_t>(moved_.size()));
      moved_.push_back(p);
    }
  }

 private:
  PointRows rows_;
  std::vector<bool> is_moved_;  // by given row
  NumberTable place_of_;        // among those moved
  std::vector<Point> moved_, added_;
};

using PartialMesh = BasicMesh<TouchedTriangles>;
using PartialEditor = BasicMeshEditor<PartialMesh, TouchedPoints>;

}  // namespace tinsmith
