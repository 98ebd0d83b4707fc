// The overlay of two surfaces as a mesh: cells that share their vertices.
//
// A vertex is one of the first surface, one of the second, or the place where an edge of one
// crosses an edge of the other, rounded once. It is known by these numbers, never by its
// coordinates, so that cells side by side share it whatever rounding does.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/constraints/intersection_point.hpp"
#include "cell.hpp"
#include "facet.hpp"
#include "pairs.hpp"

namespace tinsmith::earthwork {

// An edge of the first surface and one of the second, each by its smaller and larger vertex.
using EdgePair = std::array<Vertex, 4>;

// The vertex of the overlay at each pair of edges, by open addressing.
class EdgePairs {
 public:
  EdgePairs() : slots_(kFirstSize) {}

  // The vertex of the pair, `made` if it has none yet.
  Vertex find_or_add(const EdgePair& pair, Vertex made) {
    if (2 * ++count_ > slots_.size()) grow();
    Slot& slot = slot_of(pair);
    if (slot.vertex == kNoVertex) {
      slot = {pair, made};
    } else {
      --count_;
    }
    return slot.vertex;
  }

 private:
  static constexpr std::size_t kFirstSize = 1024;  // a power of two, as all sizes

  struct Slot {
    EdgePair pair;
    Vertex vertex = kNoVertex;
  };

  Slot& slot_of(const EdgePair& pair) {
    std::uint64_t hash = 0;
    for (const Vertex v : pair) {
      hash = (hash ^ static_cast<std::uint32_t>(number(v))) * 0x9e3779b97f4a7c15;  // 2^64 / golden
      hash ^= hash >> 29;
    }
    std::size_t at = hash & (slots_.size() - 1);
    while (slots_[at].vertex != kNoVertex && slots_[at].pair != pair) {
      at = (at + 1) & (slots_.size() - 1);
    }
    return slots_[at];
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.vertex != kNoVertex) slot_of(slot.pair) = slot;
    }
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
};

class Overlay {
 public:
  struct OverlayVertex {
    double x, y;
    double difference;  // of the second surface above the first
  };

  Overlay(const Surface& first, const Surface& second, bool is_second_apart, Team& team)
      : vertex_of_{std::vector<Vertex>(first.point_count, kNoVertex),
                   std::vector<Vertex>(second.point_count, kNoVertex)} {
    const Pairs pairs(first, second, is_second_apart);
    pairs.visit(team, [&](int, const Facet& one, const Facet& other) {
      const bool is_kept = is_measured_along(one, other);
      Cell cell;
      if (!(is_kept ? cell.cut(one, other) : cell.cut(other, one))) return;
      for (int i = 0; i < cell.size(); ++i) add_corner(one, other, is_kept, cell, i);
      offsets.push_back(static_cast<std::int64_t>(corners.size()));
      triangles.push_back({one.triangle, other.triangle});
    });
  }

  std::vector<OverlayVertex> vertices;
  std::vector<std::array<Vertex, 2>> origins;      // of the first, of the second, or kNoVertex
  std::vector<std::int64_t> offsets{0};            // of cells, in corners
  std::vector<Vertex> corners;                     // of cells, counter-clockwise
  std::vector<std::array<Triangle, 2>> triangles;  // of the first and the second, of each cell

 private:
  void add_corner(const Facet& one, const Facet& other, bool is_kept, const Cell& cell, int i) {
    const int number = cell.number(i);
    const double difference = is_kept ? cell.difference(i) : -cell.difference(i);
    if (number >= Cell::kCrossings) {
      const auto [edge, across] = Cell::crossing_of(number);
      add_crossing(one, is_kept ? edge : across, other, is_kept ? across : edge, difference);
      return;
    }
    const bool is_of_first = (number < 3) == is_kept;
    const int corner = number % 3;
    const int shared = shared_corner(is_of_first ? other : one, is_of_first ? one : other, corner);
    if (is_of_first) {
      add_vertex(one, corner, shared < 0 ? kNoVertex : other.vertex[shared], difference);
    } else if (shared >= 0) {
      add_vertex(one, shared, other.vertex[corner], difference);
    } else {
      add_second_vertex(other, corner, difference);
    }
  }

  // The corner of a triangle at the same place as a corner of another one, -1 if there is none.
  static int shared_corner(const Facet& triangle, const Facet& other, int corner) {
    for (int k = 0; k < 3; ++k) {
      if (triangle.corner[k] == other.corner[corner]) return k;
    }
    return -1;
  }

  void add_vertex(const Facet& one, int corner, Vertex second, double difference) {
    const Vertex first = one.vertex[corner];
    Vertex& vertex = vertex_of_[0][number(first)];
    if (vertex == kNoVertex) vertex = new_vertex(one.corner[corner], difference, {first, second});
    corners.push_back(vertex);
  }

  void add_second_vertex(const Facet& other, int corner, double difference) {
    const Vertex second = other.vertex[corner];
    Vertex& vertex = vertex_of_[1][number(second)];
    if (vertex == kNoVertex) {
      vertex = new_vertex(other.corner[corner], difference, {kNoVertex, second});
    }
    corners.push_back(vertex);
  }

  void add_crossing(const Facet& one, std::uint32_t edge, const Facet& other, std::uint32_t across,
                    double difference) {
    const auto ends = std::minmax(one.vertex[corner_after(edge)], one.vertex[corner_before(edge)]);
    const auto other_ends =
        std::minmax(other.vertex[corner_after(across)], other.vertex[corner_before(across)]);
    const Vertex next{static_cast<std::int32_t>(vertices.size())};
    const Vertex vertex = crossings_.find_or_add(
        {ends.first, ends.second, other_ends.first, other_ends.second}, next);
    if (vertex == next) {
      new_vertex(intersection_point(one.start(edge), one.end(edge), other.start(across),
                                    other.end(across)),
                 difference, {kNoVertex, kNoVertex});
    }
    corners.push_back(vertex);
  }

  Vertex new_vertex(Point p, double difference, std::array<Vertex, 2> origin) {
    if (vertices.size() >= static_cast<std::size_t>(INT32_MAX / 4)) {
      throw std::overflow_error("the overlay has more vertices than 32-bit indices can number");
    }
    vertices.push_back({p.x, p.y, difference});
    origins.push_back(origin);
    return Vertex{static_cast<std::int32_t>(vertices.size() - 1)};
  }

  std::array<std::vector<Vertex>, 2> vertex_of_;
  EdgePairs crossings_;
};

}  // namespace tinsmith::earthwork
