// Explicit steps on one rank allocate nothing between reorderings once their arrays have grown. Not in
// sanitizer builds: they replace operator new themselves, and check what is allocated by one form and freed
// by another.
#ifndef __SANITIZE_ADDRESS__
#include <cstdlib>
#include <new>

#include "analysis/fixtures.h"

namespace {

bool counting = false;
long allocations = 0;

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (counting) ++allocations;
  // aligned_alloc wants a multiple of the alignment.
  void* const p = std::aligned_alloc(alignment, (bytes + alignment) / alignment * alignment);
  if (!p) throw std::bad_alloc();
  return p;
}

/// Not inlined, or g++ sees `free` next to `new` in a caller and takes it for a mistake.
__attribute__((noinline)) void release(void* p) noexcept { std::free(p); }

}  // namespace

// All other forms of the standard library end in these.
void* operator new(std::size_t bytes) { return allocate(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete(void* p, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { release(p); }

namespace wisp {
namespace {

using namespace analysis_test;

/// A block on rollers that is loaded, damped and flies apart: points change their cells all the time.
template <int dim>
ModelOptions busy_block(bool gimp, const AnyLaw& law) {
  auto o = on_grid<dim>(Vec<dim>::Zero(), Vec<dim>::Constant(2.0),
                        MultiIndex<dim>::Constant(dim == 2 ? 16 : 8), gimp);
  auto& body = add_box<dim>(o, Vec<dim>::Zero(), Vec<dim>::Constant(1.0), law);
  body.velocity_gradient.assign(dim, std::vector<double>(dim, 0.0));
  for (std::size_t d = 0; d < dim; ++d) body.velocity_gradient[d][d] = 0.3;
  add_gravity(o, std::vector<double>(dim, -0.1));
  for (int d = 0; d < dim; ++d) hold(o, d == 0 ? "x" : d == 1 ? "y" : "z", 0.0, std::string(1, "xyz"[d]));
  PointLoadOptions load;
  load.label = "corner", load.body = body.label, load.force = std::vector<double>(dim, 0.01);
  load.nearest = {std::vector<double>(dim, 1.0)};
  o.loads = {load};
  return o;
}

/// Allocations in steps without a reordering; `quiet` counts those steps.
template <int dim>
long allocations_of(const ModelOptions& o, StressUpdate scheme, VelocityUpdate velocity, int& quiet) {
  Model<dim> model(o);
  ExplicitOptions options = explicit_steps(4e-3, Mass::lumped, scheme, velocity);
  options.damping = 0.05;
  Explicit<dim> run(model, options);
  EnergyRecord record;
  for (int k = 0; k < 3; ++k) run.step(4e-3, &record);
  long sum = 0;
  for (int k = 0; k < 60; ++k) {
    const auto before = model.reorderings;
    allocations = 0, counting = true;
    run.step(4e-3, &record);
    counting = false;
    if (model.reorderings == before) ++quiet, sum += allocations;
  }
  EXPECT_TRUE(std::isfinite(record.kinetic));
  return sum;
}

TEST(Allocations, AreCounted) {
  allocations = 0, counting = true;
  const std::vector<double> plain(3);
  const RecordArray aligned(3);
  counting = false;
  EXPECT_EQ(allocations, 2) << plain.size() + aligned.size();
}

/// A step that puts points back in order allocates only where the memory for it must grow.
TEST(Allocations, FewInReorderings) {
  auto o = busy_block<2>(false, LinearElastic{1000.0, 1e4, 0.3});
  o.bodies[0].velocity_gradient = {{3.0, 0.0}, {0.0, 3.0}};
  Model<2> model(o);
  Explicit<2> run(model, explicit_steps(4e-3, Mass::lumped, StressUpdate::usl, VelocityUpdate::flip));
  int sorted = 0, grown = 0;
  for (int k = 0; k < 60; ++k) {
    const auto before = model.reorderings;
    allocations = 0, counting = true;
    run.step(4e-3);
    counting = false;
    if (model.reorderings != before) ++sorted, grown += allocations > 0;
  }
  EXPECT_GT(sorted, 5);
  EXPECT_LT(3 * grown, sorted);
}

TEST(Allocations, NoneInExplicitStepsWithBSplines) {
  BSplineOptions cubic;
  cubic.degree = 3;
  auto plane = busy_block<2>(false, Hencky{1000.0, 1e4, 0.3});
  auto space = busy_block<3>(false, Hencky{1000.0, 1e4, 0.3});
  plane.basis = cubic, space.basis = BSplineOptions{};
  for (const StressUpdate scheme : all_schemes) {
    int quiet = 0;
    EXPECT_EQ(allocations_of<2>(plane, scheme, VelocityUpdate::apic, quiet), 0);
    EXPECT_EQ(allocations_of<3>(space, scheme, VelocityUpdate::flip, quiet), 0);
    EXPECT_GT(quiet, 60);
  }
}

TEST(Allocations, NoneInExplicitSteps) {
  for (const bool gimp : {false, true})
    for (const StressUpdate scheme : all_schemes)
      for (const VelocityUpdate velocity :
           {VelocityUpdate::flip, VelocityUpdate::pic, VelocityUpdate::apic}) {
        int quiet = 0;
        EXPECT_EQ(
            allocations_of<2>(busy_block<2>(gimp, LinearElastic{1000.0, 1e4, 0.3}), scheme, velocity, quiet),
            0);
        EXPECT_EQ(allocations_of<2>(busy_block<2>(gimp, Hencky{1000.0, 1e4, 0.3}), scheme, velocity, quiet),
                  0);
        EXPECT_EQ(allocations_of<3>(busy_block<3>(gimp, Hencky{1000.0, 1e4, 0.3}), scheme, velocity, quiet),
                  0);
        EXPECT_GT(quiet, 60) << "most steps of a test must count";
      }
}

}  // namespace
}  // namespace wisp
#endif
