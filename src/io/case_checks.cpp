// Checks of a case across its tables. What one key alone admits is checked by the reader.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "basis/space.h"
#include "boundary/conforming.h"
#include "core/nearest.h"
#include "geometry/region.h"
#include "grid/gmsh.h"
#include "grid/triangulate.h"
#include "io/case.h"
#include "io/placement.h"
#include "io/toml_reader.h"

namespace wisp {
namespace {

/// Throws again what a lower room complains about, with the place in the file.
template <class F>
auto located(const Context& context, const std::string& path, F&& f) {
  try {
    return f();
  } catch (const InputError& error) {
    context.fail_at(path, error.what());
  }
}

std::string place(std::string_view list, std::size_t i, std::string_view key = {}) {
  return fmt::format("{}[{}]{}{}", list, i, key.empty() ? "" : ".", key);
}

template <class T>
const std::string& label_of(const T& entry) {
  if constexpr (reader::is_variant<T>)
    return std::visit([](const auto& e) -> const std::string& { return e.label; }, entry);
  else
    return entry.label;
}

/// Names within a list of tables are unique.
template <class T>
void check_unique(const std::vector<T>& list, std::string_view name, const Context& context) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < list.size(); ++i)
    if (const std::string& label = label_of(list[i]); !seen.insert(label).second)
      context.fail_at(place(name, i, "name"), fmt::format("the name \"{}\" is taken already", label));
}

/// A list of vectors with one component per direction.
void check_rows(const std::vector<std::vector<double>>& rows, const std::string& path,
                const Context& context) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (static_cast<int>(rows[i].size()) != context.dimension)
      context.fail_at(fmt::format("{}[{}]", path, i),
                      fmt::format("expected {} numbers, found {}", context.dimension, rows[i].size()));
}

/// Letters x, y, z as directions.
int direction(const std::string& letter, int dim, const std::string& path, const Context& context) {
  const std::string valid = dim == 2 ? "xy" : "xyz";
  const auto d = letter.size() == 1 ? valid.find(letter) : std::string::npos;
  if (d == std::string::npos)
    context.fail_at(path, fmt::format("expected {}, found \"{}\"",
                                      dim == 2 ? "\"x\" or \"y\"" : "\"x\", \"y\" or \"z\"", letter));
  return static_cast<int>(d);
}

void check_body_name(const Case& c, const std::string& body, const std::string& path,
                     const Context& context) {
  std::vector<std::string> names;
  for (const auto& b : c.bodies) names.push_back(b.label);
  if (std::find(names.begin(), names.end(), body) == names.end())
    context.fail_at(path, fmt::format("there is no body \"{}\"{}", body, suggestion(body, names)));
}

template <int dim>
std::string text(const Vec<dim>& x) {
  return dim == 2 ? fmt::format("({}, {})", x[0], x[1]) : fmt::format("({}, {}, {})", x[0], x[1], x[dim - 1]);
}

template <int dim>
class Checks {
 public:
  Checks(const Case& c, const Context& context) : case_(c), context_(context) {
    if (const auto* lines = std::get_if<StructuredGridOptions>(&c.grid))
      grid_ = make_grid(*lines, context);
    else
      triangulate();
  }

  void all() {
    basis();
    bodies();
    boundaries();
    placement();
    loads();
    stabilisation();
    stages();
    output();
  }

 private:
  void triangulate() {
    if constexpr (dim == 2) {
      space_ = located(context_, "grid", [&] {
        const auto mesh = std::make_shared<const Triangulation>(
            make_triangulation(*triangulation_of(case_.grid), context_.file().folder));
        return located(context_, "basis", [&] { return std::make_unique<Space<2>>(mesh, case_.basis); });
      });
    } else {
      context_.fail_at("grid.type", "grids of triangles are for 2D; in 3D use a structured grid");
    }
  }
  Vec<dim> lower() const {
    if constexpr (dim == 2)
      if (space_) return space_->triangulation().lower();
    return grid_->lower();
  }
  Vec<dim> upper() const {
    if constexpr (dim == 2)
      if (space_) return space_->triangulation().upper();
    return grid_->upper();
  }

