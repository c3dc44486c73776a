// The same runs on one and on several ranks. On one rank the program writes every point's state to the file
// named by its argument; on several it compares with that file. Exit status 1 where they differ.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "analysis/fixtures.h"
#include "core/error.h"

namespace wisp {
namespace {

using namespace analysis_test;

struct Record {
  double id = 0.0;
  double values[18] = {};  // position, velocity, displacement, stress, half-length
};

/// All points of a model by id, on rank 0.
template <int dim>
std::vector<Record> records(const Model<dim>& model) {
  std::vector<Record> list;
  for_each_point(model, [&](const auto& body, std::size_t p) {
    Record r;
    r.id = static_cast<double>(body.points.id[p]);
    for (int d = 0; d < dim; ++d) {
      r.values[d] = body.points.position[p][d], r.values[3 + d] = body.points.velocity[p][d];
      r.values[6 + d] = body.points.displacement[p][d];
      if (!body.points.half_length.empty()) r.values[15 + d] = body.points.half_length[p][d];
    }
    const Sym<dim> s = stress_of(body, p);
    for (int a = 0; a < sym_size<dim>; ++a) r.values[9 + a] = s[a];
    list.push_back(r);
  });
  list = Session::gather(list);
  std::sort(list.begin(), list.end(), [](const Record& a, const Record& b) { return a.id < b.id; });
  return list;
}

/// Reactions, work and counts of a model behind its points, as one more record.
template <int dim>
Record totals(const Model<dim>& model) {
  Record r;
  r.id = -1.0;
  r.values[0] = static_cast<double>(model.n_points()), r.values[3] = static_cast<double>(model.removed);
  r.values[6] = model.external_work;
  for (std::size_t c = 0; c < std::min<std::size_t>(2, model.reactions.size()); ++c)
    for (int d = 0; d < dim; ++d) r.values[(c == 0 ? 9 : 15) + d] = model.reactions[c][d];
  return r;
}

template <int dim>
std::set<std::int64_t> ids(const Model<dim>& model) {
  std::set<std::int64_t> set;
  for_each_point(model, [&](const auto& body, std::size_t p) { set.insert(body.points.id[p]); });
  return set;
}

class Comparison {
 public:
  explicit Comparison(std::string file) : file_(std::move(file)) {}

  template <int dim>
  void add(const std::string& name, const Model<dim>& model) {
    std::vector<Record> list = records(model);
    const Record sum = totals(model);  // collective
    if (Session::rank() != 0) return;
    list.push_back(sum);
    if (Session::size() == 1) {
      std::ofstream out(file_ + "." + name, std::ios::binary);
      out.write(reinterpret_cast<const char*>(list.data()),
                static_cast<std::streamsize>(list.size() * sizeof(Record)));
      check(bool(out), name + ": the reference cannot be written");
      return;
    }
    std::vector<Record> reference(list.size());
    std::ifstream in(file_ + "." + name, std::ios::binary | std::ios::ate);
    const auto bytes = in.tellg();
    in.seekg(0);
    in.read(reinterpret_cast<char*>(reference.data()),
            static_cast<std::streamsize>(reference.size() * sizeof(Record)));
    check(in && bytes == static_cast<std::streamoff>(list.size() * sizeof(Record)),
          name + ": another number of points");
    compare(name, list, reference, 0, list.size() - 1);
    compare(name + " (totals)", list, reference, list.size() - 1, list.size());
  }
  void check(bool good, const std::string& what) {
    if (good) return;
    fmt::print(stderr, "{} ranks: {}\n", Session::size(), what);
    failed_ = true;
  }
  bool failed() const { return Session::any_of(failed_); }

