// What a wall has gathered, found again where it is cut anew.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "boundary/wall_state.h"
#include "parallel/session.h"

namespace wisp {

/// Nearest of the states that a wall has gathered, within a distance: a wall at rest finds its own Gauss
/// points again, one that moves through the grid those beside them. What comes in error is made up for by the
/// penalty, as it would make up for none at all.
template <int dim>
class WallMemory {
 public:
  WallMemory(const std::vector<WallState<dim>>& states, double reach) : states_(states), reach_(reach) {
    for (std::size_t k = 0; k < states.size(); ++k) bins_.push_back({bin(states[k].rest), k});
    std::sort(bins_.begin(), bins_.end());
  }

  /// The state at a position of the wall at rest; zero where there is none.
  WallState<dim> at(const Vec<dim>& rest) const {
    WallState<dim> found;
    double least = reach_ * reach_;
    std::size_t best = states_.size();
    const Bin centre = bin(rest);
    for (int k = 0; k < (dim == 2 ? 9 : 27); ++k) {
      Bin b = centre;
      for (int d = 0, rank = k; d < dim; ++d, rank /= 3) b[static_cast<std::size_t>(d)] += rank % 3 - 1;
      for (auto it = std::lower_bound(bins_.begin(), bins_.end(), Entry{b, 0});
           it != bins_.end() && it->first == b; ++it) {
        const double distance = (states_[it->second].rest - rest).squaredNorm();
        if (distance < least || (distance == least && it->second < best)) least = distance, best = it->second;
      }
    }
    if (best < states_.size()) found = states_[best];
    return found;
  }

 private:
  using Bin = std::array<long, dim>;
  using Entry = std::pair<Bin, std::size_t>;
  Bin bin(const Vec<dim>& x) const {
    Bin b;
    for (int d = 0; d < dim; ++d) b[static_cast<std::size_t>(d)] = std::lround(std::floor(x[d] / reach_));
    return b;
  }

  const std::vector<WallState<dim>>& states_;
  double reach_;
  std::vector<Entry> bins_;
};

/// The states of all ranks on every rank, in an order that does not depend on their number.
template <int dim>
void replicate(std::vector<WallState<dim>>& states) {
  if (Session::size() == 1) return;
  std::vector<std::array<double, 3 * dim>> rows;
  for (const auto& s : states) {
    std::array<double, 3 * dim> row;
    Eigen::Map<Vec<dim>>(row.data()) = s.rest;
    Eigen::Map<Vec<dim>>(row.data() + dim) = s.traction;
    Eigen::Map<Vec<dim>>(row.data() + 2 * dim) = s.gap;
    rows.push_back(row);
  }
  rows = Session::gather(rows);
  std::sort(rows.begin(), rows.end());
  std::string bytes(rows.size() * sizeof(rows[0]), '\0');
  if (!rows.empty()) std::memcpy(bytes.data(), rows.data(), bytes.size());
  bytes = Session::broadcast(bytes);
  rows.resize(bytes.size() / sizeof(rows[0]));
  if (!rows.empty()) std::memcpy(rows.data(), bytes.data(), bytes.size());
  states.clear();
  for (const auto& row : rows)
    states.push_back({Eigen::Map<const Vec<dim>>(row.data()), Eigen::Map<const Vec<dim>>(row.data() + dim),
                      Eigen::Map<const Vec<dim>>(row.data() + 2 * dim)});
}

}  // namespace wisp
