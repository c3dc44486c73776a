#include "particle/sampling.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "geometry/clip.h"
#include "geometry/region.h"
#include "parallel/session.h"
#include "particle/initial_state.h"

namespace wisp {

namespace {

/// A point before it gets its material.
template <int dim>
struct Seed {
  Vec<dim> position, half_length, velocity;
  double volume;
};

/// Positions r in (-1, 1) and shares w of a cell (sum 1) in one direction.
struct Rule {
  std::vector<double> r, w;
};

Rule even_rule(int m) {
  Rule rule;
  for (int k = 0; k < m; ++k) rule.r.push_back((2.0 * k + 1.0) / m - 1.0), rule.w.push_back(1.0 / m);
  return rule;
}

/// Gauss-Legendre points as eigenvalues of the Jacobi matrix (Golub and Welsch 1969).
Rule gauss_rule(int m) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(m, m);
  for (int k = 1; k < m; ++k) jacobi(k, k - 1) = jacobi(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(jacobi);
  Rule rule;
  for (int k = 0; k < m; ++k) {
    rule.r.push_back(solver.eigenvalues()[k]);
    rule.w.push_back(solver.eigenvectors()(0, k) * solver.eigenvectors()(0, k));
  }
  return rule;
}

/// Calls f(seed) for the points of a cell that lie in a shape.
template <int dim, class Shape, class F>
void fill_cell(const Vec<dim>& lower, const Vec<dim>& upper, const Rule& rule, const Shape& shape, F&& f) {
  const int m = static_cast<int>(rule.r.size());
  const Vec<dim> side = upper - lower;
  const Vec<dim> middle = 0.5 * (lower + upper);
  for_each_in(IndexBox<dim>{MultiIndex<dim>::Zero(), MultiIndex<dim>::Constant(m)},
              [&](const MultiIndex<dim>& index) {
                Seed<dim> seed;
                seed.velocity.setZero();
                seed.volume = 1.0;
                for (int d = 0; d < dim; ++d) {
                  const auto i = static_cast<std::size_t>(index[d]);
                  seed.position[d] = middle[d] + 0.5 * side[d] * rule.r[i];
                  seed.half_length[d] = 0.5 * side[d] * rule.w[i];
                  seed.volume *= side[d] * rule.w[i];
                }
                if (shape.contains(seed.position)) f(seed);
              });
}

/// Calls f(seed) for the sub-domains of a cell cut at the shape and at planes (Cortis, Coombs and Augarde
/// 2018, section 4). A cut one becomes a domain about its centroid with the same spread, no longer than stays
/// in the sub-domain.
template <int dim, class F>
void clip_cell(const Vec<dim>& lower, const Vec<dim>& upper, const Rule& rule, const Region<dim>& shape,
               const std::vector<HalfSpace<dim>>& cuts, F&& f) {
  const int m = static_cast<int>(rule.w.size());
  std::array<std::vector<double>, dim> edge;
  for (int d = 0; d < dim; ++d) {
    auto& e = edge[static_cast<std::size_t>(d)];
    e.push_back(lower[d]);
    for (int k = 0; k < m; ++k)
      e.push_back(e.back() + (upper[d] - lower[d]) * rule.w[static_cast<std::size_t>(k)]);
    e.back() = upper[d];
  }
  for_each_in(IndexBox<dim>{MultiIndex<dim>::Zero(), MultiIndex<dim>::Constant(m)},
              [&](const MultiIndex<dim>& index) {
                Vec<dim> a, b;
                for (int d = 0; d < dim; ++d) {
                  const auto& e = edge[static_cast<std::size_t>(d)];
                  a[d] = e[static_cast<std::size_t>(index[d])],
                  b[d] = e[static_cast<std::size_t>(index[d] + 1)];
                }
                const double whole = (b - a).prod();
                const ClippedBox<dim> part = clip_box<dim>(shape, cuts, a, b);
                if (!(part.volume > 1e-14 * whole)) return;
                Vec<dim> x = part.centroid;
                Vec<dim> l = (3.0 * part.variance).cwiseSqrt().cwiseMin(x - a).cwiseMin(b - x);
                if (part.volume > (1.0 - 1e-12) * whole) {
                  l = 0.5 * (b - a);
                  for (int d = 0; d < dim; ++d)
                    x[d] = 0.5 * (lower[d] + upper[d]) +
                           0.5 * (upper[d] - lower[d]) * rule.r[static_cast<std::size_t>(index[d])];
                }
                f(Seed<dim>{x, l, Vec<dim>::Zero(), part.volume});
              });
}

/// The points that lie in a shape, layer by layer: the cells (of the grid, or of the box around the shape
/// divided) with the same place in the last direction.
template <int dim>
class Layers {
 public:
  Layers(const BodyOptions& options, const StructuredGrid<dim>& grid, const std::filesystem::path& folder)
      : grid_(grid),
        region_(region<dim>(options.shape, folder)),
        cuts_(cuts_of<dim>(options)),
        clip_(options.sampling.clip || !cuts_.empty()) {
    const Sampling& s = options.sampling;
    const auto box = bounds(region_);
    if (s.method == SamplingMethod::divisions) {
      if (s.divisions.size() != dim)
        input_error("body '{}': sampling by divisions needs `divisions` with {} values", options.label, dim);
      for (int d = 0; d < dim; ++d) cells_.upper[d] = s.divisions[static_cast<std::size_t>(d)];
      start_ = box.lower;
      step_ = (box.upper - box.lower).cwiseQuotient(cells_.upper.template cast<double>());
      rule_ = even_rule(1);
      divided_ = true;
      return;
    }
    rule_ = s.method == SamplingMethod::gauss ? gauss_rule(s.points_per_cell) : even_rule(s.points_per_cell);
    for (int d = 0; d < dim; ++d) {
      cells_.lower[d] = std::max(0, grid.locate(d, box.lower[d]));
      cells_.upper[d] = std::min(grid.cells(d), grid.locate(d, box.upper[d]) + 1);
    }
  }

