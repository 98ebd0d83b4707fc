// A TIN while it is edited: its mesh, elevations, the numbers of its vertices, and a log of edits.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../base/range.hpp"
#include "checked_mesh.hpp"
#include "elevations.hpp"
#include "mesh_arrays.hpp"
#include "partial_mesh.hpp"
#include "vertex_numbers.hpp"

namespace tinsmith {

// A vertex as the caller gives it: -0.0 may be among its coordinates.
struct GivenVertex {
  double x, y, z;

  Point place() const { return {x + 0.0, y + 0.0}; }
  double elevation() const { return z + 0.0; }
  bool is_sound() const { return is_in_exact_range(x) && is_in_exact_range(y) && is_elevation(z); }
};

// An edit of one vertex that was done: the vertex as it was numbered then, its slot, and what was
// given; with a new elevation the place.
struct EditRecord {
  enum class Kind : std::int32_t { kInsert, kRemove, kMove, kSetElevation };
  Kind kind;
  std::int32_t vertex;
  Vertex slot;
  GivenVertex given;
};

// The first edits copy only the triangles that they touch (partial_mesh.hpp). The mesh of all is
// made when more is asked for, or after so many edits that it is the quicker one; the edits so far
// are done again in it. As the triangulation is unique, it makes no difference which it is.
//
// An edit of one vertex is done here if it changes nothing but the triangles around it: it is done
// and logged, or nothing is changed and the caller is told that more is to be done, or to be said.
class EditedMesh {
 public:
  static constexpr std::int32_t kNotDone = -1;

  // Rows of three that stay as long as this does; `lines` are the slots of vertices of lines alone.
  EditedMesh(PointRows rows, Range lines)
      : rows_(rows),
        elevations_(rows.data, static_cast<std::int32_t>(rows.count)),
        numbers_(static_cast<std::int32_t>(rows.count), lines) {}

  // The triangles of all slots, or of those that hold a vertex; needed until the mesh is whole.
  void open(const GivenTriangles& given) {
    given_ = given;
    part_ = std::make_unique<PartialEditor>(PartialMesh(TouchedTriangles(rows_, given)),
                                            TouchedPoints(rows_), numbers_.count());
  }
  bool is_open() const { return part_ || mesh_; }
  bool is_whole() const { return mesh_ != nullptr; }
  // All triangles, with all vertices in their slots.
  const std::shared_ptr<CheckedMesh>& mesh() {
    require_open();
    if (!mesh_) make_whole();
    return mesh_;
  }
  void leave_empty(Vertex slot) { numbers_.empty(slot); }

  // Vertices that come no nearer than this to an edge around them reach no line; without lines any
  // may come.
  void keep_clear(double distance) {
    has_lines_ = true;
    least_clearance_ = distance;
  }

  // Edits of one vertex are refused but between these two, in which nobody else may look.
  void lend() { is_lent_ = true; }
  void take_back() { is_lent_ = false; }

  const VertexNumbers& numbers() const { return numbers_; }
  std::int32_t slots() const { return numbers_.held().slots(); }
  Point place(Vertex slot) const {
    if (mesh_) return mesh_->editor().point(slot);
    return part_ ? part_->point(slot) : rows_[number(slot)];
  }
  double elevation(Vertex slot) const { return elevations_[slot]; }

  // --------------------------------------------------- one vertex, by its number

  // The number of the new vertex, or kNotDone.
  std::int32_t insert(const GivenVertex& given) {
    if (!is_ready() || !given.is_sound() || slots() >= kMostPoints) return kNotDone;
    const Unfinished unfinished(is_sound_);
    const Vertex slot{slots()};
    const bool is_done = with_editor([&](auto& editor) {
      const MeshLocation at = editor.locate(given.place());
      if (!can_insert(editor, at)) return false;
      editor.add_slot();
      editor.insert_at(at, given.place(), slot);
      if (is_clear(editor, slot)) return true;
      editor.remove(slot);
      editor.drop_last_slot();
      return false;
    });
    if (!is_done) return kNotDone;
    numbers_.add(true);
    elevations_.add(given.elevation());
    note({Step::kInsert, slot, given.place()});
    return log(EditRecord::Kind::kInsert, numbers_.of(slot), slot, given);
  }

