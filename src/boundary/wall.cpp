#include "boundary/wall.h"

#include <Eigen/Geometry>
#include <cmath>

#include "boundary/wall_host.h"
#include "boundary/wall_memory.h"

namespace wisp {

BandIntegrals band_integrals(double delta) {
  constexpr double r[3] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
  constexpr double w[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  BandIntegrals b;
  for (int q = 0; q < 3; ++q) {
    const double value = 1.0 - (1.0 - r[q]) * (1.0 - r[q]), slope = 2.0 * (1.0 - r[q]) / delta;
    b.slope += w[q] * delta * slope;
    b.value_slope += w[q] * delta * value * slope;
    b.slope_squared += w[q] * delta * slope * slope;
  }
  return b;
}

namespace {

/// Axes of a wall as columns: the normal, then tangents. In 2D the tangent is the normal turned by +90
/// degrees; in 3D the first tangent is the grid axis farthest from the normal, made orthogonal to it.
template <int dim>
Mat<dim> axes(const Vec<dim>& n) {
  Mat<dim> a;
  a.col(0) = n;
  if constexpr (dim == 2) {
    a.col(1) = Vec<2>(-n[1], n[0]);
  } else {
    Eigen::Index d = 0;
    n.cwiseAbs().minCoeff(&d);
    const Vec<3> t = (Vec<3>::Unit(d) - n[d] * n).normalized();
    a.col(1) = t, a.col(2) = n.cross(t);
  }
  return a;
}

/// Chords of curved walls are this part of the shortest side of a cell, or less.
constexpr double longest_chord = 0.25;

/// Lame's constants of the stiffest body in a cell.
template <int dim>
Elasticity elasticity_in(const std::vector<Body<dim>>& bodies, int bits) {
  Elasticity stiffest;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!(bits & (1 << b))) continue;
    const Elasticity e = std::visit([](const auto& m) { return m.law.elasticity(); }, bodies[b].material);
    if (e.p_wave_modulus() > stiffest.p_wave_modulus()) stiffest = e;
  }
  return stiffest;
}

template <int dim>
Moment<dim> moment_of(const Vec<dim>& arm, const Vec<dim>& force) {
  if constexpr (dim == 2)
    return Moment<2>(arm[0] * force[1] - arm[1] * force[0]);
  else
    return arm.cross(force);
}

}  // namespace

template <int dim>
Wall<dim>::Wall(const WallOptions& options, const std::filesystem::path& folder)
    : options_(options), shape_(options.shape, folder) {
  is_curved_ = std::visit(
      [](const auto& s) {
        using S = std::decay_t<decltype(s)>;
        return std::is_same_v<S, CircleWall> || std::is_same_v<S, ArcWall> || std::is_same_v<S, LevelSetWall>;
      },
      options.shape);
  if (options.motion) motion_ = RigidMotion<dim>(*options.motion);
}

/// Displacement over a step along the wall's own axes, in those of the grid.
template <int dim>
Vec<dim> Wall<dim>::own_displacement(const Vec<dim>& normal, double t, double dt) const {
  Vec<dim> own = Vec<dim>::Zero();
  for (std::size_t d = 0; d < options_.displacement.size(); ++d)
    own[static_cast<int>(d)] = options_.displacement[d](t + dt) - options_.displacement[d](t);
  for (std::size_t d = 0; d < options_.velocity.size(); ++d)
    own[static_cast<int>(d)] = integral(options_.velocity[d], t, t + dt);
  return axes<dim>(normal) * own;
}