  static StructuredGrid<dim> make_grid(const StructuredGridOptions& g, const Context& context) {
    const bool corners = !g.lower.empty() || !g.upper.empty() || !g.cells.empty();
    if (corners && !g.coordinates.empty())
      context.fail_at("grid.coordinates", "give either lower, upper and cells, or coordinates");
    if (!corners && g.coordinates.empty())
      context.fail_at("grid", "expected lower, upper and cells, or coordinates");
    if (corners && (g.lower.empty() || g.upper.empty() || g.cells.empty()))
      context.fail_at("grid", fmt::format("missing key '{}': lower, upper and cells go together",
                                          g.lower.empty() ? "lower" : (g.upper.empty() ? "upper" : "cells")));
    for (std::size_t d = 0; corners && d < dim; ++d)
      if (!(g.lower[d] < g.upper[d]))
        context.fail_at(fmt::format("grid.upper[{}]", d),
                        fmt::format("expected more than lower, {} m, found {} m", g.lower[d], g.upper[d]));
    for (std::size_t d = 0; d < g.coordinates.size(); ++d) check_lines(g.coordinates[d], d, context);
    return located(context, "grid", [&] { return StructuredGrid<dim>(g); });
  }

  static void check_lines(const std::vector<double>& lines, std::size_t d, const Context& context) {
    const std::string path = fmt::format("grid.coordinates[{}]", d);
    if (lines.size() < 2)
      context.fail_at(path, fmt::format("expected at least 2 grid lines, found {}", lines.size()));
    for (std::size_t i = 1; i < lines.size(); ++i)
      if (!(lines[i - 1] < lines[i]))
        context.fail_at(fmt::format("{}[{}]", path, i),
                        fmt::format("grid lines must increase: {} follows {}", lines[i], lines[i - 1]));
  }

  void basis() {
    const bool structured = std::holds_alternative<LinearOptions>(case_.basis) ||
                            std::holds_alternative<GimpOptions>(case_.basis);
    const auto* const splines = std::get_if<BSplineOptions>(&case_.basis);
    if (grid_ && !structured && !splines)
      context_.fail_at(
          "basis.type",
          "this basis needs a grid of triangles; structured grids have linear, gimp and b-spline");
    if (dim == 3 && splines && splines->degree > 3)
      context_.fail_at("basis.degree", fmt::format("expected at most 3 in 3D, found {}", splines->degree));
  }

  void bodies() {
    check_unique(case_.bodies, "body", context_);
    for (std::size_t i = 0; i < case_.bodies.size(); ++i) {
      shape(case_.bodies[i], i);
      sampling(case_.bodies[i], i);
      initial_state(case_.bodies[i], i);
    }
  }

  void shape(const BodyOptions& body, std::size_t i) {
    const std::string path = place("body", i, "shape");
    const Block<dim> box = located(context_, path, [&] {
      if constexpr (dim == 2)
        if (const auto* mesh = std::get_if<MeshShape>(&body.shape); mesh && space_) {
          const Triangulation triangles = read_gmsh(context_.file().folder / mesh->file, mesh->scale);
          if (!mesh->surface.empty()) triangles.part(mesh->surface);
          return Block<2>{triangles.lower(), triangles.upper()};
        }
      if (const auto* points = std::get_if<PointFile>(&body.shape))
        return bounds<dim>(read_points<dim>(*points, context_.file().folder));
      return bounds(region<dim>(body.shape, context_.file().folder));
    });
    const double slack = 1e-9 * (upper() - lower()).minCoeff();
    for (int d = 0; d < dim; ++d)
      if (box.lower[d] < lower()[d] - slack || box.upper[d] > upper()[d] + slack)
        context_.fail_at(
            path, fmt::format("body \"{}\" reaches from {} to {} m, outside of the grid from {} to {} m",
                              body.label, text<dim>(box.lower), text<dim>(box.upper), text<dim>(lower()),
                              text<dim>(upper())));
  }

