// From the description of a body to its points.
#pragma once
#include <filesystem>
#include <vector>

#include "geometry/clip.h"
#include "grid/structured.h"
#include "particle/body.h"
#include "particle/body_options.h"

namespace wisp {

/// The planes of `sampling.cuts`. Errors (InputError): a wrong number of values, a normal without length.
template <int dim>
std::vector<HalfSpace<dim>> cuts_of(const BodyOptions& options);

/// The points of a body in the order of their ids, which do not depend on the number of ranks; no rank ever
/// holds more of them than its own.
template <int dim>
class Sampler {
 public:
  /// Counts the points, every rank a share of them. `folder`: where relative file names start. Collective;
  /// keeps references to its arguments. Errors (InputError, on all ranks): no point lies in the shape, a
  /// point outside the grid.
  Sampler(const BodyOptions& options, const StructuredGrid<dim>& grid, const std::filesystem::path& folder);

  /// Points of all ranks.
  std::int64_t count() const { return count_; }
  /// Cells of this rank's share of the points, to balance them; the ranks' shares list each point once.
  const std::vector<MultiIndex<dim>>& share() const { return share_; }
  /// The body with its points in a box of cells. Ids count from `first_id` over all points. `with_domains`
  /// fills the half-lengths of GIMP domains. Errors (InputError): lists of the wrong length.
  Body<dim> points(const IndexBox<dim>& cells, bool with_domains, std::int64_t first_id) const;

 private:
  template <class F>
  void for_each_in_cells(const IndexBox<dim>& cells, F&& f) const;

  const BodyOptions& options_;
  const StructuredGrid<dim>& grid_;
  const std::filesystem::path& folder_;
  std::int64_t count_ = 0;
  std::vector<MultiIndex<dim>> share_;
  std::vector<std::int64_t> start_;  // points before each layer of cells; empty for a point file
};

/// All points of a body, for a rank alone.
template <int dim>
Body<dim> sample(const BodyOptions& options, const StructuredGrid<dim>& grid, bool with_domains,
                 std::int64_t first_id, const std::filesystem::path& folder) {
  return Sampler<dim>(options, grid, folder)
      .points({MultiIndex<dim>::Zero(), grid.cells()}, with_domains, first_id);
}

}  // namespace wisp
