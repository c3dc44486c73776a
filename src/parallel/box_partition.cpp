#include "parallel/box_partition.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/error.h"

namespace wisp {
namespace {

/// Where to cut a box across one direction.
struct Choice {
  int direction = -1;
  int position = 0;        // cells below the cut, counted from the box's lower face
  double imbalance = 0.0;  // distance from the wanted share, as a part of the whole weight
  int extent = 0;          // layers that hold weight: long directions are cut first, for compact parts
};

/// The cut nearest to the share `below / n` of the weight that leaves at least as many cells as parts on both
/// sides.
Choice best_cut(std::span<const std::int64_t> weight, std::int64_t cells_per_layer, int below, int n) {
  const int layers = static_cast<int>(weight.size());
  Choice best;
  best.imbalance = std::numeric_limits<double>::infinity();
  std::int64_t total = 0;
  int first = layers;
  int last = -1;
  for (int i = 0; i < layers; ++i) {
    total += weight[static_cast<std::size_t>(i)];
    if (weight[static_cast<std::size_t>(i)] == 0) continue;
    first = std::min(first, i);
    last = i;
  }
  best.extent = last - first + 1;
  std::int64_t sum = 0;
  const double wanted = static_cast<double>(total) * below / n;
  // Runs of equally good cuts (empty layers) are cut in their middle.
  int run_end = 0;
  for (int i = 1; i < layers; ++i) {
    sum += weight[static_cast<std::size_t>(i - 1)];
    if (i * cells_per_layer < below || (layers - i) * cells_per_layer < n - below) continue;
    const double imbalance = std::abs(static_cast<double>(sum) - wanted) / static_cast<double>(total);
    if (imbalance < best.imbalance) {
      best.imbalance = imbalance;
      best.position = run_end = i;
    } else if (imbalance == best.imbalance && run_end == i - 1) {
      run_end = i;
    }
  }
  best.position += (run_end - best.position) / 2;
  return best;
}

}  // namespace

template <int dim>
BoxPartition<dim>::BoxPartition(const MultiIndex<dim>& n_cells)
    : n_cells_(n_cells), boxes_{IndexBox<dim>{MultiIndex<dim>::Zero(), n_cells}}, tree_(1) {}

template <int dim>
BoxPartition<dim>::BoxPartition(const MultiIndex<dim>& n_cells,
                                std::span<const MultiIndex<dim>> cells_of_points, int n_parts)
    : n_cells_(n_cells), boxes_(static_cast<std::size_t>(n_parts)), tree_(1) {
  const IndexBox<dim> grid{MultiIndex<dim>::Zero(), n_cells};
  if (n_parts < 1 || grid.count() < n_parts)
    input_error("a grid of {} cells cannot be split among {} ranks: use fewer ranks", grid.count(), n_parts);
  const bool inside = std::all_of(cells_of_points.begin(), cells_of_points.end(),
                                  [&](const MultiIndex<dim>& cell) { return grid.contains(cell); });
  Session::raise_together(inside ? "" : "the grid cannot be split among the ranks: a point lies outside it");

  std::vector<int> node_of_point(cells_of_points.size(), 0);
  std::vector<Open> open{{grid, 0, n_parts, 0}};
  while (!open.empty()) {
    // One level of the tree: the histograms of all open boxes and directions go into one sum over the ranks.
    std::vector<std::int64_t> start_of_node(tree_.size(), -1);
    std::int64_t length = 0;
    for (const Open& o : open) {
      start_of_node[static_cast<std::size_t>(o.node)] = length;
      length += o.box.extent().sum();
    }
    std::vector<std::int64_t> histogram(static_cast<std::size_t>(length), 0);
    for (std::size_t p = 0; p < cells_of_points.size(); ++p) {
      int node = node_of_point[p];
      const Cut& cut = tree_[static_cast<std::size_t>(node)];
      if (cut.direction >= 0) node = cells_of_points[p][cut.direction] < cut.position ? cut.below : cut.above;
      node_of_point[p] = node;
      std::int64_t start = start_of_node[static_cast<std::size_t>(node)];
      if (start < 0) continue;
      const auto o = std::find_if(open.begin(), open.end(), [&](const Open& a) { return a.node == node; });
      for (int d = 0; d < dim; ++d) {
        ++histogram[static_cast<std::size_t>(start + cells_of_points[p][d] - o->box.lower[d])];
        start += o->box.extent()[d];
      }
    }
    Session::sum_in_place(histogram);
    std::vector<Open> next;
    for (const Open& o : open)
      cut(o, histogram.data() + start_of_node[static_cast<std::size_t>(o.node)], next);
    open = std::move(next);
  }
}

template <int dim>
void BoxPartition<dim>::cut(const Open& open, const std::int64_t* histogram, std::vector<Open>& next) {
  if (open.n == 1) {
    tree_[static_cast<std::size_t>(open.node)].part = open.first;
    boxes_[static_cast<std::size_t>(open.first)] = open.box;
    return;
  }
  const int below = open.n / 2;
  const MultiIndex<dim> extent = open.box.extent();
  std::int64_t points = 0;
  for (int i = 0; i < extent[0]; ++i) points += histogram[i];
  // A cut along the longest direction is preferred as long as it is within this of the best balance.
  constexpr double tolerated = 0.02;
  Choice chosen;
  for (int d = 0; d < dim; ++d) {
    std::vector<std::int64_t> weight(histogram, histogram + extent[d]);
    histogram += extent[d];
    if (points == 0) std::fill(weight.begin(), weight.end(), 1);
    Choice choice = best_cut(weight, open.box.count() / extent[d], below, open.n);
    choice.direction = d;
    if (choice.imbalance == std::numeric_limits<double>::infinity()) continue;
    const double gain = chosen.direction < 0 ? 1.0 : chosen.imbalance - choice.imbalance;
    if (gain > tolerated || (gain > -tolerated && choice.extent > chosen.extent)) chosen = choice;
  }
  if (chosen.direction < 0)
    input_error("{} cells cannot be split into {} boxes: use fewer ranks", open.box.count(), open.n);
  split(open, chosen.direction, open.box.lower[chosen.direction] + chosen.position, below, next);
}

template <int dim>
void BoxPartition<dim>::split(const Open& open, int d, int position, int below, std::vector<Open>& next) {
  const int child = static_cast<int>(tree_.size());
  Cut& node = tree_[static_cast<std::size_t>(open.node)];
  node = {d, position, child, child + 1, 0};
  tree_.resize(tree_.size() + 2);
  IndexBox<dim> lower = open.box;
  IndexBox<dim> upper = open.box;
  lower.upper[d] = position;
  upper.lower[d] = position;
  next.push_back({lower, open.first, below, child});
  next.push_back({upper, open.first + below, open.n - below, child + 1});
}

template <int dim>
BoxPartition<dim>::BoxPartition(const MultiIndex<dim>& n_cells, std::vector<IndexBox<dim>> boxes)
    : n_cells_(n_cells), boxes_(std::move(boxes)), tree_(1) {
  std::vector<Open> open{{{MultiIndex<dim>::Zero(), n_cells}, 0, n_parts(), 0}};
  while (!open.empty()) {
    const Open last = open.back();
    open.pop_back();
    find_cut(last, open);
  }
}

/// The cut of a given split: the first half of the parts of a box lies below it, the other half above.
template <int dim>
void BoxPartition<dim>::find_cut(const Open& open, std::vector<Open>& next) {
  if (open.n == 1) {
    tree_[static_cast<std::size_t>(open.node)].part = open.first;
    if (!(box(open.first) == open.box)) input_error("the boxes of the ranks do not cover the grid");
    return;
  }
  const int below = open.n / 2;
  for (int d = 0; d < dim; ++d) {
    int end = open.box.lower[d], start = open.box.upper[d];
    for (int part = open.first; part < open.first + open.n; ++part)
      if (part < open.first + below)
        end = std::max(end, box(part).upper[d]);
      else
        start = std::min(start, box(part).lower[d]);
    if (end == start) return split(open, d, end, below, next);
  }
  input_error("the boxes of the ranks cannot be told apart by cuts through the grid");
}

template class BoxPartition<1>;
template class BoxPartition<2>;
template class BoxPartition<3>;

}  // namespace wisp
