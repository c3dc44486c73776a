// The yardstick of `wisp bench`: what a kernel can do that does nothing else.
#pragma once
#include <memory>

namespace wisp {

/// A bare explicit kernel: a square (cube) of about `points` points in cell order, 2 a cell and direction, on
/// equal cells; linear functions, lumped mass, stress last, small strain; no boundary, no displacement, no
/// deformation gradient, no checks. Its points hardly move, so they stay in their order.
template <int dim>
class BareKernel {
 public:
  explicit BareKernel(int points);
  ~BareKernel();

  int size() const;
  /// Processor time of a step (s), over `steps` of them. Errors (RunError): the result is not finite.
  double seconds_per_step(int steps);

 private:
  class Arrays;
  static constexpr double dt = 1e-5;  // a twentieth of what is stable
  std::unique_ptr<Arrays> arrays_;
};

}  // namespace wisp
