#include "basis/knots.h"

#include "core/error.h"

namespace wisp {

KnotVector::KnotVector(int degree, const std::vector<double>& lines, const std::vector<int>& multiplicity)
    : degree_(degree) {
  if (degree < 1) input_error("B-splines need a degree of at least 1, not {}", degree);
  if (lines.size() < 2) input_error("B-splines need at least two knots, not {}", lines.size());
  if (!multiplicity.empty() && multiplicity.size() != lines.size() - 2)
    input_error("multiplicities of knots: expected one for each of the {} inner lines, not {}",
                lines.size() - 2, multiplicity.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0 && !(lines[i] > lines[i - 1]))
      input_error("knots must increase: {} follows {}", lines[i], lines[i - 1]);
    const bool end = i == 0 || i + 1 == lines.size();
    const int times = end ? degree + 1 : multiplicity.empty() ? 1 : multiplicity[i - 1];
    if (times < 1 || times > degree + 1)
      input_error("a knot of B-splines of degree {} can be repeated 1 to {} times, not {}", degree,
                  degree + 1, times);
    knots_.insert(knots_.end(), static_cast<std::size_t>(times), lines[i]);
    if (i + 1 < lines.size()) first_.push_back(static_cast<int>(knots_.size()) - 1 - degree);
  }
  for (int d = 0; d <= degree; ++d) {
    std::vector<double> per(knots_.size(), 0.0);
    for (std::size_t i = 0; i + static_cast<std::size_t>(d) < knots_.size(); ++i) {
      const double difference = knots_[i + static_cast<std::size_t>(d)] - knots_[i];
      if (difference > 0.0) per[i] = 1.0 / difference;
    }
    per_difference_.push_back(per);
  }
}

double KnotVector::greville(int i) const {
  double sum = 0.0;
  for (int k = 1; k <= degree_; ++k) sum += knots_[static_cast<std::size_t>(i + k)];
  return sum / degree_;
}

}  // namespace wisp
