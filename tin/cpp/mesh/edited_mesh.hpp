// A TIN while it is edited: its mesh, elevations, the numbers of its vertices, and a log of edits.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../base/range.hpp"
#include "checked_mesh.hpp"
#include "elevations.hpp"
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

  // The triangles of all slots, or of those that hold a vertex.
  void open(CheckedMesh mesh) { mesh_ = std::make_shared<CheckedMesh>(std::move(mesh)); }
  const std::shared_ptr<CheckedMesh>& mesh() const { return mesh_; }
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
    return mesh_ ? mesh_->editor().point(slot) : rows_[number(slot)];
  }
  double elevation(Vertex slot) const { return elevations_[slot]; }

  // --------------------------------------------------- one vertex, by its number

  // The number of the new vertex, or kNotDone.
  std::int32_t insert(const GivenVertex& given) {
    if (!is_ready() || !given.is_sound() || slots() >= kMostPoints) return kNotDone;
    const Unfinished unfinished(is_sound_);
    const MeshLocation at = editor().locate(given.place());
    const Vertex slot{slots()};
    if (can_insert(at)) {
      editor().add_slot();
      editor().insert_at(at, given.place(), slot);
      if (is_clear(slot)) {
        numbers_.add(true);
        elevations_.add(given.elevation());
        return log(EditRecord::Kind::kInsert, numbers_.of(slot), slot, given);
      }
      editor().remove(slot);
      editor().drop_last_slot();
    }
    return kNotDone;
  }

  bool remove(std::int32_t vertex) {
    if (!is_ready() || !numbers_.is_vertex(vertex)) return false;
    const Vertex slot = numbers_.slot_of(vertex);
    if (!is_clear(slot) || !editor().can_remove(slot)) return false;
    const Unfinished unfinished(is_sound_);
    editor().remove(slot);
    numbers_.empty(slot);
    log(EditRecord::Kind::kRemove, vertex, slot, {});
    return true;
  }

  bool move(std::int32_t vertex, const GivenVertex& given) {
    if (!is_ready() || !given.is_sound() || !numbers_.is_vertex(vertex)) return false;
    const Vertex slot = numbers_.slot_of(vertex);
    if (has_lines_ && editor().has_fixed_edge(slot)) return false;
    if (!(place(slot) == given.place()) && !move_in_plane(slot, given.place())) return false;
    elevations_.put(slot, given.elevation());
    log(EditRecord::Kind::kMove, vertex, slot, given);
    return true;
  }

  bool set_elevation(std::int32_t vertex, double z) {
    if (!is_lent_ || !is_sound_ || !is_elevation(z)) return false;
    if (!numbers_.is_vertex(vertex)) return false;
    const Vertex slot = numbers_.slot_of(vertex);
    if (has_lines_ && (!mesh_ || editor().has_fixed_edge(slot))) return false;
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
    std::vector<Point> places(static_cast<std::size_t>(count));
    for (std::int32_t i = 0; i < count; ++i) places[i] = {rows[3 * i], rows[3 * i + 1]};
    const std::int32_t first = slots();
    opened().insert(places.data(), count, result);
    for (std::int32_t i = 0; i < count; ++i) {
      numbers_.add(result[i] == first + i);
      elevations_.add(rows[3 * i + 2]);
    }
  }

  bool empty(Vertex slot) {
    const std::int32_t vertex = number(slot);
    if (!opened().remove(&vertex, 1)) return false;
    numbers_.empty(slot);
    return true;
  }
  Vertex fill(Vertex slot, Point p) {
    const Vertex found = opened().put(slot, p);
    if (found == slot) numbers_.fill(slot);
    return found;
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

  bool is_ready() const { return is_lent_ && mesh_ && is_sound_; }
  MeshEditor& editor() { return mesh_->editor(); }
  CheckedMesh& opened() {
    if (!mesh_) throw std::invalid_argument("the mesh must be opened first");
    return *mesh_;
  }

  bool can_insert(const MeshLocation& at) {
    if (at.where == MeshLocation::Where::kAtVertex) return false;
    return at.where != MeshLocation::Where::kOnEdge || !editor().mesh().is_fixed(at.edge);
  }
  bool is_clear(Vertex slot) {
    return !has_lines_ ||
           (!editor().has_fixed_edge(slot) && editor().clearance(slot) > least_clearance_);
  }

  // Whether it was moved.
  bool move_in_plane(Vertex slot, Point p) {
    if (!is_clear(slot) || !editor().can_remove(slot)) return false;
    const Unfinished unfinished(is_sound_);
    const Point before = place(slot);
    editor().remove(slot);
    const MeshLocation at = editor().locate(p);
    if (can_insert(at)) {
      editor().insert_at(at, p, slot);
      if (is_clear(slot)) return true;
      editor().remove(slot);
    }
    editor().insert(before, slot);
    return false;
  }

  std::int32_t log(EditRecord::Kind kind, std::int32_t vertex, Vertex slot, GivenVertex given) {
    log_.push_back({kind, vertex, slot, given});
    return vertex;
  }

  PointRows rows_;
  std::shared_ptr<CheckedMesh> mesh_;
  Elevations elevations_;
  VertexNumbers numbers_;
  bool has_lines_ = false, is_lent_ = false, is_sound_ = true;
  double least_clearance_ = 0.0;
  std::vector<EditRecord> log_;
};

}  // namespace tinsmith
