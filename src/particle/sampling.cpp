#include "particle/sampling.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/error.h"
#include "geometry/clip.h"

namespace wisp {

namespace {

/// Positions, volumes and domains before they become points.
template <int dim>
struct Layout {
  std::vector<Vec<dim>> position, half_length, velocity;
  std::vector<double> volume;
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

template <int dim, class Shape>
void fill_cell(const Vec<dim>& lower, const Vec<dim>& upper, const Rule& rule, const Shape& shape,
               Layout<dim>& out) {
  const int m = static_cast<int>(rule.r.size());
  const Vec<dim> side = upper - lower;
  const Vec<dim> middle = 0.5 * (lower + upper);
  for_each_in(IndexBox<dim>{MultiIndex<dim>::Zero(), MultiIndex<dim>::Constant(m)},
              [&](const MultiIndex<dim>& index) {
                Vec<dim> x, l;
                double volume = 1.0;
                for (int d = 0; d < dim; ++d) {
                  const auto i = static_cast<std::size_t>(index[d]);
                  x[d] = middle[d] + 0.5 * side[d] * rule.r[i];
                  l[d] = 0.5 * side[d] * rule.w[i];
                  volume *= side[d] * rule.w[i];
                }
                if (!shape.contains(x)) return;
                out.position.push_back(x), out.half_length.push_back(l), out.volume.push_back(volume);
              });
}

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

/// The sub-domains of a cell cut at the shape and at planes (Cortis, Coombs and Augarde 2018, section 4). A
/// cut one becomes a domain about its centroid with the same spread, no longer than stays in the sub-domain.
template <int dim>
void clip_cell_points(const Vec<dim>& lower, const Vec<dim>& upper, const Rule& rule,
                      const Region<dim>& shape, const std::vector<HalfSpace<dim>>& cuts, Layout<dim>& out) {
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
                out.position.push_back(x), out.half_length.push_back(l), out.volume.push_back(part.volume);
              });
}

template <int dim>
Layout<dim> lay_out(const BodyOptions& options, const StructuredGrid<dim>& grid,
                    const std::filesystem::path& folder) {
  Layout<dim> out;
  if (const auto* file = std::get_if<PointFile>(&options.shape)) {
    PointTable<dim> table = read_points<dim>(*file, folder);
    out.position = std::move(table.positions), out.volume = std::move(table.volumes);
    out.velocity = std::move(table.velocities), out.half_length = std::move(table.half_lengths);
    if (out.half_length.empty())
      for (const double v : out.volume)
        out.half_length.push_back(Vec<dim>::Constant(0.5 * std::pow(v, 1.0 / dim)));
    return out;
  }
  const Region<dim> any = region<dim>(options.shape, folder);
  const bool clip = options.sampling.clip || !options.sampling.cuts.empty();
  const std::vector<HalfSpace<dim>> cuts = cuts_of<dim>(options);
  std::visit(
      [&](const auto& shape) {
        const auto box = bounds(shape);
        const Sampling& s = options.sampling;
        if (s.method == SamplingMethod::divisions) {
          if (s.divisions.size() != dim)
            input_error("body '{}': sampling by divisions needs `divisions` with {} values", options.label,
                        dim);
          MultiIndex<dim> n;
          for (int d = 0; d < dim; ++d) n[d] = s.divisions[static_cast<std::size_t>(d)];
          const Vec<dim> step = (box.upper - box.lower).cwiseQuotient(n.template cast<double>());
          const Rule rule = even_rule(1);
          for_each_in(IndexBox<dim>{MultiIndex<dim>::Zero(), n}, [&](const MultiIndex<dim>& i) {
            const Vec<dim> lower = box.lower + step.cwiseProduct(i.template cast<double>());
            if (clip) return clip_cell_points<dim>(lower, lower + step, rule, any, cuts, out);
            fill_cell<dim>(lower, lower + step, rule, shape, out);
          });
          return;
        }
        const Rule rule =
            s.method == SamplingMethod::gauss ? gauss_rule(s.points_per_cell) : even_rule(s.points_per_cell);
        IndexBox<dim> cells;
        for (int d = 0; d < dim; ++d) {
          cells.lower[d] = std::max(0, grid.locate(d, box.lower[d]));
          cells.upper[d] = std::min(grid.cells(d), grid.locate(d, box.upper[d]) + 1);
        }
        for_each_in(cells, [&](const MultiIndex<dim>& c) {
          if (clip)
            return clip_cell_points<dim>(grid.node(c), grid.node(c + MultiIndex<dim>::Ones()), rule, any,
                                         cuts, out);
          fill_cell<dim>(grid.node(c), grid.node(c + MultiIndex<dim>::Ones()), rule, shape, out);
        });
      },
      any);
  return out;
}

template <int dim>
Vec<dim> vector_or_zero(const std::vector<double>& list, const char* key, const std::string& body) {
  if (list.empty()) return Vec<dim>::Zero();
  if (list.size() != dim) input_error("body '{}': {} needs {} values, found {}", body, key, dim, list.size());
  return Eigen::Map<const Vec<dim>>(list.data());
}

template <int dim>
Mat<dim> velocity_gradient(const BodyOptions& options) {
  Mat<dim> gradient = Mat<dim>::Zero();
  const auto& rows = options.velocity_gradient;
  if (rows.empty()) return gradient;
  for (const auto& row : rows)
    if (rows.size() != dim || row.size() != dim)
      input_error("body '{}': velocity_gradient needs {} rows of {} values", options.label, dim, dim);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      gradient(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return gradient;
}

template <int dim>
Sym<dim> initial_stress(const BodyOptions& options, double density, const Vec<dim>& x) {
  if (!options.initial_stress.empty()) {
    if (options.initial_stress.size() != sym_size<dim>)
      input_error("body '{}': initial_stress needs {} values, found {}", options.label, sym_size<dim>,
                  options.initial_stress.size());
    return Eigen::Map<const Sym<dim>>(options.initial_stress.data());
  }
  Sym<dim> sigma = Sym<dim>::Zero();
  if (options.k0) {
    const double depth = std::max(0.0, options.k0->surface - x[dim - 1]);
    const double vertical = -density * options.k0->gravity * depth;
    for (int a = 0; a < 3; ++a) sigma[a] = options.k0->k0 * vertical;
    sigma[dim - 1] = vertical;
  }
  return sigma;
}

}  // namespace

template <int dim>
Body<dim> sample(const BodyOptions& options, const StructuredGrid<dim>& grid, bool with_domains,
                 std::int64_t first_id, const std::filesystem::path& folder) {
  Layout<dim> layout = lay_out<dim>(options, grid, folder);
  if (layout.position.empty())
    input_error(
        "body '{}': no point lies in its shape; check the shape, or use more points per cell or divisions",
        options.label);
  const Vec<dim> v0 = vector_or_zero<dim>(options.velocity, "velocity", options.label);
  const Vec<dim> centre = vector_or_zero<dim>(options.velocity_centre, "velocity_centre", options.label);
  const Mat<dim> gradient = velocity_gradient<dim>(options);
  if (options.k0 && !options.initial_stress.empty())
    input_error("body '{}': give either initial_stress or k0", options.label);

  Body<dim> body{options.label, {}, make_material<dim>(options.material)};
  Particles<dim>& points = body.points;
  const double rho = body.density();
  const std::size_t n = layout.position.size();
  for (std::size_t p = 0; p < n; ++p) {
    const Vec<dim>& x = layout.position[p];
    for (int d = 0; d < dim; ++d)
      if (const int i = grid.locate_inside(d, x[d]); i < 0 || i >= grid.cells(d))
        input_error("body '{}': a point at {} = {} lies outside the grid, which spans [{}, {}]",
                    options.label, "xyz"[d], x[d], grid.lower()[d], grid.upper()[d]);
    points.id.push_back(first_id + static_cast<std::int64_t>(p));
    points.velocity.push_back(v0 + gradient * (x - centre) +
                              (layout.velocity.empty() ? Vec<dim>::Zero() : layout.velocity[p]));
    points.mass.push_back(rho * layout.volume[p]);
  }
  points.cell.assign(n, 0);
  points.displacement.assign(n, Vec<dim>::Zero());
  points.deformation_gradient.assign(n, Mat<dim>::Identity());
  std::visit(
      [&](auto& m) {
        for (const auto& x : layout.position)
          m.old.push_back(m.law.template initial<dim>(initial_stress<dim>(options, rho, x)));
      },
      body.material);
  points.position = std::move(layout.position);
  points.volume = std::move(layout.volume);
  if (with_domains)
    points.half_length = layout.half_length, points.initial_half_length = std::move(layout.half_length);
  return body;
}

template Body<2> sample<2>(const BodyOptions&, const StructuredGrid<2>&, bool, std::int64_t,
                           const std::filesystem::path&);
template Body<3> sample<3>(const BodyOptions&, const StructuredGrid<3>&, bool, std::int64_t,
                           const std::filesystem::path&);

}  // namespace wisp
