// Gradients at the vertices of a surface: those that bend its edges least.
//
// G. M. Nielson, "A method for interpolating scattered data based upon a minimum norm network"
// (1983): every edge becomes a cubic with the gradients' slopes at its ends, and the sum over all
// edges of the integral of the squared second derivative is least.
//
// Edges that are barriers part a vertex into sectors, each with a gradient of its own. A barrier
// stays straight; it draws the gradients beside it towards its slope, but joins no two of them.
//
// The equations A g = b have 2 by 2 blocks D on their diagonal, of each sector its own edges. An
// edge adds (4 2; 2 4) to A and (4 0; 0 4) to D, a barrier to both the same: so all eigenvalues of
// D^-1 A lie in [1/2, 3/2], and Chebyshev's iteration gains a factor of 2 + sqrt(3) a sweep on any
// surface, whatever its numbering (Golub and Varga, "Chebyshev semi-iterative methods, successive
// overrelaxation iterative methods, and second order Richardson iterative methods", 1961).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/parallel.hpp"
#include "barriers.hpp"

namespace tinsmith {

struct Gradient {
  double x = 0.0;
  double y = 0.0;

  double along(Gradient step) const { return x * step.x + y * step.y; }
};

class VertexGradients {
 public:
  // Check `team.is_stopped()` afterwards.
  VertexGradients(const Surface& surface, const bool* barriers, Team& team)
      : surface_(surface), barriers_(barriers) {
    find_sectors();
    join_sectors();
    solve(team);
    free_memory(steps_);
    free_memory(begin_);
    free_memory(blocks_);
  }

  const Gradient& at(Triangle t, std::uint32_t corner) const {
    return gradients_[sector_[entry_of(t, corner)]];
  }

 private:
  // (2 + sqrt(3))^-22 is 3e-13, of how far the best planes are from the solution.
  static constexpr int kSweeps = 22;
  static constexpr double kSpectralRadius = 0.5;
  static constexpr double kFlat = 1e-13;  // relative determinant of edges that span no plane
  static constexpr std::uint32_t kNoSector = UINT32_MAX;

  // An edge as seen from a sector: the step along it and the rise, over its length to the power
  // of 1.5.
  struct Step {
    Gradient way;
    std::uint32_t sector;  // at the other end; kNoSector along a barrier
  };
  // The symmetric block of a sector, its right side, and that of the plane that fits its edges
  // best: the first guess, which is right for a plane.
  struct Block {
    double xx = 0.0, xy = 0.0, yy = 0.0;
    Gradient pull, fit;
  };

