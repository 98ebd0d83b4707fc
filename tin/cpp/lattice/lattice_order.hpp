// The triangles of a lattice, numbered and written in canonical order.
//
//      . --- . --- .        Stripe by stripe, west to east: the two triangles of a cell lie beside
//      | \ 3 | \ 6 |        each other. Around a vertex with eight others it is known which of the
//      |  \  |  \  |        six triangles are its own, and in which order. Around any other one
//      | 2 \ | 5 \ |        they are gathered and sorted (star_order.hpp).
//      v --- w --- .
//      | \ 1 | \ 4 |        Threads have stripes: how many triangles belong to one is known before
//      |  \  |  \  |        any is numbered.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../growth/triangle_store.hpp"
#include "../insertion/star_order.hpp"
#include "../predicates/predicates.hpp"
#include "hole_filling.hpp"
#include "lattice_cells.hpp"
#include "star_table.hpp"

namespace tinsmith {

class LatticeOrder {
 public:
  LatticeOrder(const LatticeCells& cells, const HoleFilling& holes, Team& team)
      : cells_(cells),
        lattice_(cells.lattice()),
        holes_(holes),
        team_(team),
        number_of_(scratch_array<std::int32_t>(std::size_t{2} * cells.lattice().places())),
        number_of_filling_(holes.triangles().size()) {
    list_owners();
  }

  // Number all triangles, and tell the place of each vertex, in the order of the sweep:
  // tell(position, place). False if the team is stopped.
  template <typename Tell>
  bool number_all(Tell&& tell) {
    return on_stripes([&](int stripe, Gathered& gathered) {
      std::int32_t next = first_triangle_[stripe], position = first_position_[stripe];
      std::size_t filling = first_filling_[stripe];
      const Range rows = lattice_.stripes()[stripe];
      for (std::int32_t column = 1; column + 1 < lattice_.columns(); ++column) {
        for (std::int32_t row = rows.begin; row < rows.end; ++row) {
          const std::int32_t place = row * lattice_.columns() + column;
          if (!lattice_.is_taken(place)) continue;
          tell(position++, place);
          const bool has_row_below = row > rows.begin, has_row_above = row + 1 < rows.end;
          if (is_regular(place)) {
            number_regular(place, has_row_below, has_row_above, next);
          } else if (owns_filling(filling, column, row)) {
            number_star(place, filling, gathered, next);
          } else {
            number_listed(place, has_row_below, has_row_above, next);
          }
        }
      }
    });
  }

  // Write the triangles; vertex(place) is the number of a vertex.
  template <typename VertexAt>
  bool write(Triangles out, VertexAt&& vertex) {
    return on_stripes([&](int stripe, Gathered&) {
      const Range rows = lattice_.stripes()[stripe];
      for (std::int32_t column = 0; column + 1 < lattice_.columns(); ++column) {
        for (std::int32_t row = rows.begin; row < rows.end; ++row) {
          const std::int32_t cell = row * lattice_.columns() + column;
          if (cells_.is_full(cell)) {
            write_full(out, cell, row + 1 == rows.end, vertex);
          } else if (cells_.has_triangle(cell)) {
            write_half(out, cell, row + 1 == rows.end, vertex);
          }
        }
      }
      for (std::size_t i = first_filling_[stripe]; i < first_filling_[stripe + 1]; ++i) {
        write_filling(out, owners_[i], vertex);
      }
    });
  }

 private:
  struct Owner {
    Vertex vertex;  // as the order of the sweep counts it
    std::int32_t filling;
    std::uint32_t corner;  // of the filling, where the vertex is
  };
  // What a thread works with.
  struct alignas(kCacheLine) Gathered {
    StarOrder star;
    std::vector<std::pair<Vertex, std::int32_t>> place_of;
  };
  using Corners = std::array<std::int32_t, 3>;  // places

  // ------------------------------------------------------------- what belongs to which stripe

