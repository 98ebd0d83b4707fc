// Bindings of hydrology.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../../../tin/cpp/python/conversion.hpp"
#include "../hydrology/cells.hpp"
#include "../hydrology/channels.hpp"
#include "../hydrology/network.hpp"

namespace tinsmith::python {

using GivenSigns = Given<std::int8_t, -1, 3>;
using GivenOffsets = Given<std::int64_t, -1>;
using GivenLongs = Given<std::int64_t, -1>;
using GivenVertices = Given<bool, -1>;

// The arrays of a Filling.
struct GivenFilling {
  GivenValues levels;
  GivenLongs ponds, nexts, steps, ranks;
};
using ChangedValues = nb::ndarray<double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

inline void require(bool is_sound, const char* message) {
  if (!is_sound) throw std::invalid_argument(message);
}

inline bool are_offsets(const GivenOffsets& offsets, std::size_t count, std::size_t total) {
  const std::size_t size = offsets.shape(0);
  return size == count + 1 && offsets.data()[0] == 0 &&
         offsets.data()[count] == static_cast<std::int64_t>(total) &&
         std::is_sorted(offsets.data(), offsets.data() + size);
}

inline bool are_below(const GivenNumbers& numbers, std::int64_t least, std::int64_t most) {
  return are_all(numbers, [=](std::int32_t one) { return least <= one && one < most; });
}

// Of some triangles, as hydrology::Base.
struct BaseArrays {
  Offsets edges;
  Elevations splits;
  Flags drains;
};

// A surface and how its triangles fall; holds the arrays it is given.
class FallingSurface {
 public:
  FallingSurface(GivenXyz points, GivenTriples triangles, GivenTriples neighbors, GivenSigns signs,
                 GivenXyz values, std::optional<GivenFilling> filling)
      : points_(std::move(points)),
        triangles_(std::move(triangles)),
        neighbors_(std::move(neighbors)),
        signs_(std::move(signs)),
        values_(std::move(values)),
        given_filling_(std::move(filling)),
        falls_{surface_of(points_, triangles_, &neighbors_), signs_.data(), values_.data()} {
    const std::size_t count = triangles_.shape(0);
    require(falls_.surface.has_sound_neighbors(), "neighbors must be triangles or -1");
    require(signs_.shape(0) == count && values_.shape(0) == count,
            "there must be a row of signs and of values for each triangle");
    if (given_filling_) fill(*given_filling_);
    ReleasedLock release;
    bases_.reserve(count);
    for (const Triangle t : Ids<Triangle>(falls_.surface.triangle_count)) {
      bases_.push_back(falls_.base(t));
    }
  }

  BaseArrays bases_of(const GivenLongs& triangles) const {
    const std::size_t count = triangles.shape(0);
    const auto most = static_cast<std::int64_t>(bases_.size());
    require(are_all(triangles, [=](std::int64_t t) { return 0 <= t && t < most; }),
            "there must be such triangles");
    auto edges = streamed_array<std::int64_t>(count);
    auto splits = streamed_array<double>(count);
    auto drains = streamed_array<bool>(count);
    for (std::size_t i = 0; i < count; ++i) {
      const hydrology::Base& base = bases_[static_cast<std::size_t>(triangles.data()[i])];
      edges[i] = base.corner;
      splits[i] = base.split;
      drains[i] = base.drains;
    }
    return {hand_over<Offsets>(std::move(edges), {count}),
            hand_over<Elevations>(std::move(splits), {count}),
            hand_over<Flags>(std::move(drains), {count})};
  }

  // Offsets by triangle, and starts of strips.
  std::pair<Offsets, Elevations> cut_strips(std::int64_t most) const {
    const std::size_t count = bases_.size();
    auto offsets = streamed_array<std::int64_t>(count + 1);
    StreamedArray<double> starts;
    run_unlocked(1, [&](Team& team) {
      Pulse pulse(team);
      hydrology::StripCutter cutter(falls_, bases_.data(), pulse);
      cutter.cut(most, offsets.get());
      starts = cutter.take_starts();
    });
    const auto size = static_cast<std::size_t>(offsets[count]);
    return {hand_over<Offsets>(std::move(offsets), {count + 1}),
            hand_over<Elevations>(std::move(starts), {size})};
  }

