#include "verification/ghost/spectra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/error.h"
#include "transfer/implicit_transfer.h"
#include "transfer/mass.h"

namespace wisp {

namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }

void make_pattern(const Model<2>& model, const Position& position, bool ghost, BlockMatrix& matrix) {
  matrix.begin_pattern(model.space->n_functions());
  add_point_pattern(*model.space, model.bodies, matrix);
  if (ghost) add_ghost_pattern(*model.space, position.facets, matrix);
  matrix.end_pattern();
}

/// Calls f(body, p, stencil) for every point.
template <class F>
void for_each_stencil(const Model<2>& model, F&& f) {
  std::visit(
      [&](const auto& basis) {
        for (const auto& body : model.bodies)
          for (std::size_t p = 0; p < body.points.position.size(); ++p)
            f(body, p,
              basis.tabulate(body.points.position[p],
                             model.space->domains() ? body.points.half_length[p] : Vec<2>::Zero().eval()));
      },
      model.space->basis());
}

}  // namespace

Position settle_at(Model<2>& model, int components) {
  model.settle();
  const ActiveCells cells = active_cells(*model.space, model.bodies);
  Position position{ghost_facets(*model.space, cells, model.bodies, held_edges(model.boundaries)),
                    active_functions(*model.space, cells),
                    {}};
  position.unknowns = DofMap(
      model.space->nodes(), components, position.active,
      model.constraints.any ? std::span<const char>(model.constraints.fixed) : std::span<const char>());
  return position;
}

BlockMatrix consistent_mass(const Model<2>& model, const Position& position, const GhostOptions* ghost) {
  BlockMatrix mass(1);
  make_pattern(model, position, ghost != nullptr, mass);
  add_consistent_mass(*model.space, model.bodies, mass);
  if (ghost) add_ghost(*model.space, position.facets, *ghost, GhostMatrix::mass, mass);
  return mass;
}

BlockMatrix small_strain_stiffness(Model<2>& model, const Position& position, const GhostOptions* ghost) {
  BlockMatrix stiffness(2);
  make_pattern(model, position, ghost != nullptr, stiffness);
  const std::vector<double> zero(at(model.space->n_functions()) * 2, 0.0);
  std::vector<double> force(zero.size());
  for (auto& body : model.bodies) {
    StoredStencils<2> stencils;
    tabulate(*model.space, body.points, stencils);
    add_internal_force(stencils, body, zero, 0.0, force);
    add_stiffness(stencils, body, zero, 0.0, stiffness);
  }
  if (!ghost) return stiffness;
  BlockMatrix penalty(1);
  penalty.share_pattern(stiffness);
  add_ghost(*model.space, position.facets, *ghost, GhostMatrix::stiffness, penalty);
  stiffness.add_matrix(1.0, penalty);
  return stiffness;
}

Eigen::MatrixXd dense(const BlockMatrix& matrix, const DofMap& unknowns) {
  const int n = unknowns.n_global(), components = unknowns.components();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (const int row : unknowns.owned()) {
    const int f = row / components, c = row % components;
    for (const int g : matrix.pattern().row(f))
      for (int d = 0; d < components; ++d) {
        if (unknowns.number(g, d) < 0 || (matrix.block() == 1 && c != d)) continue;
        result(unknowns.number(f, c), unknowns.number(g, d)) =
            matrix.block() == 1 ? matrix.entry(f, 0, g, 0) : matrix.entry(f, c, g, d);
      }
  }
  return result;
}

double lumped_condition(const BlockMatrix& mass, const DofMap& unknowns) {
  std::vector<double> sums(at(mass.n_local()));
  mass.row_sums(sums);
  Extremes extremes{std::numeric_limits<double>::infinity(), 0.0};
  for (const int row : unknowns.owned()) {
    const double sum = sums[at(row / unknowns.components())];
    extremes.least = std::min(extremes.least, sum), extremes.greatest = std::max(extremes.greatest, sum);
  }
  return extremes.condition();
}

Eigen::MatrixXd mass_factor(const Model<2>& model, const DofMap& unknowns) {
  const int components = unknowns.components();
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(model.n_points() * components, unknowns.n_global());
  Eigen::Index row = 0;
  for_each_stencil(model, [&](const Body<2>& body, std::size_t p, const auto& stencil) {
    const double root = std::sqrt(body.points.mass[p]);
    stencil.for_each([&](int, int i, double phi, const Vec<2>&) {
      for (int c = 0; c < components; ++c)
        if (const int k = unknowns.number(i, c); k >= 0) factor(row + c, k) = root * phi;
    });
    row += components;
  });
  return factor;
}

Eigen::MatrixXd stiffness_factor(const Model<2>& model, const DofMap& unknowns) {
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(model.n_points() * 4, unknowns.n_global());
  Eigen::Index row = 0;
  for_each_stencil(model, [&](const Body<2>& body, std::size_t p, const auto& stencil) {
    const auto* group = std::get_if<MaterialStates<LinearElastic, 2>>(&body.material);
    if (!group) run_error("body '{}': the factor of a stiffness needs the law linear-elastic", body.name);
    const Eigen::LLT<SymMap<2>> root(group->law.elasticity().template map<2>());
    const SymMap<2> upper = std::sqrt(body.points.volume[p]) * SymMap<2>(root.matrixU());
    stencil.for_each([&](int, int i, double, const Vec<2>& dphi) {
      // engineering strains xx, yy, zz, xy of unit motions along x and y
      Eigen::Matrix<double, 4, 2> b;
      b << dphi[0], 0.0, 0.0, dphi[1], 0.0, 0.0, dphi[1], dphi[0];
      for (int c = 0; c < 2; ++c)
        if (const int k = unknowns.number(i, c); k >= 0) factor.block<4, 1>(row, k) = upper * b.col(c);
    });
    row += 4;
  });
  return factor;
}

std::optional<double> greatest_eigenvalue(const Eigen::MatrixXd& k, const Eigen::MatrixXd& m) {
  if (!(m.diagonal().array() > 0.0).all()) return std::nullopt;
  const Eigen::VectorXd scale = m.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled_m = scale.asDiagonal() * m * scale.asDiagonal();
  if (scaled_m.llt().info() != Eigen::Success) return std::nullopt;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      scale.asDiagonal() * k * scale.asDiagonal(), scaled_m, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues().maxCoeff();
}

}  // namespace wisp
