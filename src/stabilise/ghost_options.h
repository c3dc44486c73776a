// What a case file says about Ghost stabilisation.
#pragma once
#include "core/describe.h"

namespace wisp {

enum class GhostUnits { dimensionless, paper };
template <>
inline constexpr auto choices<GhostUnits> =
    choice_list<GhostUnits>({{"dimensionless", GhostUnits::dimensionless}, {"paper", GhostUnits::paper}});

enum class GhostScale { printed, figures };
template <>
inline constexpr auto choices<GhostScale> = choice_list<GhostScale>({{"printed", GhostScale::printed},
                                                                     {"figures", GhostScale::figures}});

/// Which cells around the edge of the bodies are penalised; see stabilise/triangle_ghost.h.
enum class GhostElements { standard, boundary, ring, ring_all };
template <>
inline constexpr auto choices<GhostElements> =
    choice_list<GhostElements>({{"standard", GhostElements::standard},
                                {"boundary", GhostElements::boundary},
                                {"ring", GhostElements::ring},
                                {"ring-all", GhostElements::ring_all}});

/// Ghost penalty on facets near the edge of the bodies: J_G = (h_n^3/3) integral of [[d_n u]].[[d_n w]].
/// dimensionless: M_G = mass rho J_G, K_G = stiffness (lambda + 2 mu) J_G / h_n^2.
/// paper: M_G = mass J_G (kg/m3), K_G = stiffness J_G (Pa), J_G times 1 (printed) or h^2/4 (figures).
struct GhostOptions {
  double mass = 0.25;
  double stiffness = 1e-2;
  GhostUnits units = GhostUnits::dimensionless;
  GhostScale scale = GhostScale::printed;
  GhostElements elements = GhostElements::standard;

  static constexpr std::string_view name = "ghost";
  static constexpr std::string_view summary =
      "Penalises jumps of the normal gradient across facets near the edge of the bodies";
  static constexpr std::string_view source = "Coombs 2023, eq. 16-28; Burman 2010";
  static constexpr auto keys() {
    using O = GhostOptions;
    return std::tuple{
        key("mass", &O::mass, "-", "mass penalty gamma_M in units of the density (paper: in kg/m3)")
            .at_least(0),
        key("stiffness", &O::stiffness, "-",
            "stiffness penalty gamma_K in units of lambda + 2 mu (paper: in Pa)")
            .at_least(0),
        key("units", &O::units, "", "dimensionless keys, or the paper's units"),
        key("scale", &O::scale, "",
            "paper units only: J_G as printed, or times h^2/4 as in the paper's figures"),
        key("elements", &O::elements, "",
            "penalised are facets of boundary cells, or (triangulations) of a ring around the bodies, or of "
            "the ring "
            "and all inside; standard: boundary on structured grids, ring-all on triangulations")};
  }
};

}  // namespace wisp