/// Where the wall is at time t, in parts. Motion along own axes moves a wall that is flat; of others the
/// geometry stays, and material moves away from it or towards it.
template <int dim>
void Wall<dim>::cut(const Space<dim>& space, double t) {
  if (pieces_.empty()) {
    const double h = space.shortest_side();
    const Vec<dim> margin = Vec<dim>::Constant(2.0 * h);
    pieces_ = shape_.pieces(longest_chord * h, {space.lower() - margin, space.upper() + margin});
  }
  bool flat = !options_.displacement.empty() || !options_.velocity.empty();
  for (const auto& piece : pieces_) flat &= (piece.normal - pieces_.front().normal).norm() < 1e-9;
  if (is_cut_ && !motion_.moves() && !flat) return;
  const Vec<dim> shift =
      flat && t > 0.0 ? own_displacement(pieces_.front().normal, 0.0, t) : Vec<dim>::Zero();
  const Mat<dim> turn = motion_.rotation(t);
  cut_.clear();
  for (WallPiece<dim> piece : pieces_) {
    if (motion_.moves() || flat) {
      for (auto& x : piece.vertex) x = motion_.position(x + shift, t);
      piece.normal = turn * piece.normal;
    }
    cut_piece(space, piece, cut_);
  }
  shift_ = shift;
  is_cut_ = true;
}

template <int dim>
void Wall<dim>::begin_step(const Space<dim>& space, const ActiveCells& active,
                           const std::vector<Body<dim>>& bodies, double t, double dt) {
  cut(space, t);
  const WallMemory<dim> memory(states_, space.shortest_side());
  const Mat<dim> turn = motion_.rotation(t);
  // Splines stay positive definite with wider bands, see docs/theory/implicit-boundaries.md.
  const double usual_delta = options_.mode == WallMode::literal ? 1e-6 : on_splines(space) ? 5e-2 : 1e-2;
  points_.clear(), parts_.clear();
  Vec<3> covered = Vec<3>::Zero();
  for (const auto& part : cut_.parts) {
    double size = 0.0;
    for (std::size_t q = part.first; q < part.first + part.count; ++q) size += cut_.weight[q];
    if (owns_host(space, part.host)) covered[0] += size;
    const std::optional<WallHost<dim>> host = find_host(space, active, part);
    if (!host || !owns_host(space, host->cell)) continue;
    covered[1] += size, covered[2] += host->extrapolated ? size : 0.0;
    const Elasticity e = elasticity_in(bodies, active.bits[static_cast<std::size_t>(host->number)]);
    const double delta = options_.delta.value_or(usual_delta);
    const double penalty = band_integrals(delta * host->extent).slope_squared;
    parts_.push_back(points_.size());
    for (std::size_t q = part.first; q < part.first + part.count; ++q) {
      const Vec<dim>& x = cut_.position[q];
      const Vec<dim> rest = motion_.rest(x, t) - shift_;
      // Of curves the normal of the curve itself: that of the chord would prescribe steps from chord to
      // chord.
      const Vec<dim> normal =
          is_curved_ ? shape_.signed_distance(rest).normal : turn.transpose() * part.normal;
      const Vec<dim> own = motion_.rotation(t + dt) * own_displacement(normal, t, dt);
      const WallState<dim> state = memory.at(rest);
      points_.push_back({functions_at(space, *host, x), x, turn * normal, motion_.increment(x, t, dt) + own,
                         turn * state.traction, turn * state.gap, cut_.weight[q], e.lambda, e.mu, penalty});
    }
  }
  parts_.push_back(points_.size());
  covered = Session::sum(covered);
  coverage_ = {covered[0], covered[1], covered[2]};
}

template <int dim>
typename Wall<dim>::Operators Wall<dim>::operators(const Point& point) const {
  const Vec<dim>& n = point.normal;
  const Mat<dim> normal = n * n.transpose(), all = Mat<dim>::Identity();
  Operators o;
  o.held = options_.kind == WallKind::roller       ? normal
           : options_.kind == WallKind::tangential ? Mat<dim>(all - normal)
                                                   : all;
  const Mat<dim> moduli = (point.lambda + 2.0 * point.mu) * normal + point.mu * (all - normal);
  o.penalty = point.penalty * o.held * moduli * o.held;
  // Held components of the trial field rise across the band, so that in the literal form their gradients
  // count as the integral of d d'; free ones count whole, and in the consistent form all do.
  static const BandIntegrals unit = band_integrals(1.0);
  const double share = options_.mode == WallMode::literal ? unit.value_slope : unit.slope;
  const Mat<dim> rise = all - (1.0 - share) * o.held;
  const Vec<dim> rise_n = rise * n;
  for (std::size_t i = 0; i < static_cast<std::size_t>(point.functions.n); ++i) {
    const Vec<dim>& g = point.functions.dphi[i];
    o.traction[i] =
        point.lambda * n * (rise * g).transpose() + point.mu * (g.dot(n) * rise + g * rise_n.transpose());
  }
  return o;
}