  int n() const { return std::max(0, cells_.upper[dim - 1] - cells_.lower[dim - 1]); }
  /// Whether a layer reaches into an interval of the last direction, its ends included.
  bool meets(int layer, double lower, double upper) const {
    MultiIndex<dim> cell = cells_.lower;
    cell[dim - 1] += layer;
    return corner(cell)[dim - 1] <= upper && corner(cell + MultiIndex<dim>::Ones())[dim - 1] >= lower;
  }
  template <class F>
  void for_each_point(int layer, F&& f) const {
    IndexBox<dim> cells = cells_;
    cells.lower[dim - 1] += layer, cells.upper[dim - 1] = cells.lower[dim - 1] + 1;
    std::visit(
        [&](const auto& shape) {
          for_each_in(cells, [&](const MultiIndex<dim>& c) {
            const Vec<dim> lower = corner(c), upper = corner(c + MultiIndex<dim>::Ones());
            if (clip_)
              clip_cell<dim>(lower, upper, rule_, region_, cuts_, f);
            else
              fill_cell<dim>(lower, upper, rule_, shape, f);
          });
        },
        region_);
  }

 private:
  Vec<dim> corner(const MultiIndex<dim>& c) const {
    if (!divided_) return grid_.node(c);
    return start_ + step_.cwiseProduct(c.template cast<double>());
  }

