#include "io/output.h"

#include <cmath>
#include <limits>

#include "boundary/on_body.h"
#include "grid/structured.h"
#include "grid/triangulate.h"

namespace wisp {
namespace {

/// A field of one entry a point over all bodies; `f(body, p, out)` writes `components` numbers.
template <int dim, class F>
VtuField field(const Model<dim>& model, std::string name, int components, std::string unit, F&& f) {
  std::vector<double> values;
  std::vector<double> one(static_cast<std::size_t>(components));
  for (const auto& body : model.bodies)
    for (std::size_t p = 0; p < body.points.position.size(); ++p) {
      f(body, p, one.data());
      values.insert(values.end(), one.begin(), one.end());
    }
  return {std::move(name), components, std::move(values), std::move(unit), {}};
}

/// Vectors have three components, as VTK expects of them.
template <int dim, class Get>
VtuField vector_field(const Model<dim>& model, std::string name, std::string unit, Get&& get) {
  return field(model, std::move(name), 3, std::move(unit),
               [&](const Body<dim>& body, std::size_t p, double* out) {
                 std::fill(out, out + 3, 0.0);
                 const Vec<dim>& v = get(body.points)[p];
                 std::copy(v.data(), v.data() + dim, out);
               });
}

template <class F>
VtuField integer_field(std::string name, std::size_t n, F&& fill) {
  std::vector<std::int64_t> values;
  values.reserve(n);
  fill(values);
  return {std::move(name), 1, std::move(values), {}, {}};
}

/// Fields that come out of the material states.
template <int dim>
void add_state_fields(const Model<dim>& model, std::size_t n, std::vector<VtuField>& fields) {
  constexpr int components = sym_size<dim>;
  std::vector<double> stress, plastic;
  stress.reserve(n * components), plastic.reserve(n);
  for (const auto& body : model.bodies) {
    const bool finite = body.finite_strain();
    for_each_state(body, [&](int p, const auto& law, const auto& state) {
      const double J =
          finite ? body.points.deformation_gradient[static_cast<std::size_t>(p)].determinant() : 1.0;
      for (int a = 0; a < components; ++a) stress.push_back(state.stress[a] / J);
      plastic.push_back(law.template plastic_strain<dim>(state));
    });
  }
  std::vector<std::string> names{"xx", "yy", "zz", "xy", "yz", "zx"};
  names.resize(components);
  fields.push_back({"stress", components, std::move(stress), "Pa", std::move(names)});
  fields.push_back({"plastic_strain", 1, std::move(plastic), "-", {}});
}

}  // namespace

template <int dim>
VtuPoints picture(const Model<dim>& model) {
  using P = Particles<dim>;
  std::size_t n = 0;
  for (const auto& body : model.bodies) n += body.points.position.size();
  const std::string per_thickness = dim == 2 ? "/m" : "";
  VtuPoints result;
  result.positions =
      std::get<std::vector<double>>(vector_field(
                                        model, "", "", [](const P& p) -> const auto& { return p.position; })
                                        .values);
  auto& fields = result.fields;
  fields.push_back(integer_field("id", n, [&](auto& values) {
    for (const auto& body : model.bodies)
      values.insert(values.end(), body.points.id.begin(), body.points.id.end());
  }));
  fields.push_back(integer_field("body", n, [&](auto& values) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      values.insert(values.end(), model.bodies[b].points.position.size(), static_cast<std::int64_t>(b));
  }));
  fields.push_back(vector_field(
      model, "displacement", "m", [](const P& p) -> const auto& { return p.displacement; }));
  fields.push_back(vector_field(
      model, "velocity", "m/s", [](const P& p) -> const auto& { return p.velocity; }));
  add_state_fields(model, n, fields);
  fields.push_back(field(model, "mass", 1, "kg" + per_thickness,
                         [](const auto& body, std::size_t p, double* out) { *out = body.points.mass[p]; }));
  fields.push_back(
      field(model, "volume", 1, dim == 2 ? "m^2" : "m^3", [](const auto& body, std::size_t p, double* out) {
        *out = body.points.volume[p] * body.points.deformation_gradient[p].determinant();
      }));
  if (model.space->domains()) {
    fields.push_back(vector_field(
        model, "half_lengths", "m", [](const P& p) -> const auto& { return p.half_length; }));
    fields.push_back(vector_field(
        model, "initial_half_lengths", "m", [](const P& p) -> const auto& { return p.initial_half_length; }));
  } else {
    fields.push_back(
        field(model, "initial_volume", 1, dim == 2 ? "m^2" : "m^3",
              [](const auto& body, std::size_t p, double* out) { *out = body.points.volume[p]; }));
  }
  fields.push_back(
      field(model, "deformation_gradient", dim * dim, "-", [](const auto& body, std::size_t p, double* out) {
        const Mat<dim>& F = body.points.deformation_gradient[p];
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) out[i * dim + j] = F(i, j);
      }));
  result.globals.push_back({"TimeValue", 1, std::vector<double>{model.time}, "s", {}});
  result.globals.push_back({"step", 1, std::vector<std::int64_t>{model.step}, {}, {}});
  return result;
}