template <int dim>
void Wall<dim>::add_pattern(BlockMatrix& matrix) const {
  for (std::size_t k = 0; k + 1 < parts_.size(); ++k)
    matrix.add_element(points_[parts_[k]].functions.functions());
}

template <int dim>
void Wall<dim>::add_stiffness(BlockMatrix& stiffness) const {
  constexpr int most = CellFunctions<dim>::max_functions * dim;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, most, most> dense;
  for (std::size_t k = 0; k + 1 < parts_.size(); ++k) {
    const std::span<const int> functions = points_[parts_[k]].functions.functions();
    const auto n = functions.size();
    dense.setZero(static_cast<int>(n) * dim, static_cast<int>(n) * dim);
    for (std::size_t q = parts_[k]; q < parts_[k + 1]; ++q) {
      const Point& point = points_[q];
      const Operators o = operators(point);
      const auto& phi = point.functions.phi;
      std::array<Mat<dim>, CellFunctions<dim>::max_functions> held_traction;
      for (std::size_t i = 0; i < n; ++i) held_traction[i] = point.weight * o.held * o.traction[i];
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          dense.template block<dim, dim>(static_cast<int>(i) * dim, static_cast<int>(j) * dim) +=
              held_traction[i].transpose() * phi[j] + phi[i] * held_traction[j] +
              (point.weight * phi[i] * phi[j]) * o.penalty;
    }
    stiffness.add(functions, dense.data());
  }
}

template <int dim>
void Wall<dim>::add_force(std::span<double> force) const {
  for (const Point& point : points_) {
    const Operators o = operators(point);
    const Vec<dim> gap = point.weight * (point.gap - o.held * point.target);
    const Vec<dim> traction = point.weight * (point.traction - o.penalty * point.target);
    for (std::size_t i = 0; i < static_cast<std::size_t>(point.functions.n); ++i)
      Eigen::Map<Vec<dim>>(force.data() + point.functions.function[i] * dim) +=
          o.traction[i].transpose() * gap + point.functions.phi[i] * traction;
  }
}

template <int dim>
void Wall<dim>::finish(std::span<const double> u, double t, double dt) {
  states_.clear();
  Eigen::Matrix<double, dim + Moment<dim>::RowsAtCompileTime + 1, 1> sums;
  sums.setZero();
  const Mat<dim> turn = motion_.rotation(t).transpose();
  const Vec<dim> centre = motion_.centre(t + dt);
  for (const Point& point : points_) {
    const Operators o = operators(point);
    Vec<dim> moved = Vec<dim>::Zero(), traction = Vec<dim>::Zero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(point.functions.n); ++i) {
      const Eigen::Map<const Vec<dim>> ui(u.data() + point.functions.function[i] * dim);
      moved += point.functions.phi[i] * ui, traction += o.traction[i] * ui;
    }
    const Vec<dim> gap = o.held * (moved - point.target);
    const Vec<dim> now = point.traction + o.held * traction + o.penalty * gap;
    states_.push_back({motion_.rest(point.position, t) - shift_, turn * now, turn * (point.gap + gap)});
    const Vec<dim> force = -point.weight * now;
    sums.template head<dim>() += force;
    sums.template segment<Moment<dim>::RowsAtCompileTime>(dim) +=
        moment_of<dim>(point.position + point.target - centre, force);
    sums[sums.size() - 1] -= 0.5 * point.weight * (now + point.traction).dot(point.target);
  }
  sums = Session::sum(sums);
  reaction = sums.template head<dim>();
  moment = sums.template segment<Moment<dim>::RowsAtCompileTime>(dim);
  work = sums[sums.size() - 1];
  replicate(states_);
}

template class Wall<2>;
template class Wall<3>;

}  // namespace wisp