  Elevations measure_strips(const GivenOffsets& offsets, const GivenValues& starts,
                            const GivenValues& areas) const {
    const hydrology::Strips strips = strips_of(offsets, starts);
    require(areas.shape(0) == bases_.size(), "there must be one area for each triangle");
    auto sizes = streamed_array<double>(starts.shape(0));
    {
      ReleasedLock release;
      hydrology::measure_strips(strips, bases_.data(), areas.data(), triangle_count(), sizes.get());
    }
    return hand_over<Elevations>(std::move(sizes), {starts.shape(0)});
  }

  // What is below all nodes, and the upper ends of channels, of strips; ends are below themselves.
  std::pair<Numbers, Numbers> link_strips(const GivenOffsets& offsets, const GivenValues& starts,
                                          const GivenNumbers& grounds, int threads) const {
    const hydrology::Strips strips = strips_of(offsets, starts);
    const hydrology::Nodes nodes = nodes_of(starts.shape(0), grounds);
    const std::size_t count = nodes.count(), inner = nodes.first_vertex + nodes.vertex_count;
    auto nexts = streamed_array<std::int32_t>(count);
    auto uppers = streamed_array<std::int32_t>(inner);
    run_unlocked(threads, [&](Team& team) {
      const hydrology::StripLinks links(falls_, bases_.data(), filling_, strips, nodes);
      links.run(nexts.get(), uppers.get(), team);
      for (std::size_t i = starts.shape(0); i < count; ++i) nexts[i] = static_cast<int>(i);
      std::fill(uppers.get() + starts.shape(0), uppers.get() + inner, -1);
    });
    return {hand_over<Numbers>(std::move(nexts), {count}),
            hand_over<Numbers>(std::move(uppers), {inner})};
  }

  // The same of vertices, and those of them that doubles do not decide.
  std::tuple<Numbers, Numbers, Numbers> link_vertices(const GivenVertices& is_boundary,
                                                      std::size_t strip_count,
                                                      const GivenNumbers& grounds,
                                                      int threads) const {
    const hydrology::Nodes nodes = nodes_of(strip_count, grounds);
    const std::size_t count = points_.shape(0);
    require(is_boundary.shape(0) == count, "there must be one flag for each vertex");
    auto nexts = streamed_array<std::int32_t>(count);
    auto uppers = streamed_array<std::int32_t>(count);
    const auto undecided = unlocked(threads, [&](Team& team) {
      const hydrology::ExitTable exits(falls_, filling_, is_boundary.data(), team);
      const hydrology::VertexLinks links(falls_, bases_.data(), filling_, exits, nodes);
      return links.run(nexts.get(), uppers.get(), team);
    });
    return {hand_over<Numbers>(std::move(nexts), {count}),
            hand_over<Numbers>(std::move(uppers), {count}), hand_over(undecided)};
  }

 private:
  std::uint32_t triangle_count() const { return falls_.surface.triangle_count; }

  void fill(const GivenFilling& given) {
    const auto& [levels, ponds, nexts, steps, ranks] = given;
    const std::size_t count = points_.shape(0);
    require(levels.shape(0) == count && ponds.shape(0) == count && nexts.shape(0) == count &&
                steps.shape(0) == count && ranks.shape(0) == count,
            "there must be one value of each kind for each vertex");
    const auto most = static_cast<std::int64_t>(count);
    require(are_all(nexts, [=](std::int64_t v) { return -1 <= v && v < most; }),
            "the next vertices must be vertices or -1");
    filling_ = {levels.data(), ponds.data(), nexts.data(), steps.data(), ranks.data()};
  }

  hydrology::Strips strips_of(const GivenOffsets& offsets, const GivenValues& starts) const {
    require(are_offsets(offsets, bases_.size(), starts.shape(0)),
            "offsets must ascend, one for each triangle and the end");
    return {offsets.data(), starts.data()};
  }

