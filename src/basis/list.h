// The bases of a structured grid. A new one is one file and one word here.
#pragma once
#include <variant>

#include "basis/gimp.h"
#include "basis/linear.h"

namespace wisp {

/// The basis of a run in the form its kernels need; visited once per loop over points.
template <int dim>
using AnyBasis = std::variant<Linear<dim>, Gimp<dim, 3>, Gimp<dim, 5>>;

}  // namespace wisp