namespace {

std::string json_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      out += c;
  }
  return out + "\"";
}

template <int dim>
std::string lines_json(const StructuredGridOptions& options) {
  const StructuredGrid<dim> grid(options);
  std::string text = "{\"coordinates\": [";
  for (int d = 0; d < dim; ++d) {
    text += d ? ",\n  [" : "\n  [";
    for (int i = 0; i <= grid.cells(d); ++i) text += fmt::format("{}{}", i ? ", " : "", grid.line(d, i));
    text += "]";
  }
  return text + "]}";
}

std::string triangles_json(const Triangulation& mesh) {
  std::string text = "{\"points\": [";
  for (int v = 0; v < mesh.n_vertices(); ++v)
    text += fmt::format("{}[{}, {}]", v ? ", " : "", mesh.vertex(v).x(), mesh.vertex(v).y());
  text += "],\n  \"cells\": [";
  for (int t = 0; t < mesh.n_triangles(); ++t)
    text += fmt::format("{}[{}, {}, {}]", t ? ", " : "", mesh.triangle(t)[0], mesh.triangle(t)[1],
                        mesh.triangle(t)[2]);
  return text + "]}";
}

std::string grid_json(const Case& c) {
  if (const auto triangulation = triangulation_of(c.grid))
    return triangles_json(make_triangulation(*triangulation, c.file.folder));
  const auto& lines = std::get<StructuredGridOptions>(c.grid);
  return c.dimension == 2 ? lines_json<2>(lines) : lines_json<3>(lines);
}

std::string numbers_json(std::span<const double> values) {
  std::string text = "[";
  for (std::size_t k = 0; k < values.size(); ++k) text += fmt::format("{}{}", k > 0 ? ", " : "", values[k]);
  return text + "]";
}

std::string curve_json(const Curve& curve) {
  return fmt::format("[{}, {}]", numbers_json(curve.times), numbers_json(curve.values));
}

/// Lines of walls at rest, and of each wall that moves also its motion as the case gives it.
struct WallsJson {
  std::string at_rest, moving;
};

/// A motion: curves are [times, values].
std::string motion_json(const RigidMotionOptions& motion) {
  std::string text;
  const auto add = [&](const char* key, const std::string& value) {
    text += fmt::format("{}\"{}\": {}", text.empty() ? "{" : ", ", key, value);
  };
  const auto curves = [&](const char* key, const std::vector<Curve>& list) {
    std::string all;
    for (const Curve& c : list) all += (all.empty() ? "[" : ", ") + curve_json(c);
    if (!list.empty()) add(key, all + "]");
  };
  curves("displacement", motion.displacement);
  curves("velocity", motion.velocity);
  if (motion.rotation) add("rotation", curve_json(*motion.rotation));
  if (motion.angular_velocity) add("angular_velocity", curve_json(*motion.angular_velocity));
  if (!motion.centre.empty()) add("centre", numbers_json(motion.centre));
  if (!motion.axis.empty()) add("axis", numbers_json(motion.axis));
  return text.empty() ? "{}" : text + "}";
}

template <int dim>
std::string lines_of(const Wall<dim>& wall, double length, const Block<dim>& box) {
  std::string text;
  for (const auto& piece : wall.shape().pieces(length, box)) {
    text += text.empty() ? "[" : ",\n  [";
    for (std::size_t k = 0; k < dim; ++k)
      text += (k > 0 ? ", " : "") + numbers_json({piece.vertex[k].data(), dim});
    text += "]";
  }
  return text;
}