  /// Points that are cut on triangles.
  void on_triangles(const BodyOptions& body, const std::string& path) {
    const Sampling& s = body.sampling;
    if (s.method != SamplingMethod::cells && s.method != SamplingMethod::gauss)
      context_.fail_at(path, "points on triangles are cut with method \"cells\" or \"gauss\" only");
    if (s.volumes == PointVolumes::voronoi)
      context_.fail_at(path + ".volumes", "cut points have what the cut leaves: give volumes = \"share\"");
    if (std::holds_alternative<MeshShape>(body.shape))
      context_.fail_at(path, "the triangles of a mesh are not cut; give a polygon");
  }

  void sampling(const BodyOptions& body, std::size_t i) {
    const std::string path = place("body", i, "sampling");
    for (const char* sampled : {"method", "points_per_cell", "divisions", "clip", "cuts"})
      if (std::holds_alternative<PointFile>(body.shape) && context_.given(path + "." + sampled))
        context_.fail_at(path, "the points come from a file: there is nothing to sample");
    const bool triangles = !std::holds_alternative<StructuredGridOptions>(case_.grid);
    if (!triangles && body.sampling.method == SamplingMethod::random)
      context_.fail_at(path + ".method", "random points need a grid of triangles");
    if (!triangles && body.sampling.volumes == PointVolumes::voronoi)
      context_.fail_at(path + ".volumes", "Voronoi volumes need a grid of triangles");
    const bool cut = body.sampling.clip || !body.sampling.cuts.empty();
    if (cut && std::holds_alternative<Ball>(body.shape))
      context_.fail_at(
          path, "points cannot be cut at a ball; give a polygon (2D) or an STL file (3D), or clip = false");
    if (cut && triangles) on_triangles(body, path);
    for (std::size_t k = 0; k < body.sampling.cuts.size(); ++k)
      if (body.sampling.cuts[k].size() != 2 * dim)
        context_.fail_at(fmt::format("{}.cuts[{}]", path, k),
                         fmt::format("expected {} numbers (a point and a normal), found {}", 2 * dim,
                                     body.sampling.cuts[k].size()));
    const bool divided = body.sampling.method == SamplingMethod::divisions;
    if (divided && body.sampling.divisions.empty())
      context_.fail_at(path, "method \"divisions\" needs the key 'divisions'");
    if (!divided && !body.sampling.divisions.empty())
      context_.fail_at(path + ".divisions", "only for method = \"divisions\"");
    if (divided && context_.given(path + ".points_per_cell"))
      context_.fail_at(path + ".points_per_cell", "not for method = \"divisions\"");
  }

  void initial_state(const BodyOptions& body, std::size_t i) {
    if (!body.velocity_gradient.empty())
      check_rows(body.velocity_gradient, place("body", i, "velocity_gradient"), context_);
    if (!body.velocity_centre.empty() && body.velocity_gradient.empty())
      context_.fail_at(place("body", i, "velocity_centre"), "has no meaning without velocity_gradient");
    constexpr int components = dim == 2 ? 4 : 6;
    if (!body.initial_stress.empty() && static_cast<int>(body.initial_stress.size()) != components)
      context_.fail_at(
          place("body", i, "initial_stress"),
          fmt::format("expected {} numbers ({}), found {}", components,
                      dim == 2 ? "xx, yy, zz, xy" : "xx, yy, zz, xy, yz, zx", body.initial_stress.size()));
    if (!body.initial_stress.empty() && body.k0)
      context_.fail_at(place("body", i, "k0"), "give either initial_stress or k0");
  }

