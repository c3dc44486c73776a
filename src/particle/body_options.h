// What a case file says about a body: shape, sampling, material, initial state.
#pragma once
#include <optional>

#include "core/describe.h"
#include "geometry/list.h"
#include "material/list.h"

namespace wisp {

enum class SamplingMethod { cells, gauss, divisions, random };
template <>
inline constexpr auto choices<SamplingMethod> =
    choice_list<SamplingMethod>({{"cells", SamplingMethod::cells},
                                 {"gauss", SamplingMethod::gauss},
                                 {"divisions", SamplingMethod::divisions},
                                 {"random", SamplingMethod::random}});

enum class PointVolumes { share, voronoi };
template <>
inline constexpr auto choices<PointVolumes> = choice_list<PointVolumes>({{"share", PointVolumes::share},
                                                                         {"voronoi", PointVolumes::voronoi}});

/// Where the points of a body are put. A point belongs to the body if its position lies in the shape.
struct Sampling {
  SamplingMethod method = SamplingMethod::cells;
  int points_per_cell = 2;
  std::vector<int> divisions;
  int seed = 1;
  PointVolumes volumes = PointVolumes::share;
  bool clip = false;
  std::vector<std::vector<double>> cuts;

  static constexpr std::string_view name = "sampling";
  static constexpr std::string_view summary = "How points are laid out in a shape";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{
        key("method", &Sampling::method, "",
            "cells: evenly in every grid cell; gauss: at Gauss positions of every cell, or on triangles "
            "three in each of n^2 parts of each of the six triangles of the Powell-Sabin split; "
            "divisions: evenly in the shape's bounding box; random: in every triangle"),
        key("seed", &Sampling::seed, "-", "of method random").at_least(0),
        key("volumes", &Sampling::volumes, "",
            "equal shares of the cell, or the points' Voronoi cells in the shape (triangulations)"),
        key("points_per_cell", &Sampling::points_per_cell, "-",
            "points in a cell and direction (cells, gauss); of a triangle the root of their number")
            .at_least(1)
            .at_most(64),
        key("divisions", &Sampling::divisions, "-",
            "number of points across the bounding box in each direction (divisions)")
            .at_least(1)
            .per_direction(),
        key("clip", &Sampling::clip, "",
            "cut the points' sub-domains at the outline of the shape: volumes and centroids of "
            "what is left, the total exact (box, polygon, stl)"),
        key("cuts", &Sampling::cuts, "m",
            "planes (2D: lines) that cut the sub-domains as well: a point and a normal into "
            "the body each, as one list of numbers")};
  }
};

/// Initial vertical stress from the weight of the soil above, horizontal stress K0 times that.
struct InitialK0 {
  double k0 = 0.5;
  double surface = 0.0;
  double gravity = 9.81;

  static constexpr std::string_view name = "k0";
  static constexpr std::string_view summary =
      "Initial stress that grows with depth; the last direction is up";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    return std::tuple{
        key("k0", &InitialK0::k0, "-", "horizontal over vertical stress").at_least(0),
        key("surface", &InitialK0::surface, "m", "level of the free surface"),
        key("gravity", &InitialK0::gravity, "m/s2", "acceleration of gravity, positive downwards")
            .at_least(0)};
  }
};

struct BodyOptions {
  std::string label;
  AnyShape shape;
  Sampling sampling;
  AnyLaw material;
  std::vector<double> velocity;
  std::vector<std::vector<double>> velocity_gradient;
  std::vector<double> velocity_centre;
  std::vector<double> initial_stress;
  std::optional<InitialK0> k0;

  static constexpr std::string_view name = "body";
  static constexpr std::string_view summary = "A body: points of one material sampled in a shape";
  static constexpr std::string_view source = "";
  static constexpr auto keys() {
    using O = BodyOptions;
    return std::tuple{key("name", &O::label, "", "name of the body, unique in the case").required(),
                      key("shape", &O::shape, "", "the region that the body fills").required(),
                      key("sampling", &O::sampling, "", "how points are laid out"),
                      key("material", &O::material, "", "the law of the material").required(),
                      key("velocity", &O::velocity, "m/s", "initial velocity (default 0)").per_direction(),
                      key("velocity_gradient", &O::velocity_gradient, "1/s",
                          "rows L of a linear field v = velocity + L (x - velocity_centre)")
                          .per_direction(),
                      key("velocity_centre", &O::velocity_centre, "m",
                          "point where the linear field is zero (default the origin)")
                          .per_direction(),
                      key("initial_stress", &O::initial_stress, "Pa",
                          "constant Cauchy stress xx, yy, zz, xy (3D: xx, yy, zz, xy, yz, zx)"),
                      key("k0", &O::k0, "", "initial stress that grows with depth")};
  }
};

}  // namespace wisp
