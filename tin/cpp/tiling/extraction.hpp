// Some triangles of a triangulation as arrays of their own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "plane_triangles.hpp"

namespace tinsmith {

// Some of the triangles, and the corner with which each is to start.
struct ChosenTriangles {
  const std::int32_t* triangles;  // different ones, ascending
  const std::uint8_t* firsts;
  std::uint32_t count;
};

// Vertices and triangles are numbered anew. The vertices keep their order. The triangles keep
// theirs, or are put in that of their first corners, and of their second ones where these are the
// same: no two triangles have the same directed edge, so it depends on no other triangle.
class Extraction {
 public:
  // Places are those of rows; without `rows` of the rows with their numbers.
  Extraction(const PlaneTriangles& all, const std::int32_t* rows, const bool* fixed,
             const ChosenTriangles& chosen)
      : all_(all),
        rows_(rows),
        fixed_(fixed),
        chosen_(chosen),
        vertex_(scratch_array<std::int32_t>(static_cast<std::size_t>(all.place_count))),
        number_(scratch_array<std::int32_t>(all.count)) {}

  void run(bool is_ordered) {
    number_vertices();
    std::fill_n(number_.get(), all_.count, kNoNeighbor);
    if (is_ordered) {
      number_by_corners();
    } else {
      for (std::uint32_t i = 0; i < chosen_.count; ++i) {
        number_[chosen_.triangles[i]] = static_cast<std::int32_t>(i);
      }
    }
    write();
  }

  const std::vector<std::int32_t>& vertices() const { return vertices_; }  // rows used, ascending
  // Three numbers a triangle; none of `fixed` if none were given.
  StreamedArray<std::int32_t> take_triangles() { return std::move(triangles_); }
  StreamedArray<std::int32_t> take_neighbors() { return std::move(neighbors_); }
  StreamedArray<bool> take_fixed() { return std::move(made_fixed_); }
  // The place among the chosen of each.
  StreamedArray<std::int32_t> take_order() { return std::move(order_); }

 private:
  static constexpr std::int32_t kNoNumber = -1;

  struct Entry {
    std::int32_t second;
    Triangle triangle;
  };

  Triangle triangle(std::uint32_t place) const {
    return triangle_numbered(chosen_.triangles[place]);
  }

  void number_vertices() {
    const auto places = static_cast<std::size_t>(all_.place_count);
    auto is_used = scratch_array<bool>(places);
    std::fill_n(is_used.get(), places, false);
    for (std::uint32_t i = 0; i < chosen_.count; ++i) {
      const Triangle t = triangle(i);
      for (std::uint32_t k = 0; k < 3; ++k) is_used[number(all_.vertex(t, k))] = true;
    }
    auto number_at = scratch_array<std::int32_t>(places);  // by row
    std::fill_n(number_at.get(), places, kNoNumber);
    for (std::int32_t p = 0; p < all_.place_count; ++p) {
      if (is_used[p]) number_at[row(p)] = 0;
    }
    vertices_.reserve(places);
    for (std::int32_t r = 0; r < all_.place_count; ++r) {
      if (number_at[r] == kNoNumber) continue;
      number_at[r] = static_cast<std::int32_t>(vertices_.size());
      vertices_.push_back(r);
    }
    for (std::int32_t p = 0; p < all_.place_count; ++p) vertex_[p] = number_at[row(p)];
  }
  std::int32_t row(std::int32_t place) const { return rows_ == nullptr ? place : rows_[place]; }

  // Counts by first corner, then sorts the few that start at the same one.
  void number_by_corners() {
    const std::size_t vertex_count = vertices_.size();
    auto begins = scratch_array<std::uint32_t>(vertex_count + 1);
    std::fill_n(begins.get(), vertex_count + 1, 0u);
    for (std::uint32_t i = 0; i < chosen_.count; ++i) ++begins[corner(i, chosen_.firsts[i]) + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) begins[v + 1] += begins[v];
    auto entries = scratch_array<Entry>(chosen_.count);
    for (std::uint32_t i = 0; i < chosen_.count; ++i) {
      const std::uint32_t first = chosen_.firsts[i];
      entries[begins[corner(i, first)]++] = {
          static_cast<std::int32_t>(corner(i, corner_after(first))), triangle(i)};
    }
    std::uint32_t begin = 0;
    for (std::size_t v = 0; v < vertex_count; ++v) {
      const std::uint32_t end = begins[v];
      std::sort(entries.get() + begin, entries.get() + end,
                [](const Entry& a, const Entry& b) { return a.second < b.second; });
      for (; begin < end; ++begin) {
        number_[number(entries[begin].triangle)] = static_cast<std::int32_t>(begin);
      }
    }
  }
  std::size_t corner(std::uint32_t i, std::uint32_t k) const {
    return static_cast<std::size_t>(vertex_[number(all_.vertex(triangle(i), k))]);
  }

  // In the order of the sweep: what is read lies side by side, and what is written need not.
  void write() {
    const std::size_t size = std::size_t{3} * chosen_.count;
    order_ = streamed_array<std::int32_t>(chosen_.count);
    triangles_ = streamed_array<std::int32_t>(size);
    neighbors_ = streamed_array<std::int32_t>(size);
    if (fixed_ != nullptr) made_fixed_ = streamed_array<bool>(size);
    for (std::uint32_t i = 0; i < chosen_.count; ++i) {
      const Triangle t = triangle(i), own = triangle_numbered(number_[chosen_.triangles[i]]);
      order_[number(own)] = static_cast<std::int32_t>(i);
      std::uint32_t from = chosen_.firsts[i];
      for (std::uint32_t k = 0; k < 3; ++k, from = corner_after(from)) {
        triangles_[entry_of(own, k)] = vertex_[number(all_.vertex(t, from))];
        const Triangle beyond = all_.neighbor(t, from);
        neighbors_[entry_of(own, k)] =
            all_.is_triangle(beyond) ? number_[number(beyond)] : kNoNeighbor;
        if (fixed_ != nullptr) made_fixed_[entry_of(own, k)] = fixed_[entry_of(t, from)];
      }
    }
  }

  PlaneTriangles all_;
  const std::int32_t* rows_;
  const bool* fixed_;
  ChosenTriangles chosen_;
  ScratchArray<std::int32_t> vertex_;  // the new number of each
  ScratchArray<std::int32_t> number_;  // of each triangle, kNoNeighbor for those not chosen
  std::vector<std::int32_t> vertices_;
  StreamedArray<std::int32_t> order_, triangles_, neighbors_;
  StreamedArray<bool> made_fixed_;
};

}  // namespace tinsmith