  void list_owners() {
    const auto& stripes = lattice_.stripes();
    const auto count = static_cast<std::int32_t>(stripes.size());
    std::vector<std::int32_t> stripe_of(lattice_.rows());
    for (std::int32_t stripe = 0; stripe < count; ++stripe) {
      for (std::int32_t row = stripes[stripe].begin; row < stripes[stripe].end; ++row) {
        stripe_of[row] = stripe;
      }
    }
    first_filling_.assign(count + 1, 0);
    deal_fillings(stripe_of);
    first_triangle_.assign(count + 1, 0);
    first_position_.assign(count + 1, 0);
    for (std::int32_t stripe = 0; stripe < count; ++stripe) {
      std::size_t triangles = first_filling_[stripe + 1] - first_filling_[stripe];
      std::int32_t points = 0;
      for (std::int32_t row = stripes[stripe].begin; row < stripes[stripe].end; ++row) {
        triangles += cells_.certain_in_row(row);
        points += cells_.points_in_row(row);
      }
      first_triangle_[stripe + 1] = first_triangle_[stripe] + static_cast<std::int32_t>(triangles);
      first_position_[stripe + 1] = first_position_[stripe] + points;
    }
  }

  // Stripe by stripe, in the order of the sweep.
  void deal_fillings(const std::vector<std::int32_t>& stripe_of) {
    const auto& fillings = holes_.triangles();
    std::vector<Owner> all;
    std::vector<std::int32_t> stripes;
    for (std::size_t i = 0; i < fillings.size(); ++i) {
      all.push_back(owner_of(fillings[i].corner, static_cast<std::int32_t>(i)));
      stripes.push_back(stripe_of[lattice_.row_of(fillings[i].corner[all.back().corner])]);
      ++first_filling_[stripes.back() + 1];
    }
    for (std::size_t i = 1; i < first_filling_.size(); ++i) {
      first_filling_[i] += first_filling_[i - 1];
    }
    std::vector<std::size_t> next(first_filling_.begin(), first_filling_.end() - 1);
    owners_.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) owners_[next[stripes[i]]++] = all[i];
    for (std::size_t i = 0; i + 1 < first_filling_.size(); ++i) {
      std::sort(owners_.begin() + static_cast<std::ptrdiff_t>(first_filling_[i]),
                owners_.begin() + static_cast<std::ptrdiff_t>(first_filling_[i + 1]),
                [](const Owner& a, const Owner& b) { return a.vertex < b.vertex; });
    }
  }

  Owner owner_of(const Corners& corner, std::int32_t filling) const {
    Owner owner{lattice_.sweep_order(corner[0]), filling, 0};
    for (std::uint32_t k = 1; k < 3; ++k) {
      const Vertex vertex = lattice_.sweep_order(corner[k]);
      if (vertex < owner.vertex) owner = {vertex, filling, k};
    }
    return owner;
  }

  // work(stripe, gathered) for every stripe, each thread its own.
  template <typename Work>
  bool on_stripes(Work&& work) {
    const auto count = static_cast<std::int64_t>(lattice_.stripes().size());
    team_.run([&](int part) {
      Gathered gathered;
      const Range own = part_of(count, part, team_.size());
      for (std::int32_t stripe = own.begin; stripe < own.end; ++stripe) {
        if (!team_.keeps_going(part)) return;
        work(stripe, gathered);
        team_.advance(1);
      }
    });
    return !team_.is_stopped();
  }

  // ------------------------------------------------------------- numbers

  // Whether all places around are taken.
  bool is_regular(std::int32_t place) const {
    const std::int32_t columns = lattice_.columns();
    return (cells_.corners(place) & cells_.corners(place - 1) & cells_.corners(place - columns) &
            cells_.corners(place - columns - 1)) == corner::kAll;
  }

  bool owns_filling(std::size_t filling, std::int32_t column, std::int32_t row) const {
    return filling < owners_.size() && owners_[filling].vertex == lattice_.sweep_order(column, row);
  }