  hydrology::Nodes nodes_of(std::size_t strip_count, const GivenNumbers& grounds) const {
    const std::size_t vertices = points_.shape(0);
    require(grounds.shape(0) == vertices && are_below(grounds, 0, vertices),
            "there must be a vertex of its ground for each vertex");
    require(strip_count + 2 * vertices < INT32_MAX, "more nodes than 32-bit indices can number");
    return {static_cast<std::int32_t>(strip_count), static_cast<std::int32_t>(vertices),
            grounds.data()};
  }

  const GivenXyz points_;
  const GivenTriples triangles_;
  const GivenTriples neighbors_;
  const GivenSigns signs_;
  const GivenXyz values_;
  const std::optional<GivenFilling> given_filling_;
  const hydrology::FallingSurface falls_;
  hydrology::Filling filling_;
  std::vector<hydrology::Base> bases_;
};

inline void require_nodes(const GivenNumbers& nexts) {
  const auto count = row_count(nexts.shape(0), INT32_MAX);
  require(are_below(nexts, 0, count), "what is below a node must be a node");
}

inline Numbers find_ends(const GivenNumbers& nexts) {
  require_nodes(nexts);
  const std::size_t count = nexts.shape(0);
  auto ends = streamed_array<std::int32_t>(count);
  run_unlocked(1, [&](Team& team) {
    Pulse pulse(team);
    hydrology::find_ends(nexts.data(), static_cast<std::int32_t>(count), ends.get(), pulse);
  });
  return hand_over<Numbers>(std::move(ends), {count});
}

inline void accumulate(const GivenNumbers& nexts, ChangedValues& totals) {
  require_nodes(nexts);
  require(totals.shape(0) == nexts.shape(0), "there must be one value for each node");
  run_unlocked(1, [&](Team& team) {
    Pulse pulse(team);
    hydrology::accumulate(nexts.data(), static_cast<std::int32_t>(nexts.shape(0)), totals.data(),
                          pulse);
  });
}

// Upper and lower ends, areas.
inline std::pair<Pairs, Elevations> sum_channels(const GivenNumbers& uppers,
                                                 const GivenNumbers& nexts,
                                                 const GivenValues& totals,
                                                 std::int32_t vertex_count) {
  require_nodes(nexts);
  const std::size_t count = uppers.shape(0);
  require(vertex_count >= 0 && count >= static_cast<std::size_t>(vertex_count) &&
              nexts.shape(0) >= count && totals.shape(0) == nexts.shape(0) &&
              are_below(uppers, -1, vertex_count),
          "nodes must be strips and vertices");
  const auto nodes = static_cast<std::int32_t>(count);
  const std::vector<hydrology::Channel> found = [&] {
    ReleasedLock release;
    return hydrology::ChannelSums(uppers.data(), nexts.data(), nodes, nodes - vertex_count,
                                  vertex_count)
        .sum(totals.data(), vertex_count);
  }();
  auto pairs = streamed_array<std::int32_t>(2 * found.size());
  auto areas = streamed_array<double>(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    pairs[2 * i] = number(found[i].start);
    pairs[2 * i + 1] = number(found[i].end);
    areas[i] = found[i].area;
  }
  return {hand_over<Pairs>(std::move(pairs), {found.size(), 2}),
          hand_over<Elevations>(std::move(areas), {found.size()})};
}

using GivenRanges = Given<std::int64_t, -1, 6>;

// Numbers of the cells, their offsets and vertices.
inline std::tuple<Offsets, Offsets, Numbers> cut_cells(
    const GivenTriples& corners, const GivenRanges& ranges, std::int32_t first_place,
    const GivenOffsets& offsets, const GivenNumbers& lower, const GivenNumbers& upper) {
  const std::size_t count = corners.shape(0);
  require(are_offsets(offsets, count, lower.shape(0)) && upper.shape(0) == lower.shape(0),
          "offsets must ascend, one for each triangle and the end");
  require(ranges.shape(0) == count && first_place >= 0 &&
              are_all(ranges,
                      [=](std::int64_t at) { return 0 <= at && at <= INT32_MAX - first_place; }),
          "ranges must be of places that 32-bit indices can number");
  for (std::size_t i = 0; i < 6 * count; i += 2) {
    require(ranges.data()[i] <= ranges.data()[i + 1], "ranges must be of places");
  }
  const hydrology::CutTriangles given{count,          corners.data(), ranges.data(), first_place,
                                      offsets.data(), lower.data(),   upper.data()};
  const hydrology::CutCells cells = [&] {
    ReleasedLock release;
    return hydrology::CellCutter(given).run();
  }();
  return {copy_over<Offsets, std::int64_t>(cells.numbers, {cells.numbers.size()}),
          copy_over<Offsets, std::int64_t>(cells.offsets, {cells.offsets.size()}),
          hand_over(cells.vertices)};
}

inline void bind_hydrology(nb::module_& m) {
  Result<BaseArrays>(m, "Bases", R"(
The edges of triangles that all their fall lines meet, so that shares of them name those.

It is the only edge that water leaves across, or else the only one that it enters across::

              apex
             /  | \         share 0 at the start of the base, 1 at its end; the fall line
            /   |  \        through the apex meets it at `splits`
      start ----|--- end
)")
      .def_array("edges", &BaseArrays::edges, "(k,), as corners opposite.")
      .def_array("splits", &BaseArrays::splits, "(k,).")
      .def_array("drains", &BaseArrays::drains, "(k,), whether water leaves across the base.");
  nb::class_<GivenFilling>(m, "Filling", "The water of full depressions, by vertex.")
      .def(nb::init<GivenValues, GivenLongs, GivenLongs, GivenLongs, GivenLongs>(),
           "levels"_a.noconvert(), "ponds"_a.noconvert(), "nexts"_a.noconvert(),
           "steps"_a.noconvert(), "ranks"_a.noconvert());
  nb::class_<FallingSurface>(m, "FallingSurface", "A surface and how its triangles fall.")
      .def(nb::init<GivenXyz, GivenTriples, GivenTriples, GivenSigns, GivenXyz,
                    std::optional<GivenFilling>>(),
           "points"_a.noconvert(), "triangles"_a.noconvert(), "neighbors"_a.noconvert(),
           "signs"_a.noconvert(), "values"_a.noconvert(), "filling"_a.none())
      .def("bases_of", &FallingSurface::bases_of, "triangles"_a.noconvert(),
           "The edges that all fall lines of triangles meet.")
      .def("cut_strips", &FallingSurface::cut_strips, "most"_a,
           "Offsets of strips by triangle, and where each begins on the base.")
      .def("measure_strips", &FallingSurface::measure_strips, "offsets"_a.noconvert(),
           "starts"_a.noconvert(), "areas"_a.noconvert(), "Areas of strips.")
      .def("link_strips", &FallingSurface::link_strips, "offsets"_a.noconvert(),
           "starts"_a.noconvert(), "grounds"_a.noconvert(), "threads"_a = 1,
           "Nodes below, and upper ends of channels, of strips; vertices are left to be linked.")
      .def("link_vertices", &FallingSurface::link_vertices, "is_boundary"_a.noconvert(),
           "strip_count"_a, "grounds"_a.noconvert(), "threads"_a = 1,
           "Nodes below, and upper ends of channels, of vertices; -1 of those that are undecided, "
           "which come last.");
  m.def("find_ends", &find_ends, "nexts"_a.noconvert(),
        "The node at which the water of each ends, -1 where it runs in a circle.");
  m.def("accumulate", &accumulate, "nexts"_a.noconvert(), "totals"_a.noconvert(),
        "Add to every node what comes to it from above, in place.");
  m.def("sum_channels", &sum_channels, "uppers"_a.noconvert(), "nexts"_a.noconvert(),
        "totals"_a.noconvert(), "vertex_count"_a,
        "Upper and lower ends of channels, and the sum of what their nodes bring.");
  m.def("cut_cells", &cut_cells, "corners"_a.noconvert(), "ranges"_a.noconvert(), "first_place"_a,
        "offsets"_a.noconvert(), "lower"_a.noconvert(), "upper"_a.noconvert(),
        "Cells of triangles that are cut: numbers, offsets, vertices.");
}

}  // namespace tinsmith::python
