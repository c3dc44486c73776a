// Knot vectors of B-splines and the Cox–de Boor recursion.
#pragma once
#include <array>
#include <vector>

namespace wisp {

/// Open knot vector over cells between increasing lines: the first and last line are repeated degree + 1
/// times, an inner line as often as asked, which lowers the smoothness there (de Koster 2018, section 3.4).
class KnotVector {
 public:
  KnotVector() = default;
  /// @param lines        at least two, increasing
  /// @param multiplicity of each inner line, 1..degree + 1; empty: all once
  /// Errors (InputError): lines not increasing, a multiplicity out of range, a wrong number of them.
  KnotVector(int degree, const std::vector<double>& lines, const std::vector<int>& multiplicity = {});

  int degree() const { return degree_; }
  int n_functions() const { return static_cast<int>(knots_.size()) - degree_ - 1; }
  int n_cells() const { return static_cast<int>(first_.size()); }
  /// The first of the degree + 1 functions that are not zero in a cell.
  int first_function(int cell) const { return first_[static_cast<std::size_t>(cell)]; }
  const std::vector<double>& knots() const { return knots_; }
  /// Mean of the knots inside function i's support: the coefficients of the function x.
  double greville(int i) const;

  /// Values and derivatives (1/m) of the degree + 1 functions of a cell at x in it (Cox 1972; de Boor 1972;
  /// de Koster 2018, eq. 3.13, 3.14). `p` is the vector's degree, known to the
  /// compiler.
  template <int p>
  inline __attribute__((always_inline)) void evaluate(int cell, double x, std::array<double, p + 1>& value,
                                                      std::array<double, p + 1>& derivative) const {
    // Functions first .. first + degree of the last level; those of level d that count are the last d + 1.
    const auto first = static_cast<std::size_t>(first_[static_cast<std::size_t>(cell)]);
    const double* const knot = knots_.data() + first;
    value.fill(0.0);
    value[p] = 1.0;
    for (int d = 1; d <= p; ++d) {
      const double* const per = per_difference_[static_cast<std::size_t>(d)].data() + first;
      if (d == p)
        for (int i = 0; i <= p; ++i) {
          const auto k = static_cast<std::size_t>(i);
          const double above = i < p ? value[k + 1] * per[i + 1] : 0.0;
          derivative[k] = p * (value[k] * per[i] - above);
        }
      for (int i = p - d; i <= p; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double above = i < p ? value[k + 1] * per[i + 1] : 0.0;
        value[k] = (x - knot[i]) * per[i] * value[k] + (knot[i + d + 1] - x) * above;
      }
    }
  }

  /// The derivative of order p (1/m^p) of the p + 1 functions of a cell, which is constant there. `p` is the
  /// vector's degree.
  template <int p>
  std::array<double, p + 1> highest_derivative(int cell) const {
    const auto first = static_cast<std::size_t>(first_[static_cast<std::size_t>(cell)]);
    std::array<double, p + 1> derivative{};
    for (std::size_t i = 0; i <= p; ++i) {
      // Differences of the coefficients of one function give those of its derivatives (de Boor 1972).
      std::array<double, p + 1> c{};
      c[i] = 1.0;
      for (std::size_t k = p, done = 1; k > 0; --k, ++done)
        for (std::size_t j = p; j >= done; --j)
          c[j] = static_cast<double>(k) * (c[j] - c[j - 1]) * per_difference_[k][first + j];
      derivative[i] = c[p];
    }
    return derivative;
  }

 private:
  int degree_ = 0;
  std::vector<double> knots_;
  std::vector<int> first_;
  /// 1 / (knot i+d - knot i), zero where they are equal.
  std::vector<std::vector<double>> per_difference_;
};

}  // namespace wisp