  const StructuredGrid<dim>& grid_;
  Region<dim> region_;
  std::vector<HalfSpace<dim>> cuts_;
  bool clip_;  // sub-domains are cut instead of kept or dropped whole
  Rule rule_;
  IndexBox<dim> cells_;
  bool divided_ = false;
  Vec<dim> start_ = Vec<dim>::Zero(), step_ = Vec<dim>::Zero();  // of divisions
};

/// Throws the fault of the lowest rank that has one, on all ranks.
void fail_together(const std::string& fault) {
  const int lowest = Session::min(fault.empty() ? Session::size() : Session::rank());
  if (lowest < Session::size()) input_error("{}", Session::broadcast(fault, lowest));
}

template <int dim>
Seed<dim> seed_of(const PointRow<dim>& row) {
  return {row.position,
          row.half_length ? *row.half_length : Vec<dim>::Constant(0.5 * std::pow(row.volume, 1.0 / dim)),
          row.velocity ? *row.velocity : Vec<dim>::Zero(), row.volume};
}

}  // namespace

template <int dim>
std::vector<HalfSpace<dim>> cuts_of(const BodyOptions& options) {
  std::vector<HalfSpace<dim>> cuts;
  for (const auto& row : options.sampling.cuts) {
    if (row.size() != 2 * dim)
      input_error("body '{}': cuts needs {} numbers a plane (point, normal), found {}", options.label,
                  2 * dim, row.size());
    cuts.push_back({Eigen::Map<const Vec<dim>>(row.data()), Eigen::Map<const Vec<dim>>(row.data() + dim)});
    if (!(cuts.back().normal.norm() > 0.0))
      input_error("body '{}': cuts: a normal has no length", options.label);
  }
  return cuts;
}

template std::vector<HalfSpace<2>> cuts_of<2>(const BodyOptions&);
template std::vector<HalfSpace<3>> cuts_of<3>(const BodyOptions&);

template <int dim>
Sampler<dim>::Sampler(const BodyOptions& options, const StructuredGrid<dim>& grid,
                      const std::filesystem::path& folder)
    : options_(options), grid_(grid), folder_(folder) {
  std::string fault;
  const auto add = [&](const Vec<dim>& x) {
    MultiIndex<dim> cell;
    for (int d = 0; d < dim; ++d) {
      cell[d] = grid.locate_inside(d, x[d]);
      if ((cell[d] < 0 || cell[d] >= grid.cells(d)) && fault.empty())
        fault = fmt::format("body '{}': a point at {} = {} lies outside the grid, which spans [{}, {}]",
                            options.label, "xyz"[d], x[d], grid.lower()[d], grid.upper()[d]);
    }
    share_.push_back(cell);
  };
  const int rank = Session::rank(), ranks = Session::size();
  if (const auto* file = std::get_if<PointFile>(&options.shape)) {
    for_each_point<dim>(*file, folder, [&](const PointRow<dim>& row) {
      if (count_++ % ranks == rank) add(row.position);
    });
  } else {
    const Layers<dim> layers(options, grid, folder);
    start_.assign(static_cast<std::size_t>(layers.n()) + 1, 0);
    for (int k = rank; k < layers.n(); k += ranks) {
      const std::size_t before = share_.size();
      layers.for_each_point(k, [&](const Seed<dim>& seed) { add(seed.position); });
      start_[static_cast<std::size_t>(k) + 1] = static_cast<std::int64_t>(share_.size() - before);
    }
    Session::sum_in_place(start_);
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    count_ = start_.back();
  }
  fail_together(fault);
  if (count_ == 0)
    input_error(
        "body '{}': no point lies in its shape; check the shape, or use more points per cell or divisions",
        options.label);
}

template <int dim>
template <class F>
void Sampler<dim>::for_each_in_cells(const IndexBox<dim>& cells, F&& f) const {
  const auto try_point = [&](std::int64_t k, const auto& seed) {
    MultiIndex<dim> cell;
    for (int d = 0; d < dim; ++d) cell[d] = grid_.locate_inside(d, seed.position[d]);
    if (cells.contains(cell)) f(k, seed);
  };
  if (const auto* file = std::get_if<PointFile>(&options_.shape)) {
    std::int64_t k = 0;
    for_each_point<dim>(*file, folder_, [&](const PointRow<dim>& row) { try_point(k++, seed_of<dim>(row)); });
    return;
  }
  const Layers<dim> layers(options_, grid_, folder_);
  const double lower = grid_.line(dim - 1, cells.lower[dim - 1]);
  const double upper = grid_.line(dim - 1, cells.upper[dim - 1]);
  for (int layer = 0; layer < layers.n(); ++layer) {
    if (!layers.meets(layer, lower, upper)) continue;
    std::int64_t k = start_[static_cast<std::size_t>(layer)];
    layers.for_each_point(layer, [&](const Seed<dim>& seed) { try_point(k++, seed); });
  }
}

template <int dim>
Body<dim> Sampler<dim>::points(const IndexBox<dim>& cells, bool with_domains, std::int64_t first_id) const {
  InitialState<dim> state(options_);
  std::vector<Vec<dim>> half_lengths;
  for_each_in_cells(cells, [&](std::int64_t k, const Seed<dim>& seed) {
    state.add(first_id + k, seed.position, seed.volume, seed.velocity);
    if (with_domains) half_lengths.push_back(seed.half_length);
  });
  Body<dim> body = state.take();
  body.points.half_length = half_lengths, body.points.initial_half_length = std::move(half_lengths);
  return body;
}

template class Sampler<2>;
template class Sampler<3>;

}  // namespace wisp
