// Finding the cells of points, and keeping points in cell order.
#pragma once
#include <cstddef>
#include <vector>

#include "grid/structured.h"
#include "grid/triangulation.h"
#include "parallel/window.h"
#include "particle/body.h"

namespace wisp {

/// What `locate` found.
struct Location {
  int outside = 0;    ///< points outside the grid
  int elsewhere = 0;  ///< points in the grid whose cell another rank owns
  int disorder = 0;   ///< points whose cell comes before that of the point before
};

/// Writes the local cell index of every point; -1 outside the grid, -2 in a cell that this rank does not own.
template <int dim>
Location locate(Particles<dim>& points, const StructuredGrid<dim>& grid, const Window<dim>& window);
/// The same on a triangulation, which lies on one rank: triangle numbers, -1 outside. The cells from before
/// are the hints.
Location locate(Particles<2>& points, const Triangulation& triangulation);

/// What `reorder` works in, kept by the caller so that steps allocate nothing.
struct OrderMemory {
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<int> start, from;  ///< of cells; of points
  std::vector<Line> kept;        ///< values of one field that have been overwritten and are still needed
};

/// Sorts the points (and their material states) by cell; points of one cell keep their order. Moves one field
/// at a time through a ring of memory as long as the points' way.
template <int dim>
void reorder(Body<dim>& body, int n_cells, OrderMemory& memory);

/// Removes the points for which `gone` is not 0; the rest keep their order.
template <int dim>
void remove(Body<dim>& body, const std::vector<char>& gone);

}  // namespace wisp