 private:
  /// Fields are compared relative to their greatest value; differences count in units of 1e-10 of that.
  void compare(const std::string& name, const std::vector<Record>& ours, const std::vector<Record>& reference,
               std::size_t from, std::size_t to) {
    const char* fields[] = {"position", "velocity", "displacement", "stress", "half-length"};
    constexpr int start[] = {0, 3, 6, 9, 15, 18};
    for (int f = 0; f < 5; ++f) {
      double scale = 0.0, worst = 0.0;
      for (std::size_t p = from; p < to; ++p) {
        check(ours[p].id == reference[p].id, name + ": other ids");
        for (int k = start[f]; k < start[f + 1]; ++k) {
          scale = std::max(scale, std::abs(reference[p].values[k]));
          worst = std::max(worst, std::abs(ours[p].values[k] - reference[p].values[k]));
        }
      }
      check(worst <= 1e-10 * scale,
            fmt::format("{}: {} differs by {:.2e} of {:.2e}", name, fields[f], worst, scale));
    }
  }

  std::string file_;
  bool failed_ = false;
};

/// Two blocks that fly through the middle of the grid, where ranks meet, and collide.
template <int dim>
ModelOptions collision(bool gimp) {
  auto o = on_grid<dim>(Vec<dim>::Constant(-1.0), Vec<dim>::Constant(1.0),
                        MultiIndex<dim>::Constant(dim == 2 ? 16 : 8), gimp);
  for (const double side : {-1.0, 1.0}) {
    const Vec<dim> centre = Vec<dim>::Constant(0.32 * side);
    auto& body = add_box<dim>(o, centre - Vec<dim>::Constant(0.25), centre + Vec<dim>::Constant(0.25),
                              Hencky{1000.0, 1e4, 0.3});
    body.velocity.assign(dim, -2.0 * side), body.velocity[0] *= 1.2;
    body.velocity_gradient.assign(dim, std::vector<double>(dim, 0.0));
    body.velocity_gradient[0][1] = -1.0, body.velocity_gradient[1][0] = 1.5;
  }
  return o;
}

template <int dim>
void explicit_case(Comparison& comparison, const std::string& name, ModelOptions o, MassKind kind,
                   StressUpdate scheme, VelocityUpdate update) {
  const Mass mass = apply(kind, o);
  Model<dim> model(o);
  const auto before = ids(model);
  Explicit<dim> run(model, explicit_steps(4e-3, mass, scheme, update));
  for (int k = 0; k < 50; ++k) {
    run.step(4e-3);
    if (k == 30 && model.rebalance()) run.warm_velocity().clear(), run.warm_acceleration().clear();
  }
  int arrived = 0;
  for (const auto id : ids(model)) arrived += before.count(id) == 0;
  arrived = Session::sum(arrived);
  comparison.check(Session::size() == 1 || arrived > 0, name + ": no point has crossed ranks");
  comparison.add(name, model);
}

template <int dim>
void static_case(Comparison& comparison, const std::string& name, bool gimp, bool ghost) {
  auto o =
      on_grid<dim>(Vec<dim>::Constant(-0.75), Vec<dim>::Constant(1.25), MultiIndex<dim>::Constant(8), gimp);
  Vec<dim> lower = Vec<dim>::Constant(-0.25), upper = Vec<dim>::Constant(0.25);
  lower[0] = -0.75, upper[0] = 0.75;
  add_box<dim>(o, lower, upper, Hencky{1000.0, 1e6, 0.3});
  hold(o, "x", -0.75, dim == 2 ? "xy" : "xyz");
  std::vector<double> g(dim, 0.0);
  g[1] = -8.0;
  add_gravity(o, g, ramp());
  TractionOptions t;
  t.label = "top", t.body = "body 0", t.pressure = ramp(2000.0);
  if (dim == 2)
    t.corner = {0.75, 0.25}, t.edges = {{-1.0, 0.0}}, t.points = {9};
  else
    t.corner = {-0.25, 0.25, 0.25}, t.edges = {{1.0, 0.0, 0.0}, {0.0, 0.0, -0.5}}, t.points = {9, 5};
  o.loads.push_back(t);
  PointLoadOptions load;
  load.label = "tip", load.body = "body 0",
  load.nearest = {std::vector<double>(upper.data(), upper.data() + dim)};
  load.force.assign(dim, 50.0), load.factor = ramp();
  o.loads.push_back(load);
  if (ghost) o.stabilisation = GhostOptions{};
  Model<dim> model(o);
  QuasiStaticOptions q;
  q.steps = 5, q.tolerance = 1e-11, q.max_iterations = 20;
  Implicit<dim> run(model, q);
  for (int k = 0; k < 5; ++k) run.step(0.2);
  comparison.add(name, model);
}

WallOptions wall(const char* label, AnyWallShape shape) {
  WallOptions w;
  w.label = label, w.shape = std::move(shape);
  return w;
}

/// A block that falls into an inclined corner and turns there, across the middle of the grid: unilateral with
/// friction, a wall that moves, one that holds.
template <int dim>
ModelOptions cornered(bool gimp) {
  auto o = on_grid<dim>(Vec<dim>::Constant(-1.0), Vec<dim>::Constant(1.0),
                        MultiIndex<dim>::Constant(dim == 2 ? 16 : 8), gimp);
  const Vec<dim> half = Vec<dim>::Constant(dim == 2 ? 0.3 : 0.35);
  auto& body = add_box<dim>(o, -half, half, Hencky{1000.0, 2e4, 0.3});
  body.velocity.assign(dim, -1.5), body.velocity[0] = 1.2;
  std::vector<double> at(dim, 0.0), normal(dim, 0.0), g(dim, 0.0);
  at[1] = -0.5, normal[0] = -0.3, normal[1] = 1.0, normal[dim - 1] += 0.1;
  WallOptions slope = wall("slope", PlaneWall{at, normal});
  slope.unilateral = true, slope.friction = 0.2;
  o.boundaries.push_back(slope);
  at[1] = 0.0, at[0] = 0.45, normal.assign(dim, 0.0), normal[0] = -1.0, normal[1] = 0.1;
  WallOptions side = wall("side", PlaneWall{at, normal});
  side.unilateral = true, side.motion.emplace();
  side.motion->velocity.assign(dim, Curve(0.0)), side.motion->velocity[0] = Curve(-0.5);
  o.boundaries.push_back(side);
  g[1] = -9.81;
  add_gravity(o, g);
  return o;
}

/// A block between inclined walls, held by one and pressed by another.
template <int dim>
void wall_case(Comparison& comparison, const std::string& name, bool gimp, bool finite, bool dynamic) {
  auto o = on_grid<dim>(Vec<dim>::Constant(-0.83), Vec<dim>::Constant(0.97),
                        MultiIndex<dim>::Constant(dim == 2 ? 14 : 8), gimp);
  auto& body = add_box<dim>(o, Vec<dim>::Constant(-0.45), Vec<dim>::Constant(0.45), Hencky{1000.0, 1e6, 0.3});
  if (!finite) body.material = LinearElastic{1000.0, 1e6, 0.3};
  std::vector<double> at(dim, 0.0), down(dim, 0.0), g(dim, 0.0);
  at[1] = -0.36, down[0] = 0.2, down[1] = 1.0;
  WallOptions base = wall("base", PlaneWall{at, down});
  base.kind = WallKind::fixed;
  body.sampling.cuts.push_back(at),
      body.sampling.cuts.back().insert(body.sampling.cuts.back().end(), down.begin(), down.end());
  o.boundaries.push_back(base);
  at[1] = 0.36, down[0] = 0.1, down[1] = -1.0;
  WallOptions press = wall("press", PlaneWall{at, down});
  press.kind = WallKind::roller, press.displacement.assign(dim, Curve(0.0));
  press.displacement[0] = ramp(finite ? 0.1 : 0.01);
  body.sampling.cuts.push_back(at),
      body.sampling.cuts.back().insert(body.sampling.cuts.back().end(), down.begin(), down.end());
  o.boundaries.push_back(press);
  g[0] = 5.0;
  add_gravity(o, g, ramp());
  Model<dim> model(o);
  QuasiStaticOptions q;
  q.steps = 5, q.tolerance = 1e-11, q.max_iterations = 20;
  if (dynamic) {
    ImplicitDynamicOptions d;
    d.duration = 1.0, d.steps = 5, d.tolerance = 1e-11, d.max_iterations = 20;
    Implicit<dim> run(model, d);
    for (int k = 0; k < 5; ++k) run.step(0.2);
  } else {
    Implicit<dim> run(model, q);
    for (int k = 0; k < 5; ++k) run.step(0.2);
  }
  comparison.add(name, model);
}

void leaving(Comparison& comparison) {
  auto o = collision<2>(true);
  o.grid.leaving = Leaving::remove;
  for (auto& body : o.bodies) body.velocity[1] = 3.0;
  Model<2> model(o);
  Explicit<2> run(model, explicit_steps(4e-3));
  for (int k = 0; k < 60; ++k) run.step(4e-3);
  comparison.check(model.removed > 0 && model.n_points() > 0, "leaving: some should leave and some stay");
  comparison.add("leaving", model);

  o.grid.leaving = Leaving::stop;
  Model<2> stopped(o);
  Explicit<2> other(stopped, explicit_steps(4e-3));
  std::string what;
  try {
    for (int k = 0; k < 60; ++k) other.step(4e-3);
  } catch (const RunError& e) {
    what = e.what();
  }
  comparison.check(what.find("left the grid") != std::string::npos, "leaving: this rank did not stop");
  comparison.check(Session::broadcast(what) == what, "leaving: ranks tell different stories");
  comparison.add("stopped", stopped);
}

bool all_cases(const std::string& file) {
  Comparison comparison(file);
  using enum MassKind;
  explicit_case<2>(comparison, "lumped", collision<2>(false), lumped, StressUpdate::usl,
                   VelocityUpdate::flip);
  explicit_case<2>(comparison, "lumped-gimp-usf", collision<2>(true), lumped, StressUpdate::usf,
                   VelocityUpdate::flip);
  explicit_case<2>(comparison, "lumped-gimp-apic", collision<2>(true), lumped, StressUpdate::musl,
                   VelocityUpdate::apic);
  explicit_case<2>(comparison, "ghost", collision<2>(true), ghost, StressUpdate::usl, VelocityUpdate::flip);
  explicit_case<3>(comparison, "lumped-3d", collision<3>(true), lumped, StressUpdate::usl,
                   VelocityUpdate::flip);
  explicit_case<3>(comparison, "ghost-3d", collision<3>(false), ghost, StressUpdate::usl,
                   VelocityUpdate::flip);
  static_case<2>(comparison, "static", false, true);
  static_case<2>(comparison, "static-gimp", true, true);
  static_case<3>(comparison, "static-3d", true, true);
  explicit_case<2>(comparison, "walls", cornered<2>(false), lumped, StressUpdate::usl, VelocityUpdate::flip);
  explicit_case<2>(comparison, "walls-pic", cornered<2>(false), lumped, StressUpdate::usl,
                   VelocityUpdate::apic);
  explicit_case<2>(comparison, "walls-gimp-musl", cornered<2>(true), lumped, StressUpdate::musl,
                   VelocityUpdate::flip);
  explicit_case<2>(comparison, "walls-gimp-usf", cornered<2>(true), lumped, StressUpdate::usf,
                   VelocityUpdate::flip);
  explicit_case<2>(comparison, "walls-ghost", cornered<2>(true), ghost, StressUpdate::usl,
                   VelocityUpdate::flip);
  explicit_case<3>(comparison, "walls-3d", cornered<3>(true), lumped, StressUpdate::usl,
                   VelocityUpdate::flip);
  wall_case<2>(comparison, "wall-static", false, false, false);
  wall_case<2>(comparison, "wall-static-finite", true, true, false);
  wall_case<2>(comparison, "wall-dynamic", true, true, true);
  wall_case<3>(comparison, "wall-static-3d", true, true, false);
  leaving(comparison);
  return !comparison.failed();
}

}  // namespace
}  // namespace wisp

int main(int argc, char** argv) {
  const wisp::Session session;
  return argc == 2 && wisp::all_cases(argv[1]) ? 0 : 1;
}
