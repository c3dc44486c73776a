#include "verification/implicit_boundary/explicit_scenes.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/error.h"

namespace wisp::explicit_walls {

namespace {

/// A body of equal points, by way of a file like any user's.
BodyOptions points_body(const std::vector<Vec<2>>& points, double volume, const AnyLaw& law) {
  static int count = 0;
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("wisp-points-{}-{}.csv", ::getpid(), count++);
  {
    std::ofstream out(file);
    out << "x,y,volume\n";
    for (const auto& x : points) out << fmt::format("{},{},{}\n", x[0], x[1], volume);
  }
  BodyOptions body;
  body.label = "body";
  body.shape = PointFile{file.string()};
  body.material = law;
  return body;
}

/// The wall's frame: its normal offset moves with the variant, its foot lies near the middle of the grid.
Scene frame(const Variant& variant, double degrees, double length) {
  Scene scene;
  const double a = degrees * std::numbers::pi / 180.0;
  scene.along = {std::cos(a), -std::sin(a)}, scene.up = {std::sin(a), std::cos(a)};
  // The body may slide by `length`: the grid holds its way and some empty cells around.
  const int half = static_cast<int>(std::ceil(length / cell)) + 12;
  scene.options.grid.lower = {-half * cell, -half * cell};
  scene.options.grid.upper = {half * cell, half * cell};
  scene.options.grid.cells = {2 * half, 2 * half};
  if (variant.gimp()) scene.options.basis = GimpOptions{};
  if (variant.triangles()) {
    const bool splines = variant.functions == Functions::powell_sabin;
    TriangleBlocksOptions blocks;
    blocks.lower = scene.options.grid.lower, blocks.upper = scene.options.grid.upper;
    blocks.cells.assign(2, splines ? half : 2 * half);
    blocks.split = BlockSplit::two;
    scene.options.triangulation = blocks;
    if (splines) scene.options.basis = PowellSabinOptions{};
  }
  if (variant.consistent) scene.options.stabilisation = GhostOptions{};
  scene.foot = variant.offset * cell * scene.up;
  return scene;
}

}  // namespace

std::string Variant::name() const {
  const char* scheme = update == StressUpdate::usl ? "USL" : update == StressUpdate::musl ? "MUSL" : "USF";
  constexpr const char* names[] = {"linear", "GIMP", "linear on triangles", "Powell-Sabin"};
  return fmt::format("{} {}{}, offset {:.2f} h", names[static_cast<std::size_t>(functions)], scheme,
                     consistent ? ", consistent mass with Ghost" : "", offset);
}

LinearElastic soft(double young_modulus) {
  LinearElastic law;
  law.density = density, law.young_modulus = young_modulus, law.poisson_ratio = 0.3;
  return law;
}

double time_step(double young_modulus, double share) {
  return share * cell / std::sqrt(soft(young_modulus).p_wave_modulus() / density);
}

Scene block(const Variant& variant, double degrees, double width, double height, double young_modulus,
            int rows, double gap) {
  Scene scene = frame(variant, degrees, std::max(width, height));
  const double s = cell / rows;
  const int nx = static_cast<int>(std::lround(width / s)), ny = static_cast<int>(std::lround(height / s));
  std::vector<Vec<2>> points;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      points.push_back(scene.foot + (i + 0.5 - 0.5 * nx) * s * scene.along +
                       (gap + (j + 0.5) * s) * scene.up);
  scene.options.bodies = {points_body(points, s * s, soft(young_modulus))};
  return scene;
}

Scene disc(const Variant& variant, double degrees, double radius, double young_modulus) {
  Scene scene = frame(variant, degrees, 2.5 * radius);
  // Rings, so that the surface is as round as the points allow: a lattice would stand on its flat sides.
  const int rings = static_cast<int>(std::lround(radius / (0.5 * cell)));
  const double s = radius / rings;
  const Vec<2> centre = scene.foot + radius * scene.up;
  std::vector<Vec<2>> points;
  for (int k = 0; k < rings; ++k) {
    const double r = (k + 0.5) * s;
    const int n = static_cast<int>(std::lround(2.0 * std::numbers::pi * r / s));
    for (int i = 0; i < n; ++i) {
      const double a = 2.0 * std::numbers::pi * (i + 0.5 * (k % 2)) / n;
      points.push_back(centre + r * std::cos(a) * scene.along + r * std::sin(a) * scene.up);
    }
  }
  // The points share the area of the disc.
  const double volume = std::numbers::pi * radius * radius / static_cast<double>(points.size());
  // It turns far: small strains would take that for strain.
  const LinearElastic law = soft(young_modulus);
  Hencky finite;
  finite.density = law.density, finite.young_modulus = law.young_modulus,
  finite.poisson_ratio = law.poisson_ratio;
  scene.options.bodies = {points_body(points, volume, finite)};
  return scene;
}

WallOptions& wall(Scene& scene, double friction) {
  WallOptions w;
  w.label = "wall";
  w.shape = PlaneWall{{scene.foot[0], scene.foot[1]}, {scene.up[0], scene.up[1]}};
  w.unilateral = true, w.friction = friction;
  return std::get<WallOptions>(scene.options.boundaries.emplace_back(w));
}

ExplicitOptions explicit_options(const Variant& variant, double duration, double dt, double damping) {
  ExplicitOptions o;
  o.duration = duration, o.dt = dt;
  o.mass = variant.consistent ? Mass::consistent : Mass::lumped;
  o.stress_update = variant.update;
  o.damping = damping;
  return o;
}

Run::Run(const Scene& scene, const ExplicitOptions& options)
    : model_(std::make_unique<Model<2>>(scene.options)),
      analysis_(std::make_unique<Explicit<2>>(*model_, options)),
      options_(options) {
  for (const auto& body : scene.options.bodies)
    if (const auto* file = std::get_if<PointFile>(&body.shape)) std::filesystem::remove(file->file);
}

void Run::change(const ExplicitOptions& options) {
  options_ = options;
  analysis_ = std::make_unique<Explicit<2>>(*model_, options);
}

void Run::go(double duration, const std::function<void()>& watch) {
  const auto steps = static_cast<int>(std::ceil(duration / *options_.dt - 1e-9));
  for (int k = 0; k < steps; ++k) {
    analysis_->step(duration / steps);
    if (watch) watch();
  }
}

double Run::mass() const {
  double sum = 0.0;
  for (const double m : model_->bodies[0].points.mass) sum += m;
  return sum;
}

Vec<2> Run::momentum() const {
  const auto& points = model_->bodies[0].points;
  Vec<2> sum = Vec<2>::Zero();
  for (std::size_t p = 0; p < points.mass.size(); ++p) sum += points.mass[p] * points.velocity[p];
  return sum;
}

Vec<2> Run::centre() const {
  const auto& points = model_->bodies[0].points;
  Vec<2> sum = Vec<2>::Zero();
  for (std::size_t p = 0; p < points.mass.size(); ++p) sum += points.mass[p] * points.position[p];
  return sum / mass();
}

Vec<2> Run::mean_displacement() const {
  const auto& points = model_->bodies[0].points;
  Vec<2> sum = Vec<2>::Zero();
  for (std::size_t p = 0; p < points.mass.size(); ++p) sum += points.mass[p] * points.displacement[p];
  return sum / mass();
}

double Run::spin() const {
  const auto& points = model_->bodies[0].points;
  const Vec<2> c = centre();
  double angular = 0.0, inertia = 0.0;
  for (std::size_t p = 0; p < points.mass.size(); ++p) {
    const Vec<2> r = points.position[p] - c;
    angular += points.mass[p] * (r[0] * points.velocity[p][1] - r[1] * points.velocity[p][0]);
    inertia += points.mass[p] * r.squaredNorm();
  }
  return angular / inertia;
}

double Run::energy() const {
  const BodyEnergy e = wisp::energy(model_->bodies[0]);
  return e.kinetic + e.strain;
}

}  // namespace wisp::explicit_walls