template <int dim>
WallsJson walls_json(const Case& c) {
  double length;
  Block<dim> box;
  if (const auto* lines = std::get_if<StructuredGridOptions>(&c.grid)) {
    const StructuredGrid<dim> grid(*lines);
    length = grid.shortest_side(), box = {grid.lower(), grid.upper()};
  } else if constexpr (dim == 2) {
    const Triangulation mesh = make_triangulation(*triangulation_of(c.grid), c.file.folder);
    length = mesh.shortest_height(), box = {mesh.lower(), mesh.upper()};
  } else {
    return {};
  }
  WallsJson text;
  for (const auto& boundary : c.boundaries) {
    const auto* o = std::get_if<WallOptions>(&boundary);
    if (!o) continue;
    const std::string lines = lines_of(Wall<dim>(*o, c.file.folder), length, box);
    if (lines.empty()) continue;
    std::string& list = o->motion ? text.moving : text.at_rest;
    list += list.empty() ? "" : ",\n  ";
    list += o->motion ? fmt::format("{{\"lines\": [{}],\n   \"motion\": {}}}", lines, motion_json(*o->motion))
                      : lines;
  }
  return text;
}

}  // namespace

std::string scene_json(const Case& c) {
  const WallsJson walls = c.dimension == 2 ? walls_json<2>(c) : walls_json<3>(c);
  return fmt::format("{{\"title\": {},\n \"grid\": {},\n \"walls\": [{}],\n \"moving walls\": [{}]}}\n",
                     json_text(c.title), grid_json(c), walls.at_rest, walls.moving);
}

VtuCells grid_cells(const Triangulation& mesh) {
  VtuCells cells;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    cells.positions.insert(cells.positions.end(), {mesh.vertex(v).x(), mesh.vertex(v).y(), 0.0});
  std::vector<double> areas;
  for (int t = 0; t < mesh.n_triangles(); ++t) {
    for (const int v : mesh.triangle(t)) cells.connectivity.push_back(v);
    cells.offsets.push_back(static_cast<std::int64_t>(cells.connectivity.size()));
    cells.types.push_back(VtuCell::triangle);
    areas.push_back(mesh.area(t));
  }
  cells.cell_fields.push_back({"area", 1, std::move(areas), "m^2", {}});
  for (const auto& part : mesh.parts()) {
    if (part.vertices.empty()) continue;
    std::vector<std::int64_t> on_part(static_cast<std::size_t>(mesh.n_vertices()), 0);
    for (const int v : part.vertices) on_part[static_cast<std::size_t>(v)] = 1;
    cells.point_fields.push_back({part.name, 1, std::move(on_part), {}, {}});
  }
  return cells;
}

template <int dim>
HistoryColumns<dim>::HistoryColumns(const Case& c, const Model<dim>& model) : output_(c.output) {
  const std::string per = dim == 2 ? "/m" : "";
  titles_ = {"stage", "dt [s]"};
  if (output_.energies)
    for (const char* name :
         {"kinetic energy", "strain energy", "dissipation", "external work", "total energy", "balance error"})
      titles_.push_back(fmt::format("{} [J{}]", name, per));
  // Names are free text; commas and quotes would break the table.
  const auto plain = [](std::string name) {
    for (char& letter : name)
      if (letter == ',' || letter == '"' || letter == '\n' || letter == '\r') letter = ' ';
    return name;
  };
  held_.resize(model.boundaries.size());
  for (std::size_t k = 0; k < model.boundaries.size() && output_.reactions; ++k)
    for (int d = 0; d < dim; ++d) {
      if (!holds(model.boundaries[k], d)) continue;
      held_[k].push_back(d);
      titles_.push_back(fmt::format("reaction {} {} [N{}]", plain(name(model.boundaries[k])), "xyz"[d], per));
    }
  for_each<Wall, dim>(model.boundaries, [&](const Wall<dim>& wall, std::size_t k) {
    if (!output_.reactions) return;
    walls_.push_back(k);
    for (const char axis : std::string(dim == 2 ? "z" : "xyz"))
      titles_.push_back(fmt::format("moment {} {} [{}]", plain(wall.name()), axis, dim == 2 ? "N" : "N m"));
  });
  for (const auto& track : output_.track)
    for (const auto& [what, unit] : {std::pair{"position", "m"}, {"displacement", "m"}, {"velocity", "m/s"}})
      for (int d = 0; d < dim; ++d)
        titles_.push_back(fmt::format("{} {} {} [{}]", plain(track.label), what, "xyz"[d], unit));
  for (const auto& stage : c.stages) newton_ |= !std::holds_alternative<ExplicitOptions>(stage);
  if (newton_) titles_.insert(titles_.end(), {"iterations", "residual", "cuts"});
  if (output_.condition_numbers) titles_.emplace_back("condition number [-]");
  if (output_.critical_time_step) titles_.emplace_back("critical time step [s]");
  removal_ = leaving(c.grid) == Leaving::remove;
  if (removal_) titles_.emplace_back("points removed");
}

