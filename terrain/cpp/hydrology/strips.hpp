// Strips: triangles cut along the fall lines that come down to vertices.
//
// A triangle whose water leaves across two edges is parted by the fall line through the vertex
// between them. That line is followed upwards, triangle by triangle, to where nothing comes from
// above, or a vertex, which has such lines of its own (S. Yu, M. van Kreveld and J. Snoeyink,
// Drainage queries in TINs: from local to global and back again, 1996).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "falling_surface.hpp"

namespace tinsmith::hydrology {

// Fall lines whose shares of the base differ by no more are one.
constexpr double kSameShare = 1e-12;

// Between neighbouring cuts of each triangle, from the start of its base on; level ones have none.
struct Strips {
  const std::int64_t* offsets;  // of each triangle, and the end of the last
  const double* starts;         // shares of the base; the first of each triangle is 0

  std::int64_t begin(Triangle t) const { return offsets[number(t)]; }
  std::int64_t end(Triangle t) const { return offsets[std::size_t{number(t)} + 1]; }
  double end_of(std::int64_t strip, Triangle t) const {
    return strip + 1 < end(t) ? starts[strip + 1] : 1.0;
  }
  // The last of a triangle that begins at a share or before.
  std::int64_t find(Triangle t, double share) const {
    const double* const first = starts + begin(t);
    return std::upper_bound(first + 1, starts + end(t), share) - starts - 1;
  }
};

class StripCutter {
 public:
  StripCutter(const FallingSurface& falls, const Base* bases, Pulse& pulse)
      : falls_(falls), bases_(bases), pulse_(pulse) {}

  // Throws overflow_error if fall lines cross more than `most` triangles. Writes an offset for each
  // triangle and the end. Ask the team whether it was stopped.
  void cut(std::int64_t most, std::int64_t* offsets) {
    count(most, offsets);
    starts_ = streamed_array<double>(static_cast<std::size_t>(offsets[triangle_count()]));
    if (!place(offsets)) return;
    size_ = join_same(offsets);
  }

  std::int64_t size() const { return size_; }
  StreamedArray<double> take_starts() { return std::move(starts_); }

 private:
  std::uint32_t triangle_count() const { return falls_.surface.triangle_count; }
  const Base& base(Triangle t) const { return bases_[number(t)]; }

  static bool is_inside(double share) { return share > kSameShare && share < 1.0 - kSameShare; }

  // Follow the fall line that parts a triangle upwards; record(triangle, share of its base).
  template <typename Record>
  void trace(Triangle t, Record&& record) const {
    Place at{half_edge(t, base(t).corner), base(t).split};
    record(t, at.share);
    while (true) {
      const HalfEdge above = falls_.across(at.edge);
      if (above == kNoHalfEdge || falls_.sign(above) <= 0) return;
      const Base& own = base(triangle_of(above));
      const Place entry{above, 1.0 - at.share};
      at = own.follow(entry);
      const double share = own.is_at(above) ? entry.share : at.share;
      if (!record(triangle_of(above), share)) return;
      if (!(std::fabs(share - own.split) > kSameShare) || !is_inside(share)) return;
    }
  }

  template <typename Record>
  bool trace_all(Record&& record) const {
    for (const Triangle t : Ids<Triangle>(triangle_count())) {
      if (!pulse_.goes_on()) return false;
      if (!base(t).drains && !falls_.is_level(t)) trace(t, record);
    }
    return true;
  }

  void count(std::int64_t most, std::int64_t* offsets) const {
    std::fill_n(offsets, std::size_t{triangle_count()} + 1, std::int64_t{0});
    std::int64_t cuts = 0;
    trace_all([&](Triangle t, double share) {
      if (++cuts > most) throw std::overflow_error("too many cuts");
      offsets[std::size_t{number(t)} + 1] += is_inside(share);
      return pulse_.goes_on();
    });
    for (const Triangle t : Ids<Triangle>(triangle_count())) {
      const std::int64_t own = offsets[std::size_t{number(t)} + 1] + !falls_.is_level(t);
      offsets[std::size_t{number(t)} + 1] = offsets[number(t)] + own;
    }
  }

  // Write the shares of each triangle, its own first 0 before them, in any order. The offsets are
  // moved to the next place to write, and back.
  bool place(std::int64_t* offsets) {
    for (const Triangle t : Ids<Triangle>(triangle_count())) {
      if (!falls_.is_level(t)) starts_[offsets[number(t)]++] = 0.0;
    }
    const bool is_whole = trace_all([&](Triangle t, double share) {
      if (is_inside(share)) starts_[offsets[number(t)]++] = share;
      return pulse_.goes_on();
    });
    for (std::size_t t = triangle_count(); t > 0; --t) offsets[t] = offsets[t - 1];
    offsets[0] = 0;
    return is_whole;
  }

  // Sort the shares of each triangle, and leave out those that another one is the same as.
  std::int64_t join_same(std::int64_t* offsets) {
    std::int64_t kept = 0, begin = 0;
    for (const Triangle t : Ids<Triangle>(triangle_count())) {
      const std::int64_t end = offsets[std::size_t{number(t)} + 1];
      std::sort(starts_.get() + begin, starts_.get() + end);
      offsets[number(t)] = kept;
      double before = -1.0;
      for (std::int64_t i = begin; i < end; ++i) {
        const double share = starts_[i];
        if (share - before > kSameShare) starts_[kept++] = share;
        before = share;
      }
      begin = end;
    }
    offsets[triangle_count()] = kept;
    return kept;
  }

  const FallingSurface& falls_;
  const Base* bases_;
  Pulse& pulse_;
  StreamedArray<double> starts_;
  std::int64_t size_ = 0;
};

// The areas of strips in the plane.
inline void measure_strips(const Strips& strips, const Base* bases, const double* areas,
                           std::uint32_t triangle_count, double* sizes) {
  for (const Triangle t : Ids<Triangle>(triangle_count)) {
    const Base& base = bases[number(t)];
    for (std::int64_t i = strips.begin(t); i < strips.end(t); ++i) {
      const double part =
          base.part_before(strips.end_of(i, t)) - base.part_before(strips.starts[i]);
      sizes[i] = part * areas[number(t)];
    }
  }
}

}  // namespace tinsmith::hydrology