  // As the table of stars has it.
  void number_regular(std::int32_t place, bool has_row_below, bool has_row_above,
                      std::int32_t& next) {
    if (has_row_below) number_of(place - lattice_.columns(), 1) = next++;
    number_of(place, 0) = next++;
    if (!has_row_above) number_of(place - 1, 1) = next++;
  }

  void number_listed(std::int32_t place, bool has_row_below, bool has_row_above,
                     std::int32_t& next) {
    const std::int32_t columns = lattice_.columns();
    const std::int32_t cells[4] = {place, place - 1, place - columns, place - columns - 1};
    const StarTable::Star& star = stars_.star(cells_, place, has_row_below, has_row_above);
    for (int i = 0; i < star.count; ++i) {
      number_of(cells[star.own[i].cell], star.own[i].triangle) = next++;
    }
  }

  void number_star(std::int32_t place, std::size_t& filling, Gathered& gathered,
                   std::int32_t& next) {
    const Vertex vertex = lattice_.sweep_order(place);
    const std::int32_t columns = lattice_.columns();
    gathered.star.clear();
    gathered.place_of.clear();
    for (const std::int32_t cell : {place, place - 1, place - columns, place - columns - 1}) {
      for (int which = 0; which < cells_.triangles_in(cell); ++which) {
        add_ray(vertex, cells_.triangle(cell, which), 2 * cell + which, gathered);
      }
    }
    for (; filling < owners_.size() && owners_[filling].vertex == vertex; ++filling) {
      const std::int32_t at = owners_[filling].filling;
      add_ray(vertex, holes_.triangles()[at].corner, ~at, gathered);
    }
    gathered.star.put_in_order([&](Vertex a, Vertex b) {
      return compare_distances(lattice_.point(place), point_of(a, gathered), point_of(b, gathered));
    });
    for (const StarOrder::Ray& ray : gathered.star) {
      (ray.triangle < 0 ? number_of_filling_[~ray.triangle] : number_of_[ray.triangle]) = next++;
    }
  }

