// Bands: the parts of a surface between one level and the next, as polygons.
//
// Band b lies above b levels: from level b - 1, which belongs to it, up to level b. Its boundary
// is made of the lines of both levels and of parts of the surface's own boundary, triangle by
// triangle; rings come of it by their points alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/parallel.hpp"
#include "level_surface.hpp"
#include "ring_nesting.hpp"
#include "ring_tracing.hpp"

namespace tinsmith::isolines {

// Rings of all polygons, of each polygon first the exterior.
struct Bands {
  std::vector<Point> points;                  // the first of each ring repeated
  std::vector<std::int64_t> ring_offsets{0};  // into points
  std::vector<std::int64_t> polygon_offsets{0};
  std::vector<std::int32_t> band;  // of each polygon
};

// The segments of the boundaries of bands, from the lowest band.
struct BandBoundaries {
  std::vector<BoundarySegment> segments;
  std::vector<std::int64_t> offsets{0};
};

// Polygons of the boundaries of bands, of which each may come in any order.
class PolygonMaker {
 public:
  // An exterior and its holes are a polygon.
  void add(std::vector<BoundarySegment> boundary, std::int32_t band) {
    std::vector<Ring> rings = RingTracer(std::move(boundary)).trace();
    const auto by_first = [](const Ring& a, const Ring& b) {
      return std::lexicographical_compare(a.points.begin(), a.points.end(), b.points.begin(),
                                          b.points.end(), lexicographically_before);
    };
    std::sort(rings.begin(), rings.end(), by_first);
    const RingNesting nesting(rings);
    std::vector<std::vector<std::size_t>> holes(rings.size());
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const std::int32_t around =
          rings[i].is_exterior ? RingNesting::kNone : nesting.exterior_of(rings[i]);
      if (around != RingNesting::kNone) holes[around].push_back(i);
    }
    for (std::size_t i = 0; i < rings.size(); ++i) {
      if (!rings[i].is_exterior) continue;
      add_ring(rings[i]);
      for (const std::size_t hole : holes[i]) add_ring(rings[hole]);
      found_.polygon_offsets.push_back(static_cast<std::int64_t>(found_.ring_offsets.size()) - 1);
      found_.band.push_back(band);
    }
  }

  Bands take() { return std::move(found_); }

 private:
  void add_ring(const Ring& ring) {
    found_.points.insert(found_.points.end(), ring.points.begin(), ring.points.end());
    found_.points.push_back(ring.points.front());
    found_.ring_offsets.push_back(static_cast<std::int64_t>(found_.points.size()));
  }

  Bands found_;
};

class BandFiller {
 public:
  // Of all triangles, or of those that are owned, by their flags. Throws overflow_error, with the
  // number of parts of triangles, if there are too many.
  BandFiller(const LevelSurface& surface, Team& team, const bool* is_owned = nullptr)
      : surface_(surface), team_(team), is_owned_(is_owned) {
    list_triangles();
  }

  Bands fill() {
    PolygonMaker maker;
    for (std::int32_t band = 0; band <= surface_.level_count(); ++band) {
      if (!team_.keeps_going(0)) break;
      maker.add(boundary_of(band), band);
    }
    return maker.take();
  }

  // The boundary of each band.
  BandBoundaries list_boundaries() const {
    BandBoundaries found;
    for (std::int32_t band = 0; band <= surface_.level_count(); ++band) {
      if (!team_.keeps_going(0)) break;
      const std::vector<BoundarySegment> some = boundary_of(band);
      found.segments.insert(found.segments.end(), some.begin(), some.end());
      found.offsets.push_back(static_cast<std::int64_t>(found.segments.size()));
    }
    return found;
  }

 private:
  // Triangles that have a part of each band and of another, or lie at the boundary.
  void list_triangles() {
    first_.assign(std::size_t(surface_.level_count()) + 2, 0);
    const auto each = [&](const auto& use) {
      for (const Triangle t : surface_.triangles()) {
        if (is_owned_ != nullptr && !is_owned_[number(t)]) continue;
        const auto [low, high] = surface_.ranks(t);
        if (low == high && !is_at_boundary(t)) continue;
        for (std::int32_t band = low; band <= high; ++band) use(t, band);
      }
    };
    each([&](Triangle, std::int32_t band) { ++first_[std::size_t(band) + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    if (first_.back() > kMostCrossings) throw std::overflow_error(std::to_string(first_.back()));
    listed_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    each([&](Triangle t, std::int32_t band) { listed_[next[band]++] = t; });
  }

  bool is_at_boundary(Triangle t) const {
    return surface_.neighbor(t, 0) == kNoTriangle || surface_.neighbor(t, 1) == kNoTriangle ||
           surface_.neighbor(t, 2) == kNoTriangle;
  }

  std::vector<BoundarySegment> boundary_of(std::int32_t band) const {
    std::vector<BoundarySegment> segments;
    for (std::size_t i = first_[band]; i < first_[std::size_t(band) + 1]; ++i) {
      const Triangle t = listed_[i];
      const auto [low, high] = surface_.ranks(t);
      if (band > low) add_line(segments, t, band - 1, true);
      if (band < high) add_line(segments, t, band, false);
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        if (surface_.neighbor(t, corner) == kNoTriangle) add_edge(segments, t, corner, band);
      }
    }
    return segments;
  }

  // The line of a level in a triangle, with what is above it on the left, or what is below.
  void add_line(std::vector<BoundarySegment>& segments, Triangle t, std::int32_t level,
                bool is_above) const {
    const std::uint32_t above = surface_.corners_above(t, level);
    const Point start = surface_.crossing(surface_.entry_of_line(t, above), level);
    const Point end = surface_.crossing(surface_.exit_of(t, above), level);
    if (start == end) return;
    segments.push_back(is_above ? BoundarySegment{start, end} : BoundarySegment{end, start});
  }

  // The part of a band of an edge of the boundary.
  void add_edge(std::vector<BoundarySegment>& segments, Triangle t, std::uint32_t corner,
                std::int32_t band) const {
    const Vertex from = surface_.corner(t, corner_after(corner));
    const Vertex to = surface_.corner(t, corner_before(corner));
    const bool is_rising = surface_.rank(from) <= surface_.rank(to);
    const Exit edge{corner, is_rising ? from : to, is_rising ? to : from};
    const std::int32_t lowest = surface_.rank(edge.low);
    const std::int32_t highest = surface_.rank(edge.high);
    if (band < lowest || band > highest) return;
    const Point low = band > lowest ? surface_.crossing(edge, band - 1) : surface_.point(edge.low);
    const Point high = band < highest ? surface_.crossing(edge, band) : surface_.point(edge.high);
    if (low == high) return;
    segments.push_back(is_rising ? BoundarySegment{low, high} : BoundarySegment{high, low});
  }

  const LevelSurface& surface_;
  Team& team_;
  const bool* is_owned_;            // null for all
  std::vector<std::size_t> first_;  // of each band
  std::vector<Triangle> listed_;
};

inline Bands fill_bands(const Surface& given, const Levels& levels, Team& team) {
  const LevelSurface surface(given, levels);
  return BandFiller(surface, team).fill();
}

}  // namespace tinsmith::isolines
