#include "io/checkpoint_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace wisp {
namespace {

/// Small tensors and material states are plain bytes here, though Eigen's types do not say so themselves.
template <class T>
concept Plain = std::is_trivially_destructible_v<T> && std::is_standard_layout_v<T>;

template <class T>
inline constexpr bool made_of_doubles = false;
template <int rows, int columns>
inline constexpr bool made_of_doubles<Eigen::Matrix<double, rows, columns>> = true;
template <>
inline constexpr bool made_of_doubles<double> = true;

template <Plain T>
void set(Checkpoint& checkpoint, const std::string& name, const std::vector<T>& values) {
  const void* const from = values.data();
  const std::size_t bytes = values.size() * sizeof(T);
  const auto copy = [&](auto array) {
    if (bytes > 0) std::memcpy(static_cast<void*>(array.data()), from, bytes);
    checkpoint.set(name, std::move(array));
  };
  if constexpr (made_of_doubles<T>)
    copy(Checkpoint::Doubles(bytes / sizeof(double)));
  else if constexpr (std::is_same_v<T, std::int64_t>)
    checkpoint.set(name, values);
  else
    copy(Checkpoint::Bytes(bytes));
}

template <Plain T>
void append(const Checkpoint& checkpoint, const std::string& name, std::vector<T>& values) {
  const auto copy = [&](const auto& array) {
    const std::size_t bytes = array.size() * sizeof(array.front()), before = values.size();
    if (bytes % sizeof(T) != 0)
      input_error("checkpoint: \"{}\" has {} bytes, expected a multiple of {}", name, bytes, sizeof(T));
    values.resize(before + bytes / sizeof(T));
    if (bytes > 0) std::memcpy(static_cast<void*>(values.data() + before), array.data(), bytes);
  };
  if constexpr (made_of_doubles<T>)
    copy(checkpoint.doubles(name));
  else if constexpr (std::is_same_v<T, std::int64_t>)
    copy(checkpoint.integers(name));
  else
    copy(checkpoint.bytes(name));
}

std::string field_name(std::size_t body, std::string_view field) {
  return fmt::format("body {} {}", body, field);
}
std::string wall_name(std::size_t boundary, const char* field) {
  return fmt::format("wall {} {}", boundary, field);
}
std::string load_name(std::size_t load, std::string_view field) {
  return fmt::format("load {} {}", load, field);
}

/// Points of one part, behind those that are there already.
template <int dim>
void append_points(const Checkpoint& part, Model<dim>& model) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    Body<dim>& body = model.bodies[b];
    body.for_each_field(
        [&](std::string_view name, auto& field) { append(part, field_name(b, name), field); });
    const std::size_t n = body.points.position.size();
    body.for_each_field([&](std::string_view name, auto& field) {
      if (field.size() != n && !field.empty())
        input_error("checkpoint: field '{}' of body '{}' has {} entries, expected {}", name, body.name,
                    field.size(), n);
    });
  }
}

template <int dim>
void clear_points(Model<dim>& model) {
  for (auto& body : model.bodies) {
    body.for_each_field([](std::string_view, auto& field) { field.clear(); });
    body.points.cell.clear();
  }
}

template <int dim>
void store_walls(const Model<dim>& model, Checkpoint& checkpoint) {
  for_each<Wall, dim>(model.boundaries, [&](const Wall<dim>& wall, std::size_t k) {
    std::vector<Vec<dim>> rest, traction, gap;
    for (const auto& s : wall.states())
      rest.push_back(s.rest), traction.push_back(s.traction), gap.push_back(s.gap);
    set(checkpoint, wall_name(k, "rest"), rest);
    set(checkpoint, wall_name(k, "traction"), traction);
    set(checkpoint, wall_name(k, "gap"), gap);
  });
}

template <int dim>
void restore_walls(const Checkpoint& checkpoint, Model<dim>& model) {
  for_each<Wall, dim>(model.boundaries, [&](Wall<dim>& wall, std::size_t k) {
    std::vector<Vec<dim>> rest, traction, gap;
    append(checkpoint, wall_name(k, "rest"), rest);
    append(checkpoint, wall_name(k, "traction"), traction);
    append(checkpoint, wall_name(k, "gap"), gap);
    if (traction.size() != rest.size() || gap.size() != rest.size())
      input_error("checkpoint: wall '{}' has {} places, {} tractions and {} gaps", wall.name(), rest.size(),
                  traction.size(), gap.size());
    wall.states().clear();
    for (std::size_t q = 0; q < rest.size(); ++q) wall.states().push_back({rest[q], traction[q], gap[q]});
  });
}

