#include "io/sound_state.h"

#include "parallel/session.h"
#include "transfer/explicit_transfer.h"

namespace wisp {

template <int dim>
EnergyRecord energies_of_points(const Model<dim>& model) {
  EnergyRecord record;
  for (const auto& body : model.bodies) {
    const BodyEnergy e = energy(body);
    record.kinetic += e.kinetic, record.strain += e.strain, record.dissipation += e.dissipation;
  }
  const Vec<3> sum = Session::sum(Vec<3>(record.kinetic, record.strain, record.dissipation));
  record.kinetic = sum[0], record.strain = sum[1], record.dissipation = sum[2];
  record.external_work = model.external_work;
  return record;
}

template <int dim>
bool is_finite(const Model<dim>& model) {
  bool finite = true;
  for (const auto& body : model.bodies) {
    const Particles<dim>& points = body.points;
    for (std::size_t p = 0; p < points.position.size(); ++p) {
      const Mat<dim>& F = points.deformation_gradient[p];
      finite &= points.position[p].allFinite() && points.velocity[p].allFinite() && F.allFinite() &&
                F.determinant() > 0;
    }
    for_each_state<dim>(body,
                        [&](int, const auto&, const auto& state) { finite &= state.stress.allFinite(); });
  }
  return Session::all_of(finite);
}

template EnergyRecord energies_of_points<2>(const Model<2>&);
template EnergyRecord energies_of_points<3>(const Model<3>&);
template bool is_finite<2>(const Model<2>&);
template bool is_finite<3>(const Model<3>&);

}  // namespace wisp