  // Add the triangle if the vertex is its first one.
  void add_ray(Vertex vertex, const Corners& corner, std::int32_t triangle, Gathered& gathered) {
    const Vertex order[3] = {lattice_.sweep_order(corner[0]), lattice_.sweep_order(corner[1]),
                             lattice_.sweep_order(corner[2])};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = corner_after(k), to = corner_before(k);
      if (order[k] != vertex || order[from] < vertex || order[to] < vertex) continue;
      gathered.star.add({order[from], order[to], triangle});
      gathered.place_of.emplace_back(order[from], corner[from]);
    }
  }

  Point point_of(Vertex vertex, const Gathered& gathered) const {
    const auto found = std::find_if(gathered.place_of.begin(), gathered.place_of.end(),
                                    [vertex](const auto& entry) { return entry.first == vertex; });
    return lattice_.point(found->second);
  }

  std::int32_t& number_of(std::int32_t cell, int which) { return number_of_[2 * cell + which]; }
  std::int32_t number_of(std::int32_t cell, int which) const {
    return number_of_[2 * cell + which];
  }

  // ------------------------------------------------------------- arrays

  static void put(Triangles out, std::int32_t number, std::int32_t a, std::int32_t b,
                  std::int32_t c, std::int32_t beyond_a, std::int32_t beyond_b,
                  std::int32_t beyond_c) {
    const std::size_t at = std::size_t{3} * static_cast<std::size_t>(number);
    out.corners[at] = a;
    out.corners[at + 1] = b;
    out.corners[at + 2] = c;
    out.neighbors[at] = beyond_a;
    out.neighbors[at + 1] = beyond_b;
    out.neighbors[at + 2] = beyond_c;
  }

  template <typename VertexAt>
  void write_full(Triangles out, std::int32_t cell, bool is_at_top, VertexAt& vertex) const {
    const std::int32_t columns = lattice_.columns();
    const std::int32_t sw = vertex(cell), se = vertex(cell + 1);
    const std::int32_t nw = vertex(cell + columns), ne = vertex(cell + columns + 1);
    const std::int32_t south = number_of(cell, 0), north = number_of(cell, 1);
    const std::int32_t right = number_beside(cell + 1, 0), above = number_beside(cell + columns, 0);
    put(out, south, sw, se, nw, north, number_beside(cell - 1, 1),
        number_beside(cell - columns, 1));
    if (is_at_top) {
      put(out, north, se, ne, nw, above, south, right);
    } else {
      put(out, north, nw, se, ne, right, above, south);
    }
  }

  // The number of a cell's triangle at an edge between two points: of a full one the triangle 0 is
  // that at the south and west, 1 that at the north and east.
  std::int32_t number_beside(std::int32_t cell, int which) const {
    if (cells_.is_full(cell)) return number_of(cell, which);
    if (cells_.has_triangle(cell)) return number_of(cell, 0);
    return number_of_filling(holes_.left_of_open_edge(cell));
  }

  // The one triangle of a cell with three corners.
  template <typename VertexAt>
  void write_half(Triangles out, std::int32_t cell, bool is_at_top, VertexAt& vertex) const {
    const Corners corner = cells_.triangle(cell, 0);
    std::array<std::int32_t, 3> beyond;
    for (std::uint32_t k = 0; k < 3; ++k) {
      beyond[k] = left_of({corner[corner_before(k)], corner[corner_after(k)]});
    }
    // All have their south-west corner in front, but the one without: first is its south-east, or
    // its north-west if that is in the same stripe.
    const bool is_without = cells_.corners(cell) == corner::kAll - corner::kSW;
    write_turned(out, number_of(cell, 0), corner, beyond, is_without && !is_at_top ? 2 : 0, vertex);
  }

  template <typename VertexAt>
  void write_filling(Triangles out, const Owner& owner, VertexAt& vertex) const {
    const Filling& filling = holes_.triangles()[owner.filling];
    std::array<std::int32_t, 3> beyond;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (filling.beyond[k] == Filling::kOfCell) {
        const LatticeCells::Edge edge = filling.edge(k);
        beyond[k] = left_of({edge.to, edge.from});
      } else {
        beyond[k] = number_of_filling(filling.beyond[k]);
      }
    }
    write_turned(out, number_of_filling_[owner.filling], filling.corner, beyond, owner.corner,
                 vertex);
  }

  std::int32_t number_of_filling(std::int32_t at) const {
    return at < 0 ? kNoNeighbor : number_of_filling_[at];
  }

  // The number of the triangle left of an edge of a cell's.
  std::int32_t left_of(LatticeCells::Edge edge) const {
    const std::int32_t cell = cells_.cell_left_of(edge);
    const int which = cells_.triangle_left_of(edge, cell);
    if (which != LatticeCells::kNone) return number_of(cell, which);
    return number_of_filling(holes_.left_of_open_edge(cell));
  }

  // With corner k in front.
  template <typename VertexAt>
  static void write_turned(Triangles out, std::int32_t number, const Corners& corner,
                           const std::array<std::int32_t, 3>& beyond, std::uint32_t k,
                           VertexAt& vertex) {
    const std::uint32_t l = corner_after(k), m = corner_before(k);
    put(out, number, vertex(corner[k]), vertex(corner[l]), vertex(corner[m]), beyond[k], beyond[l],
        beyond[m]);
  }

  const LatticeCells& cells_;
  const Lattice& lattice_;
  const HoleFilling& holes_;
  Team& team_;
  StarTable stars_;
  ScratchArray<std::int32_t> number_of_;         // of the triangles of each cell
  std::vector<std::int32_t> number_of_filling_;  // of those in holes
  std::vector<Owner> owners_;                    // of those in holes, in the order of the sweep
  std::vector<std::size_t> first_filling_;       // of each stripe, among these
  std::vector<std::int32_t> first_triangle_, first_position_;  // of each stripe
};

}  // namespace tinsmith
