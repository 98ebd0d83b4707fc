// Where lines leave the triangles that they cross, and where each goes on.
//
// All crossings are computed triangle by triangle, as they lie in memory; who then follows a line
// from exit to exit reads one row for each.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/pulse.hpp"
#include "level_surface.hpp"

namespace tinsmith::isolines {

// The exits of a triangle are numbered by level, those of all by triangle.
enum class ExitId : std::uint32_t {};
constexpr std::uint32_t number(ExitId e) { return static_cast<std::uint32_t>(e); }

constexpr ExitId kNoExit{UINT32_MAX};  // beyond the boundary
constexpr ExitId kLeft{UINT32_MAX - 1};

// Where a line comes in at the boundary, and its first exit.
struct Start {
  Point point;
  ExitId first;
};

class LineExits {
 public:
  // Of all triangles, or of those that are owned, by their flags. Throws overflow_error, with the
  // number of exits, if there are too many for memory that is yet to be allocated.
  LineExits(const LevelSurface& surface, Pulse& pulse, const bool* is_owned = nullptr)
      : surface_(surface), is_owned_(is_owned) {
    const std::uint64_t total = number_exits();
    if (total > kMostCrossings) throw std::overflow_error(std::to_string(total));
    rows_.resize(std::size_t(total));
    for (const Triangle t : surface_.triangles()) {
      if (!pulse.goes_on()) return;
      surface_.prefetch_ranks(ahead(t, kRanksAhead));
      surface_.prefetch_vertices(ahead(t, kVerticesAhead));
      if (is_filled(t)) fill_rows(t);
    }
    for (const auto& [one, other] : ridges_) swap_ways(one, other);
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(rows_.size()); }
  const std::vector<Start>& starts() const { return starts_; }

  // Those of an owned triangle and of a level: visit(exit, level).
  template <typename Visit>
  void for_each_of(Triangle t, Visit&& visit) const {
    const auto [low, high] = surface_.ranks(t);
    for (std::int32_t level = low; level < high; ++level) visit(exit_at(t, level), level);
  }

  ExitId next(ExitId e) const { return rows_[number(e)].next; }
  Point point(ExitId e) const { return rows_[number(e)].point; }
  std::int32_t level(ExitId e) const { return rows_[number(e)].level; }
  bool is_left(ExitId e) const { return rows_[number(e)].next == kLeft; }

  // The next exit of the line, kNoExit beyond the boundary; it can be asked for once.
  ExitId leave(ExitId e) { return std::exchange(rows_[number(e)].next, kLeft); }

 private:
  struct Row {
    Point point;
    ExitId next;
    std::int32_t level;
  };

  // So many triangles take as long as memory does to answer.
  static constexpr std::uint32_t kRanksAhead = 64;
  static constexpr std::uint32_t kVerticesAhead = 32;

  bool owns(Triangle t) const { return is_owned_ == nullptr || is_owned_[number(t)]; }

  // Ways are swapped with a triangle beyond an edge.
  bool is_filled(Triangle t) const {
    if (owns(t)) return true;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Triangle beyond = surface_.neighbor(t, k);
      if (beyond != kNoTriangle && owns(beyond)) return true;
    }
    return false;
  }

  static Triangle ahead(Triangle t, std::uint32_t by) { return Triangle{number(t) + by}; }

  std::uint64_t number_exits() {
    base_.resize(surface_.triangle_count());
    std::uint64_t total = 0;
    for (const Triangle t : surface_.triangles()) {
      surface_.prefetch_ranks(ahead(t, kRanksAhead));
      const auto [low, high] = surface_.ranks(t);
      base_[number(t)] = static_cast<std::uint32_t>(total) - static_cast<std::uint32_t>(low);
      total += static_cast<std::uint64_t>(high - low);
    }
    return total;
  }

  ExitId exit_at(Triangle t, std::int32_t level) const {
    const std::uint32_t e = base_[number(t)] + static_cast<std::uint32_t>(level);
    if (e >= size()) {
      throw std::invalid_argument("the neighbours are not those of the triangles");
    }
    return ExitId{e};
  }

  void fill_rows(Triangle t) {
    const auto [low, high] = surface_.ranks(t);
    for (std::int32_t level = low; level < high; ++level) fill_row(t, level);
    if (low < high && owns(t)) list_starts(t);
  }

  void fill_row(Triangle t, std::int32_t level) {
    const std::uint32_t above = surface_.corners_above(t, level);
    const Exit exit = surface_.exit_of(t, above);
    const Triangle next = surface_.neighbor(t, exit.corner);
    const ExitId e = exit_at(t, level);
    rows_[number(e)] = {surface_.crossing(exit, level),
                        next == kNoTriangle ? kNoExit : exit_at(next, level), level};
    if (!surface_.is_at(exit.high, level)) return;
    const Triangle beyond = surface_.beyond_ridge(t, above, level);
    if (beyond != kNoTriangle && number(t) < number(beyond) && is_filled(beyond)) {
      ridges_.emplace_back(e, exit_at(beyond, level));
    }
  }

  // Lines come in where the boundary falls, with the surface on its left.
  void list_starts(Triangle t) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      if (surface_.neighbor(t, corner) != kNoTriangle) continue;
      const Vertex start = surface_.corner(t, corner_after(corner));
      const Vertex end = surface_.corner(t, corner_before(corner));
      for (std::int32_t level = surface_.rank(end); level < surface_.rank(start); ++level) {
        starts_.push_back({surface_.crossing({corner, end, start}, level), exit_at(t, level)});
      }
    }
  }

  // A line that comes to a ridge goes on beyond it, without running along it forth and back.
  void swap_ways(ExitId one, ExitId other) { std::swap(rows_[number(one)], rows_[number(other)]); }

  const LevelSurface& surface_;
  const bool* is_owned_;               // null for all
  ScratchVector<std::uint32_t> base_;  // of each triangle, its first exit less its lowest level
  ScratchVector<Row> rows_;
  std::vector<Start> starts_;
  std::vector<std::pair<ExitId, ExitId>> ridges_;
};

}  // namespace tinsmith::isolines