  /// Index of the grid line at x in direction d; error if there is none.
  void check_line(int d, double x, const std::string& path) {
    double best = std::numeric_limits<double>::infinity(), nearest_line = 0.0;
    for (int i = 0; i <= grid_->cells(d); ++i)
      if (const double gap = std::abs(grid_->line(d, i) - x); gap < best) {
        best = gap;
        nearest_line = grid_->line(d, i);
      }
    if (best > 1e-6 * grid_->shortest_side())
      context_.fail_at(
          path, fmt::format("{} = {} m is not a grid line; the nearest is {} m", "xyz"[d], x, nearest_line));
  }

  void boundaries() {
    check_unique(case_.boundaries, "boundary", context_);
    for (std::size_t i = 0; i < case_.boundaries.size(); ++i)
      std::visit([&](const auto& b) { boundary(b, i); }, case_.boundaries[i]);
  }

  /// Boundaries without rules across their keys.
  template <class Boundary>
  void boundary(const Boundary&, std::size_t) const {}

  void boundary(const ConformingOptions& b, std::size_t i) {
    const auto at = [&](std::string_view key) { return place("boundary", i, key); };
    if (b.normal.empty() + b.node.empty() + b.part.empty() != 2)
      context_.fail_at(
          at(b.normal.empty() ? "" : "node"),
          "give either normal and at (a grid line or plane), or node, or part (of a triangulation)");
    if (!b.normal.empty() && !context_.given(at("at")))
      context_.fail_at(at(""), "missing key 'at' (m): coordinate along 'normal'");
    if (space_) {
      if constexpr (dim == 2)
        located(context_, at(b.part.empty() ? "" : "part"), [&] { return Conforming<2>(b, *space_); });
    } else if (!b.part.empty()) {
      context_.fail_at(at("part"), "only grids of triangles have named boundaries");
    } else if (!b.normal.empty()) {
      const int d = direction(b.normal, dim, at("normal"), context_);
      check_line(d, b.at, at("at"));
    } else {
      if (context_.given(at("at"))) context_.fail_at(at("at"), "not together with node");
      for (int d = 0; d < dim; ++d)
        check_line(d, b.node[static_cast<std::size_t>(d)], fmt::format("{}[{}]", at("node"), d));
      if (!b.lower.empty() || !b.upper.empty())
        context_.fail_at(at(b.lower.empty() ? "upper" : "lower"), "not together with node");
    }
    std::set<int> seen;
    for (std::size_t k = 0; k < b.directions.size(); ++k) {
      const std::string path = fmt::format("{}[{}]", at("directions"), k);
      if (!seen.insert(direction(b.directions[k], dim, path, context_)).second)
        context_.fail_at(path, fmt::format("\"{}\" is listed twice", b.directions[k]));
    }
    for (std::size_t d = 0; !b.lower.empty() && !b.upper.empty() && d < dim; ++d)
      if (b.lower[d] > b.upper[d])
        context_.fail_at(fmt::format("{}[{}]", at("upper"), d),
                         fmt::format("expected at least lower, {} m, found {} m", b.lower[d], b.upper[d]));
    if (b.displacement && b.velocity)
      context_.fail_at(at("velocity"), "give either displacement or velocity");
  }

  void boundary(const WallOptions& w, std::size_t i) {
    const auto at = [&](std::string_view key) { return place("boundary", i, key); };
    if (!w.displacement.empty() && !w.velocity.empty())
      context_.fail_at(at("velocity"), "give either displacement or velocity");
    located(context_, place("boundary", i, "shape"), [&] {
      check_in_grid<dim>(w, {lower(), upper()}, context_.file().folder);
      return true;
    });
    walls_.push_back(w);
    if (w.friction > 0.0 && w.kind != WallKind::roller)
      context_.fail_at(at("friction"), "only for kind = \"roller\"");
  }