  bool remove(std::int32_t vertex) {
    if (!is_ready() || !numbers_.is_vertex(vertex)) return false;
    const Vertex slot = numbers_.slot_of(vertex);
    const Unfinished unfinished(is_sound_);
    const bool is_done = with_editor([&](auto& editor) {
      if (!is_clear(editor, slot) || !editor.can_remove(slot)) return false;
      editor.remove(slot);
      return true;
    });
    if (!is_done) return false;
    numbers_.empty(slot);
    note({Step::kRemove, slot, {}});
    log(EditRecord::Kind::kRemove, vertex, slot, {});
    return true;
  }

  bool move(std::int32_t vertex, const GivenVertex& given) {
    if (!is_ready() || !given.is_sound() || !numbers_.is_vertex(vertex)) return false;
    const Vertex slot = numbers_.slot_of(vertex);
    if (has_lines_ && has_fixed_edge(slot)) return false;
    if (!(place(slot) == given.place()) && !move_in_plane(slot, given.place())) return false;
    elevations_.put(slot, given.elevation());
    log(EditRecord::Kind::kMove, vertex, slot, given);
    return true;
  }

  bool set_elevation(std::int32_t vertex, double z) {
    if (!is_lent_ || !is_sound_ || !is_elevation(z)) return false;
    if (!numbers_.is_vertex(vertex)) return false;
    const Vertex slot = numbers_.slot_of(vertex);
    if (has_lines_ && (!is_open() || has_fixed_edge(slot))) return false;
    elevations_.put(slot, z + 0.0);
    log(EditRecord::Kind::kSetElevation, vertex, slot, {place(slot).x, place(slot).y, z});
    return true;
  }

  // False after a change that was broken off: the mesh is not to be used any more.
  bool is_sound() const { return is_sound_; }

  std::size_t logged() const { return log_.size(); }
  std::vector<EditRecord> take_log() { return std::exchange(log_, {}); }

  // ---------------------------------------------- vertices by slot, not logged

  // As CheckedMesh; a slot is made for each point, and stays empty where there was a vertex.
  void insert_all(const double* rows, std::int32_t count, std::int32_t* result) {
    require_open();
    const std::int32_t first = slots();
    if (count == 1) {
      *result = number(insert_one({rows[0], rows[1]}));
    } else {
      std::vector<Point> places(static_cast<std::size_t>(count));
      for (std::int32_t i = 0; i < count; ++i) places[i] = {rows[3 * i], rows[3 * i + 1]};
      mesh()->insert(places.data(), count, result);
    }
    for (std::int32_t i = 0; i < count; ++i) {
      numbers_.add(result[i] == first + i);
      elevations_.add(rows[3 * i + 2]);
    }
  }

  // False if no triangle would be left.
  bool empty(Vertex slot) {
    require_open();
    if (!numbers_.held().holds(number(checked(slot)))) {
      throw std::invalid_argument("there is no such vertex");
    }
    const bool is_done = with_editor([&](auto& editor) {
      if (editor.has_fixed_edge(slot)) {
        throw std::invalid_argument("a fixed edge ends at the vertex");
      }
      if (!editor.can_remove(slot)) return false;
      editor.remove(slot);
      return true;
    });
    if (!is_done) return false;
    numbers_.empty(slot);
    note({Step::kRemove, slot, {}});
    return true;
  }
  Vertex fill(Vertex slot, Point p) {
    require_open();
    if (numbers_.held().holds(number(checked(slot)))) {
      throw std::invalid_argument("the slot must be one whose vertex was removed");
    }
    const Vertex found = with_editor([&](auto& editor) { return editor.insert(p, slot); });
    if (found != slot) return found;
    numbers_.fill(slot);
    note({Step::kFill, slot, p});
    return found;
  }
  // Whether the vertex is as far from lines as it must be.
  bool is_clear(Vertex slot) {
    require_open();
    return with_editor([&](auto& editor) { return is_clear(editor, checked(slot)); });
  }
  bool has_fixed_edge(Vertex slot) {
    require_open();
    return with_editor([&](auto& editor) { return editor.has_fixed_edge(checked(slot)); });
  }
  void put_elevation(Vertex slot, double z) { elevations_.put(checked(slot), z); }

  Vertex checked(Vertex slot) const {
    if (slot < Vertex{0} || number(slot) >= slots()) throw std::invalid_argument("no such slot");
    return slot;
  }