/// What all ranks have alike.
template <int dim>
void restore_common(const Checkpoint& checkpoint, Model<dim>& model) {
  for (std::size_t k = 0; k < model.loads.size(); ++k)
    std::visit(
        [&](auto& load) {
          const auto read = [&](std::string_view field, auto& array) {
            const std::size_t size = array.size();
            array.clear();
            append(checkpoint, load_name(k, field), array);
            if (array.size() != size)
              input_error("checkpoint: load '{}' has {} marked points, expected {}", load.name(),
                          array.size(), size);
          };
          if constexpr (requires { load.for_each_field(read); }) load.for_each_field(read);
        },
        model.loads[k]);
  model.reactions.clear();
  append(checkpoint, "reactions", model.reactions);
  if (model.reactions.size() != model.boundaries.size())
    input_error("checkpoint: reactions of {} boundaries, expected {}", model.reactions.size(),
                model.boundaries.size());
  model.moments.clear();
  append(checkpoint, "moments", model.moments);
  if (model.moments.size() != model.boundaries.size())
    input_error("checkpoint: moments of {} boundaries, expected {}", model.moments.size(),
                model.boundaries.size());
  restore_walls(checkpoint, model);
  model.step = checkpoint.step;
  model.time = checkpoint.time;
  model.external_work = checkpoint.number("external_work");
  model.removed = checkpoint.integer("removed");
}

}  // namespace

template <int dim>
void store(Model<dim>& model, Checkpoint& checkpoint) {
  checkpoint.step = model.step;
  checkpoint.time = model.time;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    model.bodies[b].for_each_field(
        [&](std::string_view name, const auto& field) { set(checkpoint, field_name(b, name), field); });
  for (std::size_t k = 0; k < model.loads.size(); ++k)
    std::visit(
        [&](auto& load) {
          const auto write = [&](std::string_view field, const auto& array) {
            set(checkpoint, load_name(k, field), array);
          };
          if constexpr (requires { load.for_each_field(write); }) load.for_each_field(write);
        },
        model.loads[k]);
  set(checkpoint, "reactions", model.reactions);
  set(checkpoint, "moments", model.moments);
  store_walls(model, checkpoint);
  checkpoint.set_number("external_work", model.external_work);
  checkpoint.set_integer("removed", model.removed);
  Checkpoint::Integers boxes;
  if (!model.space->structured()) {
    checkpoint.set("boxes", std::move(boxes));
    return;
  }
  const auto& partition = model.space->partition();
  for (int part = 0; part < partition.n_parts(); ++part)
    for (const auto& corner : {partition.box(part).lower, partition.box(part).upper})
      boxes.insert(boxes.end(), corner.data(), corner.data() + dim);
  checkpoint.set("boxes", std::move(boxes));
}

template <int dim>
void restore(const Checkpoint& checkpoint, Model<dim>& model) {
  if (!model.space->structured()) {
    clear_points(model);
    append_points(checkpoint, model);
    restore_common(checkpoint, model);
    return;
  }
  const auto ranks = static_cast<std::size_t>(Session::size());
  const auto& numbers = checkpoint.integers("boxes", ranks * 2 * dim);
  std::vector<IndexBox<dim>> boxes(ranks);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    auto& box = boxes[k / (2 * dim)];
    (k % (2 * dim) < dim ? box.lower : box.upper)[static_cast<int>(k % dim)] = static_cast<int>(numbers[k]);
  }
  model.make_space(BoxPartition<dim>(model.space->grid().cells(), std::move(boxes)));
  clear_points(model);
  append_points(checkpoint, model);
  restore_common(checkpoint, model);
}

template <int dim>
void restore_parts(const CheckpointParts& parts, Model<dim>& model) {
  const StructuredGrid<dim> grid = model.space->grid();
  std::vector<MultiIndex<dim>> cells;
  for (int part = Session::rank(); part < parts.n(); part += Session::size()) {
    const Checkpoint checkpoint = parts.read(part);
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      std::vector<Vec<dim>> positions;
      append(checkpoint, field_name(b, "position"), positions);
      for (const auto& x : positions) {
        MultiIndex<dim> cell;
        for (int d = 0; d < dim; ++d) cell[d] = std::clamp(grid.locate_inside(d, x[d]), 0, grid.cells(d) - 1);
        cells.push_back(cell);
      }
    }
  }
  model.make_space(BoxPartition<dim>(grid.cells(), cells));
  clear_points(model);
  for (int part = 0; part < parts.n(); ++part) {
    const Checkpoint checkpoint = parts.read(part);
    if (part == 0) restore_common(checkpoint, model);
    append_points(checkpoint, model);
    model.keep_owned();
  }
}

template void store<2>(Model<2>&, Checkpoint&);
template void store<3>(Model<3>&, Checkpoint&);
template void restore<2>(const Checkpoint&, Model<2>&);
template void restore<3>(const Checkpoint&, Model<3>&);
template void restore_parts<2>(const CheckpointParts&, Model<2>&);
template void restore_parts<3>(const CheckpointParts&, Model<3>&);

}  // namespace wisp