  // Corners are joined to sectors by turning about their vertex, across edges that are no barriers.
  void find_sectors() {
    sector_.assign(std::size_t{3} * surface_.triangle_count, kNoSector);
    for (const Triangle t : Ids<Triangle>(surface_.triangle_count)) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (sector_[entry_of(t, k)] != kNoSector) continue;
        turn_about(half_edge(t, k), Surface::Turn::kCounterClockwise);
        turn_about(half_edge(t, k), Surface::Turn::kClockwise);
        ++sector_count_;
      }
    }
  }

  void turn_about(HalfEdge opposite, Surface::Turn turn) {
    for (;;) {
      sector_[entry_of(opposite)] = sector_count_;
      const std::uint32_t k = corner_of(opposite);
      const std::uint32_t side =
          turn == Surface::Turn::kClockwise ? corner_before(k) : corner_after(k);
      if (!is_open(surface_, barriers_, triangle_of(opposite), side)) return;
      opposite = surface_.next_about(opposite, turn);
      if (sector_[entry_of(opposite)] != kNoSector) return;
    }
  }

  // visit(t, k) of each edge once for each of the triangles that have a sector at its ends: an
  // open edge has the same sectors on both sides.
  template <typename Visit>
  void for_each_edge(Visit&& visit) const {
    for (const Triangle t : Ids<Triangle>(surface_.triangle_count)) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const bool is_open_edge = is_open(surface_, barriers_, t, k);
        if (!is_open_edge || t < surface_.neighbor(t, k)) visit(t, k);
      }
    }
  }

  void join_sectors() {
    begin_.assign(std::size_t{sector_count_} + 1, 0);
    for_each_edge([&](Triangle t, std::uint32_t k) {
      ++begin_[sector_[entry_of(t, corner_after(k))] + 1];
      ++begin_[sector_[entry_of(t, corner_before(k))] + 1];
    });
    for (std::uint32_t s = 0; s < sector_count_; ++s) begin_[s + 1] += begin_[s];
    steps_.resize(begin_[sector_count_]);
    blocks_.assign(sector_count_, {});
    std::vector<std::uint64_t> end(begin_.begin(), begin_.end() - 1);
    for_each_edge([&](Triangle t, std::uint32_t k) {
      add_step(t, corner_after(k), corner_before(k), k, end);
      add_step(t, corner_before(k), corner_after(k), k, end);
    });
  }

  void add_step(Triangle t, std::uint32_t from, std::uint32_t to, std::uint32_t edge,
                std::vector<std::uint64_t>& end) {
    const std::uint32_t sector = sector_[entry_of(t, from)];
    const bool is_barrier = barriers_[entry_of(t, edge)];
    const Point a = surface_.corner(t, from), b = surface_.corner(t, to);
    const double x = b.x - a.x, y = b.y - a.y;
    const double length = std::hypot(x, y);
    const double scale = 1.0 / (length * std::sqrt(length));
    const Gradient way{x * scale, y * scale};
    const double rise = (surface_.elevation(t, to) - surface_.elevation(t, from)) * scale;
    // A barrier's other end is free: a cubic with any slope there bends three quarters as much.
    const double weight = is_barrier ? 0.75 : 1.0;
    Block& block = blocks_[sector];
    block.xx += weight * way.x * way.x;
    block.xy += weight * way.x * way.y;
    block.yy += weight * way.y * way.y;
    const double pull = (is_barrier ? 0.75 : 1.5) * rise;
    block.pull.x += pull * way.x;
    block.pull.y += pull * way.y;
    block.fit.x += weight * rise * way.x;
    block.fit.y += weight * rise * way.y;
    steps_[end[sector]++] = {way, is_barrier ? kNoSector : sector_[entry_of(t, to)]};
  }

  // Sectors in equal shares; each sweep reads the one before only.
  void solve(Team& team) {
    gradients_.resize(sector_count_);
    for (std::uint32_t s = 0; s < sector_count_; ++s) {
      gradients_[s] = solve_block(blocks_[s], blocks_[s].fit);
    }
    std::vector<Gradient> before = gradients_, next(sector_count_);
    double omega = 1.0;
    for (int sweep = 0; sweep < kSweeps && !team.is_stopped(); ++sweep) {
      team.run([&](int part) {
        if (!team.keeps_going(part)) return;
        const std::uint64_t count = sector_count_;
        const auto first = static_cast<std::uint32_t>(count * part / team.size());
        const auto last = static_cast<std::uint32_t>(count * (part + 1) / team.size());
        for (std::uint32_t s = first; s < last; ++s) {
          const Gradient solved = relax(s);
          next[s] = {before[s].x + omega * (solved.x - before[s].x),
                     before[s].y + omega * (solved.y - before[s].y)};
        }
      });
      before.swap(gradients_);
      gradients_.swap(next);
      constexpr double kSquare = kSpectralRadius * kSpectralRadius;
      omega = sweep == 0 ? 2.0 / (2.0 - kSquare) : 1.0 / (1.0 - 0.25 * kSquare * omega);
    }
  }

  // The gradient of least energy while those at the other ends stay.
  Gradient relax(std::uint32_t sector) const {
    Gradient pull = blocks_[sector].pull;
    for (std::uint64_t i = begin_[sector]; i < begin_[sector + 1]; ++i) {
      const Step& step = steps_[i];
      if (step.sector == kNoSector) continue;
      const double share = 0.5 * gradients_[step.sector].along(step.way);
      pull.x -= share * step.way.x;
      pull.y -= share * step.way.y;
    }
    return solve_block(blocks_[sector], pull);
  }

  static Gradient solve_block(const Block& block, Gradient pull) {
    const double trace = block.xx + block.yy;
    const double determinant = block.xx * block.yy - block.xy * block.xy;
    if (determinant > kFlat * trace * trace) {
      return {(block.yy * pull.x - block.xy * pull.y) / determinant,
              (block.xx * pull.y - block.xy * pull.x) / determinant};
    }
    // All edges run one way: the slope along it, none across.
    return {pull.x / trace, pull.y / trace};
  }

  Surface surface_;
  const bool* barriers_;
  std::vector<std::uint32_t> sector_;  // of each corner
  std::uint32_t sector_count_ = 0;
  std::vector<std::uint64_t> begin_;
  std::vector<Step> steps_;
  std::vector<Block> blocks_;
  std::vector<Gradient> gradients_;
};

}  // namespace tinsmith