  /// No body lies wholly on the wrong side of the walls, or reaches past the triangles.
  void placement() {
    const auto& folder = context_.file().folder;
    if (walls_.empty() && !space_) return;
    for (std::size_t i = 0; i < case_.bodies.size(); ++i)
      located(context_, place("body", i, "shape"), [&] {
        const auto inside = points_inside<dim>(case_.bodies[i], folder);
        if constexpr (dim == 2)
          if (space_) check_on_triangles(case_.bodies[i], inside, space_->triangulation());
        check_beside_walls<dim>(case_.bodies[i], inside, walls_, grid_ ? grid_->shortest_side() : 0.0,
                                folder);
        return true;
      });
  }

  void loads() {
    check_unique(case_.loads, "load", context_);
    for (std::size_t i = 0; i < case_.loads.size(); ++i)
      std::visit(
          [&](const auto& load) {
            if constexpr (requires { load.body; })
              check_body_name(case_, load.body, place("load", i, "body"), context_);
            check_load(load, i);
          },
          case_.loads[i]);
  }

  /// Loads without rules across their keys.
  template <class Load>
  void check_load(const Load&, std::size_t) const {}

  void check_load(const PointLoadOptions& load, std::size_t i) {
    check_rows(load.nearest, place("load", i, "nearest"), context_);
  }

  void check_load(const TractionOptions& t, std::size_t i) {
    const auto at = [&](std::string_view key) { return place("load", i, key); };
    if (t.edges.size() != dim - 1)
      context_.fail_at(at("edges"),
                       fmt::format("expected {}, found {}", dim == 2 ? "one edge vector" : "two edge vectors",
                                   t.edges.size()));
    check_rows(t.edges, at("edges"), context_);
    if (t.points.size() != t.edges.size())
      context_.fail_at(at("points"), fmt::format("expected {} (one for each edge), found {}", t.edges.size(),
                                                 t.points.size()));
    if (!has_area(t.edges)) context_.fail_at(at("edges"), "the edges span no area");
    if (t.traction.empty() == !t.pressure)
      context_.fail_at(at(t.pressure ? "pressure" : ""), "give either traction or pressure");
    if (t.pressure && context_.given(at("factor")))
      context_.fail_at(at("factor"), "is for traction; give the pressure itself in time");
  }