template <int dim>
std::vector<double> HistoryColumns<dim>::values(const Row<dim>& row, const Model<dim>& model) const {
  std::vector<double> v{static_cast<double>(row.stage), row.dt};
  if (output_.energies) {
    const EnergyRecord& e = row.energy;
    const double total = e.kinetic + e.strain + e.dissipation;
    v.insert(v.end(), {e.kinetic, e.strain, e.dissipation, e.external_work, total,
                       total - row.first_energy - e.external_work});
  }
  for (std::size_t k = 0; k < held_.size(); ++k)
    for (const int d : held_[k]) v.push_back(row.reactions[k][d]);
  for (const std::size_t k : walls_)
    v.insert(v.end(), model.moments[k].data(), model.moments[k].data() + model.moments[k].size());
  for (const auto& track : row.tracked) v.insert(v.end(), track.data(), track.data() + dim);
  if (newton_) {
    const bool iterated = row.newton && !row.newton->residuals.empty();
    v.push_back(row.newton ? row.newton->iterations : 0);
    v.push_back(iterated ? row.newton->residuals.back() : 0.0);
    v.push_back(row.newton ? row.newton->cuts : 0);
  }
  if (output_.condition_numbers) v.push_back(row.condition);
  if (output_.critical_time_step) v.push_back(row.critical_time_step);
  if (removal_) v.push_back(static_cast<double>(model.removed));
  return v;
}

template <int dim>
Tracked<dim>::Tracked(const std::vector<TrackOptions>& options, const Model<dim>& model) {
  for (const auto& track : options) {
    const std::size_t body = body_index(model.bodies, track.body, "track '" + track.label + "'");
    points_.push_back(
        {body, nearest_point<dim>(model.bodies[body], Eigen::Map<const Vec<dim>>(track.nearest.data()))});
  }
}

template <int dim>
std::vector<Vec<dim>> Tracked<dim>::now(const Model<dim>& model) {
  constexpr std::size_t stride = 3 * dim + 1;
  std::vector<double> all(points_.size() * stride, 0.0);
  for (std::size_t k = 0; k < points_.size(); ++k) {
    auto& [body, id, place] = points_[k];
    const auto& points = model.bodies[body].points;
    if (place >= points.id.size() || points.id[place] != id)
      place = static_cast<std::size_t>(std::find(points.id.begin(), points.id.end(), id) - points.id.begin());
    if (place == points.id.size()) continue;
    double* out = all.data() + k * stride;
    for (const auto* v : {&points.position[place], &points.displacement[place], &points.velocity[place]})
      out = std::copy(v->data(), v->data() + dim, out);
    *out = 1.0;
  }
  if (!all.empty()) Session::sum_in_place(all);
  std::vector<Vec<dim>> result;
  for (std::size_t k = 0; k < points_.size(); ++k)
    for (std::size_t q = 0; q < 3; ++q)
      result.push_back(all[k * stride + 3 * dim] > 0
                           ? Vec<dim>(Eigen::Map<const Vec<dim>>(all.data() + k * stride + q * dim))
                           : Vec<dim>(Vec<dim>::Constant(std::numeric_limits<double>::quiet_NaN())));
  return result;
}

template VtuPoints picture<2>(const Model<2>&);
template VtuPoints picture<3>(const Model<3>&);
template class HistoryColumns<2>;
template class HistoryColumns<3>;
template class Tracked<2>;
template class Tracked<3>;

}  // namespace wisp
