// Which parts of a band are connected: the pieces that triangles have of each band, joined over
// the edges where neighbours share more than a point of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "level_surface.hpp"

namespace tinsmith::isolines {

// Disjoint sets of pieces: a forest with union to the smaller number and path halving (Tarjan and
// van Leeuwen 1984).
class BandPieces {
 public:
  explicit BandPieces(const LevelSurface& surface) : surface_(surface) {
    const std::int32_t count = surface.arrays().triangle_count;
    first_.resize(std::size_t(count));
    std::size_t total = 0;
    for (const Triangle t : Ids<Triangle>(count)) {
      const auto [low, high] = surface.ranks(t);
      first_[number(t)] = static_cast<std::int64_t>(total) - low;
      total += std::size_t(high - low) + 1;
    }
    if (total > INT32_MAX) throw std::length_error("too many crossings");
    parent_.resize(total);
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const Triangle t : Ids<Triangle>(count)) {
      for (std::uint32_t corner = 0; corner < 3; ++corner) join_over(t, corner);
    }
  }

  // The piece that stands for all that are connected to that of a triangle in a band.
  std::int32_t part_of(Triangle t, std::int32_t band) const {
    std::int32_t piece = piece_of(t, band);
    while (parent_[piece] != piece) piece = parent_[piece];
    return piece;
  }

 private:
  std::int32_t piece_of(Triangle t, std::int32_t band) const {
    return static_cast<std::int32_t>(first_[number(t)] + band);
  }

  void join_over(Triangle t, std::uint32_t corner) {
    const Triangle across = surface_.neighbor(t, corner);
    if (across == kNoTriangle || number(across) < number(t)) return;
    Vertex low = surface_.corner(t, corner_after(corner));
    Vertex high = surface_.corner(t, corner_before(corner));
    if (surface_.rank(high) < surface_.rank(low)) std::swap(low, high);
    const std::int32_t last = surface_.rank(high);
    for (std::int32_t band = surface_.rank(low); band <= last; ++band) {
      // Of the highest band the edge may have its end alone.
      const bool is_point =
          band == last && surface_.rank(low) < last && surface_.is_at(high, band - 1);
      if (!is_point) join(piece_of(t, band), piece_of(across, band));
    }
    if (surface_.rank(low) == last) join_over_ridge(t, corner, last - 1);
  }

  // An edge at a level from which both triangles fall separates nothing.
  void join_over_ridge(Triangle t, std::uint32_t corner, std::int32_t level) {
    if (level < 0 || surface_.is_above(surface_.corner(t, corner), level)) return;
    const Triangle across = surface_.neighbor(t, corner);
    if (surface_.beyond_ridge(t, surface_.corners_above(t, level), level) == across) {
      join(piece_of(t, level), piece_of(across, level));
    }
  }

  std::int32_t find(std::int32_t piece) {
    while (parent_[piece] != piece) {
      parent_[piece] = parent_[parent_[piece]];
      piece = parent_[piece];
    }
    return piece;
  }

  void join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

  const LevelSurface& surface_;
  std::vector<std::int64_t> first_;  // less the lowest rank
  ScratchVector<std::int32_t> parent_;
};

}  // namespace tinsmith::isolines