  static bool has_area(const std::vector<std::vector<double>>& edges) {
    if constexpr (dim == 2) {
      return std::hypot(edges[0][0], edges[0][1]) > 0.0;
    } else {
      const Eigen::Map<const Vec<3>> a(edges[0].data()), b(edges[1].data());
      const Vec<3> n(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
      return n.norm() > 1e-12 * a.norm() * b.norm();
    }
  }

  void stabilisation() {
    if (!case_.stabilisation) return;
    if (context_.given("stabilisation.scale") && case_.stabilisation->units != GhostUnits::paper)
      context_.fail_at("stabilisation.scale", "only for units = \"paper\"");
    const auto without = [](const AnyStage& stage) {
      const auto* e = std::get_if<ExplicitOptions>(&stage);
      return e && e->mass != Mass::consistent;
    };
    if (std::all_of(case_.stages.begin(), case_.stages.end(), without))
      context_.fail_at("stabilisation", "no stage uses it: explicit stages do with mass = \"consistent\"");
  }

  void stages() {
    for (std::size_t i = 0; i < case_.stages.size(); ++i) {
      if (const auto* e = std::get_if<ExplicitOptions>(&case_.stages[i]))
        explicit_stage(*e, i);
      else if (std::holds_alternative<QuasiStaticOptions>(case_.stages[i]))
        static_stage(i);
      else
        need_density(i, "implicit dynamics");
    }
  }

  void need_density(std::size_t stage, std::string_view what) {
    for (std::size_t b = 0; b < case_.bodies.size(); ++b)
      if (!(density(case_.bodies[b].material) > 0.0))
        context_.fail_at(place("body", b, "material.density"),
                         fmt::format("expected a number > 0 kg/m3: stage {} is {}", stage + 1, what));
  }

  void explicit_stage(const ExplicitOptions& e, std::size_t i) {
    need_density(i, "explicit");
    const auto at = [&](std::string_view key) { return place("stage", i, key); };
    const char* first = e.steps ? "steps" : (e.dt ? "dt" : nullptr);
    if (e.steps && e.dt) context_.fail_at(at("dt"), "give either steps, dt or cfl");
    if (first && context_.given(at("cfl")))
      context_.fail_at(at("cfl"), fmt::format("give either steps, dt or cfl; {} is given", first));
    if (e.dt && *e.dt > e.duration)
      context_.fail_at(at("dt"),
                       fmt::format("expected at most the duration, {} s, found {} s", e.duration, *e.dt));
    if (context_.given(at("fmpm_order")) && e.mass != Mass::fmpm)
      context_.fail_at(at("fmpm_order"), "only for mass = \"fmpm\"");
    if (e.deactivate_below > 0 && e.mass == Mass::lumped)
      context_.fail_at(at("deactivate_below"), "a lumped mass needs none; for the other masses only");
    if (e.integration != Integration::points && std::holds_alternative<GimpOptions>(case_.basis))
      context_.fail_at(at("integration"), "reconstruction needs points without domains, not basis 'gimp'");
    if (e.integration == Integration::reconstructed_mass &&
        (e.mass != Mass::consistent || e.velocity_update != VelocityUpdate::flip || e.pic_fraction > 0))
      context_.fail_at(at("integration"),
                       "\"reconstructed-mass\" needs mass = \"consistent\" and a FLIP update without PIC");
    if (context_.given(at("pic_fraction")) && e.velocity_update != VelocityUpdate::flip)
      context_.fail_at(at("pic_fraction"), "only for velocity_update = \"flip\"");
    if (e.updated_gradients && e.stress_update != StressUpdate::usf)
      context_.fail_at(at("updated_gradients"), "only for stress_update = \"usf\"");
    const auto is_wall = [](const AnyBoundaryOptions& b) { return std::holds_alternative<WallOptions>(b); };
    const bool walls = std::any_of(case_.boundaries.begin(), case_.boundaries.end(), is_wall);
    if (e.integration == Integration::reconstructed_mass && walls)
      context_.fail_at(at("integration"),
                       "\"reconstructed-mass\" has no walls: their rows use the points' mass");
    if (e.damping > 0 && walls)
      context_.fail_at(at("damping"),
                       "not beside walls: it would also damp the forces that they carry; use pic_fraction");
    const auto no_waves = [](const BodyOptions& b) { return !(p_wave_modulus(b.material) > 0.0); };
    if (!first && std::all_of(case_.bodies.begin(), case_.bodies.end(), no_waves))
      context_.fail_at(
          at("dt"), "the wave speed of every body is zero, so that cfl gives no time step: give dt or steps");
  }

  void static_stage(std::size_t i) {
    if (case_.boundaries.empty())
      context_.fail_at(place("stage", i),
                       "a quasi-static stage needs at least one [[boundary]] to hold the bodies");
    for (std::size_t b = 0; b < case_.bodies.size(); ++b)
      if (!(p_wave_modulus(case_.bodies[b].material) > 0.0))
        context_.fail_at(place("body", b, "material.young_modulus"),
                         fmt::format("expected a number > 0 Pa: stage {} is quasi-static", i + 1));
  }

  void output() {
    check_unique(case_.output.track, "output.track", context_);
    for (std::size_t i = 0; i < case_.output.track.size(); ++i)
      check_body_name(case_, case_.output.track[i].body, place("output.track", i, "body"), context_);
  }

  const Case& case_;
  const Context& context_;
  std::vector<WallOptions> walls_;
  std::optional<StructuredGrid<dim>> grid_;  ///< or
  std::unique_ptr<Space<2>> space_;          ///< a triangulation with its basis
};

}  // namespace

void check_case(const Case& c, const Context& context) {
  if (c.dimension == 2)
    Checks<2>(c, context).all();
  else
    Checks<3>(c, context).all();
}

}  // namespace wisp
