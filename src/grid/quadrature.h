// Gauss quadrature on intervals, boxes and triangles.
#pragma once
#include <array>
#include <vector>

namespace wisp {

/// Places in [0, 1] and weights that sum to one.
struct IntervalRule {
  std::vector<double> place, weight;
};

/// Gauss–Legendre rule of n points, exact to degree 2 n - 1. Errors (InputError): n < 1.
IntervalRule gauss_legendre(int n);

/// Barycentric places and weights that sum to one.
struct TriangleRule {
  std::vector<std::array<double, 3>> place;
  std::vector<double> weight;
};

/// n x n points on a triangle, exact to degree 2 n - 2: the Gauss rule of a square whose one side is drawn
/// together to a corner (Stroud 1971). Errors (InputError): n < 1.
TriangleRule triangle_rule(int n);

}  // namespace wisp