 private:
  // While it lives the mesh is being changed; it is not sound if an error ends that.
  class Unfinished {
   public:
    explicit Unfinished(bool& is_sound) : is_sound_(is_sound), errors_(std::uncaught_exceptions()) {
      is_sound_ = false;
    }
    ~Unfinished() { is_sound_ = std::uncaught_exceptions() == errors_; }
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

   private:
    bool& is_sound_;
    int errors_;
  };

  // What was done before there was a mesh of all triangles.
  struct Step {
    enum Kind { kInsert, kLeaveEmpty, kRemove, kFill };
    Kind kind;
    Vertex slot;
    Point place;
  };

  bool is_ready() const { return is_lent_ && is_open() && is_sound_; }
  void require_open() const {
    if (!is_open()) throw std::invalid_argument("the mesh must be opened first");
  }

  // What there is to be edited.
  template <typename Do>
  auto with_editor(Do&& edit) -> decltype(edit(std::declval<MeshEditor&>())) {
    if (part_ && is_part_worn()) make_whole();
    return part_ ? edit(*part_) : edit(mesh_->editor_to_change());
  }

  // An edit takes some microseconds more than in the mesh of all, which takes as long to make as
  // about so many of these.
  bool is_part_worn() const {
    const std::size_t most = kLeastEdits + static_cast<std::size_t>(given_.count) / kShare;
    return steps_.size() > most || part_->mesh().store().scans() > kMostScans;
  }
  static constexpr std::size_t kLeastEdits = 64, kShare = 64;
  static constexpr int kMostScans = 4;

  void make_whole() {
    MeshEditor editor = editor_of(rows_, given_);
    for (const Step& step : steps_) {
      if (step.kind == Step::kInsert || step.kind == Step::kLeaveEmpty) editor.add_slot();
      if (step.kind == Step::kInsert || step.kind == Step::kFill) {
        editor.insert(step.place, step.slot);
      } else if (step.kind == Step::kRemove) {
        editor.remove(step.slot);
      }
    }
    mesh_ = std::make_shared<CheckedMesh>(std::move(editor));
    free_memory(steps_);
    part_.reset();
  }

  void note(const Step& step) {
    if (part_) steps_.push_back(step);
  }

  // The vertex at the point: of a slot behind the others, or the one that is there.
  Vertex insert_one(Point p) {
    const Vertex slot{slots()};
    const Vertex found = with_editor([&](auto& editor) {
      editor.add_slot();
      return editor.insert(p, slot);
    });
    note({found == slot ? Step::kInsert : Step::kLeaveEmpty, slot, p});
    return found;
  }

  template <typename Editor>
  static bool can_insert(const Editor& editor, const MeshLocation& at) {
    if (at.where == MeshLocation::Where::kAtVertex) return false;
    return at.where != MeshLocation::Where::kOnEdge || !editor.mesh().is_fixed(at.edge);
  }
  template <typename Editor>
  bool is_clear(const Editor& editor, Vertex slot) const {
    return !has_lines_ ||
           (!editor.has_fixed_edge(slot) && editor.clearance(slot) > least_clearance_);
  }

  // Whether it was moved.
  bool move_in_plane(Vertex slot, Point p) {
    const Unfinished unfinished(is_sound_);
    const bool is_done = with_editor([&](auto& editor) {
      if (!is_clear(editor, slot) || !editor.can_remove(slot)) return false;
      const Point before = editor.point(slot);
      editor.remove(slot);
      const MeshLocation at = editor.locate(p);
      if (can_insert(editor, at)) {
        editor.insert_at(at, p, slot);
        if (is_clear(editor, slot)) return true;
        editor.remove(slot);
      }
      editor.insert(before, slot);
      return false;
    });
    if (!is_done) return false;
    note({Step::kRemove, slot, {}});
    note({Step::kFill, slot, p});
    return true;
  }

  std::int32_t log(EditRecord::Kind kind, std::int32_t vertex, Vertex slot, GivenVertex given) {
    log_.push_back({kind, vertex, slot, given});
    return vertex;
  }

  PointRows rows_;
  GivenTriangles given_{};
  // Until the mesh is made: triangles that were touched, and what was done to them.
  std::unique_ptr<PartialEditor> part_;
  std::vector<Step> steps_;
  std::shared_ptr<CheckedMesh> mesh_;
  Elevations elevations_;
  VertexNumbers numbers_;
  bool has_lines_ = false, is_lent_ = false, is_sound_ = true;
  double least_clearance_ = 0.0;
  std::vector<EditRecord> log_;
};

}  // namespace tinsmith
