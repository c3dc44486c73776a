// From the description of a body to its points.
#pragma once
#include <filesystem>

#include "grid/structured.h"
#include "particle/body.h"
#include "particle/body_options.h"

namespace wisp {

/// All points of a body (the same on every rank; the caller keeps those whose cell it owns). Ids count from
/// `first_id`. `with_domains` fills the half-lengths of GIMP domains. `folder`: where relative file names
/// start. Errors (InputError): no point lies in the shape, a point outside the grid, lists of the wrong
/// length.
template <int dim>
Body<dim> sample(const BodyOptions& options, const StructuredGrid<dim>& grid, bool with_domains,
                 std::int64_t first_id, const std::filesystem::path& folder);

}  // namespace wisp
