// The material points: one contiguous array per field.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "tensor/tensor.h"

namespace wisp {

/// Points of one body on this rank, in cell order. Every array has one entry per point, or none where a run
/// does not use the field. SI units; in 2D masses and volumes are per metre of thickness.
template <int dim>
struct Particles {
  std::vector<std::int64_t> id;        ///< unique in the run, kept for ever
  std::vector<int> cell;               ///< local index of the cell on this rank's window; see `locate`
  std::vector<Vec<dim>> position;      ///< m
  std::vector<Vec<dim>> displacement;  ///< m, since the start
  std::vector<Vec<dim>> velocity;      ///< m/s
  std::vector<double> mass;            ///< kg
  std::vector<double> volume;          ///< m3, initial
  std::vector<Mat<dim>> deformation_gradient;  ///< F, since the start
  std::vector<Vec<dim>> half_length;           ///< m, of the GIMP domain now (only bases with domains)
  std::vector<Vec<dim>> initial_half_length;   ///< m, at the start (likewise)
  std::vector<Mat<dim>> affine;                ///< APIC: C of v + C (x - x_p), 1/s (only APIC)
  std::vector<Vec<dim>> acceleration;          ///< m/s2 (only implicit dynamics)

  int size() const { return static_cast<int>(position.size()); }

  /// Calls f(name, array) for every field that is kept when points are reordered, moved to another rank or
  /// stored. `cell` is not among them: it is found again.
  template <class F>
  void for_each_field(F&& f) {
    f(std::string_view("id"), id);
    f(std::string_view("position"), position);
    f(std::string_view("displacement"), displacement);
    f(std::string_view("velocity"), velocity);
    f(std::string_view("mass"), mass);
    f(std::string_view("volume"), volume);
    f(std::string_view("deformation_gradient"), deformation_gradient);
    f(std::string_view("half_length"), half_length);
    f(std::string_view("initial_half_length"), initial_half_length);
    f(std::string_view("affine"), affine);
    f(std::string_view("acceleration"), acceleration);
  }
};

}  // namespace wisp
