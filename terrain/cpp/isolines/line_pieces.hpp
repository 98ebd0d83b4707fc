// Contour lines of a part of a surface: the pieces that run through the triangles of a tile, with
// the names of the triangles where they go on, so that the tile next to it can join them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "line_arrays.hpp"
#include "line_exits.hpp"
#include "line_tracing.hpp"

namespace tinsmith::isolines {

// The numbers of a triangle's corners in the whole surface, in the order in which they are given.
using TriangleName = std::array<std::int64_t, 3>;
constexpr TriangleName kBoundary{-1, -1, -1};
constexpr TriangleName kClosed{-2, -2, -2};

struct LinePieces {
  std::vector<Point> points;
  std::vector<std::int64_t> offsets{0};
  std::vector<std::int32_t> level;
  std::vector<TriangleName> first;  // the triangle that the piece begins in, or kBoundary, kClosed
  std::vector<TriangleName> next;   // that it would go on in
};

class PieceTracer {
 public:
  // `names` holds the whole surface's number of each vertex. All triangles within two steps from
  // vertex to triangle of an owned one must be there.
  PieceTracer(const LevelSurface& surface, const Surface& given, const bool* is_owned,
              const std::int64_t* names, Team& team)
      : surface_(surface),
        given_(given),
        is_owned_(is_owned),
        names_(names),
        pulse_(team),
        exits_(surface, pulse_, is_owned) {}

  LinePieces trace() {
    list_owned();
    for (const Start& start : exits_.starts()) {
      found_.points.push_back(start.point);
      follow(start.first, kBoundary);
    }
    for (std::uint32_t e = 0; e < exits_.size() && pulse_.goes_on(); ++e) {
      if (is_left(ExitId{e}) || has_previous_[e]) continue;
      follow(ExitId{e}, name_of(ExitId{e}));
    }
    for (std::uint32_t e = 0; e < exits_.size() && pulse_.goes_on(); ++e) {
      if (!is_left(ExitId{e})) follow(ExitId{e}, kClosed);
    }
    return std::move(found_);
  }

 private:
  static constexpr std::uint32_t kUnknown = UINT32_MAX;

  void list_owned() {
    triangle_.assign(exits_.size(), kUnknown);
    has_previous_.assign(exits_.size(), 0);
    is_owned_exit_.assign(exits_.size(), 0);
    for (const Triangle t : surface_.triangles()) {
      exits_.for_each_of(t, [&](ExitId e, std::int32_t) {
        triangle_[number(e)] = number(t);
        is_owned_exit_[number(e)] = is_owned_[number(t)];
      });
    }
    for (std::uint32_t e = 0; e < exits_.size(); ++e) {
      if (!is_owned_exit_[e]) continue;
      const ExitId next = exits_.next(ExitId{e});
      if (next != kNoExit) has_previous_[number(next)] = 1;
    }
    for (const Start& start : exits_.starts()) has_previous_[number(start.first)] = 1;
  }

  // Not to be followed from here, or followed before.
  bool is_left(ExitId e) const { return !is_owned_exit_[number(e)] || exits_.is_left(e); }

  TriangleName name_of(ExitId e) const {
    const Triangle t{triangle_[number(e)]};
    TriangleName name;
    for (std::uint32_t k = 0; k < 3; ++k) name[k] = names_[number(given_.vertex(t, k))];
    return name;
  }

  void follow(ExitId e, const TriangleName& first) {
    const std::int32_t level = exits_.level(e);
    while (e != kNoExit && !is_left(e) && pulse_.goes_on()) {
      found_.points.push_back(exits_.point(e));
      e = exits_.leave(e);
    }
    found_.offsets.push_back(static_cast<std::int64_t>(found_.points.size()));
    found_.level.push_back(level);
    found_.first.push_back(first);
    found_.next.push_back(first == kClosed ? kClosed : e == kNoExit ? kBoundary : name_of(e));
  }

  const LevelSurface& surface_;
  const Surface& given_;
  const bool* is_owned_;
  const std::int64_t* names_;
  Pulse pulse_;
  LineExits exits_;
  std::vector<std::uint32_t> triangle_;  // of each exit
  std::vector<char> has_previous_, is_owned_exit_;
  LinePieces found_;
};

inline LinePieces trace_pieces(const Surface& given, const Levels& levels, const bool* is_owned,
                               const std::int64_t* names, Team& team) {
  const LevelSurface surface(given, levels);
  return PieceTracer(surface, given, is_owned, names, team).trace();
}

// Lines as they are drawn, of all points that they run through: each point once, closed ones from
// their first point, in order.
inline TracedLines settle_lines(const GivenLines& given, const Levels& levels) {
  TracedLines found;
  auto& points = found.points;
  for (std::size_t k = 0; k < given.count; ++k) {
    const std::int32_t level = given.levels[k];
    if (level < 0 || level >= levels.count) {
      throw std::invalid_argument("every line needs a level");
    }
    const std::size_t begin = points.size();
    for (std::int64_t i = given.offsets[k]; i < given.offsets[k + 1]; ++i) {
      const Point point{given.xyz[3 * i], given.xyz[3 * i + 1]};
      if (points.size() == begin || !(points.back() == point)) points.push_back(point);
    }
    settle_line(found, begin, level, given.are_closed[k]);
  }
  sort_lines(found);
  return found;
}

}  // namespace tinsmith::isolines
