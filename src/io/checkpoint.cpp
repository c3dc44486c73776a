#include "io/checkpoint.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "io/hdf5_file.h"

namespace wisp {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view format_name = "wisp checkpoint";
constexpr std::size_t seal_size = 512;  // HDF5's smallest user block
constexpr std::size_t sets_kept = 2;

/// Bytes and checksum (CRC 32) of what follows the seal.
struct Measure {
  std::uint64_t bytes = 0;
  std::uint32_t checksum = 0;
  bool operator==(const Measure&) const = default;
};

std::uint32_t checksum_of(std::string_view text, std::uint32_t start = 0) {
  return static_cast<std::uint32_t>(
      ::crc32_z(start, reinterpret_cast<const Bytef*>(text.data()), static_cast<z_size_t>(text.size())));
}

Measure measure_after_seal(std::istream& stream) {
  stream.seekg(static_cast<std::streamoff>(seal_size));
  Measure measure;
  std::vector<char> chunk(std::size_t{1} << 20);
  while (stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) || stream.gcount() > 0) {
    const auto count = static_cast<std::size_t>(stream.gcount());
    measure.checksum = checksum_of({chunk.data(), count}, measure.checksum);
    measure.bytes += count;
  }
  return measure;
}

std::string seal_text(const Measure& measure) {
  std::string text = fmt::format("{} {}\nbytes {}\ncrc32 {:08x}\n", format_name, checkpoint_format_version,
                                 measure.bytes, measure.checksum);
  text.resize(seal_size, '\0');
  return text;
}

void put_seal(const fs::path& path) {
  std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
  const Measure measure = measure_after_seal(stream);
  stream.clear();
  stream.seekp(0);
  const std::string seal = seal_text(measure);
  stream.write(seal.data(), static_cast<std::streamsize>(seal.size()));
  stream.close();
  if (!stream) run_error("cannot write {}: the file could not be sealed", path.string());
}

/// Refuses a file that is not whole, before anything trusts its contents.
void examine_seal(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) input_error("checkpoint {} is missing or cannot be read", path.string());
  std::string seal(seal_size, '\0');
  stream.read(seal.data(), static_cast<std::streamsize>(seal_size));
  const auto length = static_cast<std::size_t>(stream.gcount());
  std::istringstream words(seal);
  std::string first, second;
  int version = 0;
  words >> first >> second >> version;
  if (first + " " + second != format_name)
    input_error("{} is not a checkpoint of Wisp{}", path.string(), length == 0 ? " (it is empty)" : "");
  if (version != checkpoint_format_version)
    input_error("checkpoint {} has format version {}, this program reads version {}", path.string(), version,
                checkpoint_format_version);
  stream.clear();
  if (length < seal_size || seal != seal_text(measure_after_seal(stream)))
    input_error("checkpoint {} is truncated or damaged (its checksum does not match)", path.string());
}

std::string date_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return std::string(text.data(), length);
}

hid_t type_of(const Checkpoint::Doubles&) { return H5T_NATIVE_DOUBLE; }
hid_t type_of(const Checkpoint::Integers&) { return H5T_NATIVE_INT64; }
hid_t type_of(const Checkpoint::Bytes&) { return H5T_NATIVE_UINT8; }

template <class T>
T read_values(hid_t dataset) {
  T values(hdf5::array_size(dataset));
  if (!values.empty() && H5Dread(dataset, type_of(values), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw hdf5::Failure("cannot read an array");
  return values;
}

Checkpoint::Array read_array(hid_t dataset) {
  const hdf5::Id type(H5Dget_type(dataset), H5Tclose, "no type");
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return read_values<Checkpoint::Doubles>(dataset);
    case H5T_STRING:
      return hdf5::read_text(dataset);
    case H5T_INTEGER:
      if (H5Tget_size(type) == 1) return read_values<Checkpoint::Bytes>(dataset);
      return read_values<Checkpoint::Integers>(dataset);
    default:
      throw hdf5::Failure("an array of an unknown kind");
  }
}

std::string link_name(hid_t group, hsize_t at) {
  const ssize_t length =
      H5Lget_name_by_idx(group, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, at, nullptr, 0, H5P_DEFAULT);
  if (length < 0) throw hdf5::Failure("cannot list the arrays");
  std::string name(static_cast<std::size_t>(length) + 1, '\0');
  H5Lget_name_by_idx(group, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, at, name.data(), name.size(), H5P_DEFAULT);
  name.pop_back();
  return name;
}

}  // namespace

void Checkpoint::set_array(const std::string& name, Array array) {
  if (name.empty() || name.find('/') != std::string::npos || name == ".")
    run_error("\"{}\" cannot name an array of a checkpoint", name);
  for (Named& known : arrays_)
    if (known.name == name) {
      known.array = std::move(array);
      return;
    }
  arrays_.push_back({name, std::move(array)});
}

const Checkpoint::Named* Checkpoint::find(const std::string& name) const {
  const auto at =
      std::find_if(arrays_.begin(), arrays_.end(), [&](const Named& n) { return n.name == name; });
  return at == arrays_.end() ? nullptr : &*at;
}

template <class T>
const T& Checkpoint::get(const std::string& name, const char* kind) const {
  const Named* named = find(name);
  if (!named) input_error("{}: the array \"{}\" is missing", origin_, name);
  const T* values = std::get_if<T>(&named->array);
  if (!values) input_error("{}: \"{}\" does not hold {}", origin_, name, kind);
  return *values;
}

const Checkpoint::Doubles& Checkpoint::doubles(const std::string& name) const {
  return get<Doubles>(name, "doubles");
}
const Checkpoint::Integers& Checkpoint::integers(const std::string& name) const {
  return get<Integers>(name, "integers");
}
const Checkpoint::Bytes& Checkpoint::bytes(const std::string& name) const {
  return get<Bytes>(name, "bytes");
}
const std::string& Checkpoint::text(const std::string& name) const { return get<std::string>(name, "text"); }

const Checkpoint::Doubles& Checkpoint::doubles(const std::string& name, std::size_t count) const {
  const Doubles& values = doubles(name);
  if (values.size() != count)
    input_error("{}: \"{}\" has {} values, expected {}", origin_, name, values.size(), count);
  return values;
}

const Checkpoint::Integers& Checkpoint::integers(const std::string& name, std::size_t count) const {
  const Integers& values = integers(name);
  if (values.size() != count)
    input_error("{}: \"{}\" has {} values, expected {}", origin_, name, values.size(), count);
  return values;
}

std::vector<std::string> Checkpoint::names() const {
  std::vector<std::string> names;
  for (const Named& named : arrays_) names.push_back(named.name);
  return names;
}

void Checkpoint::write_file(const fs::path& path, int rank, int ranks) const {
  const fs::path temporary = temporary_name(path);
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
  try {
    hdf5::Id file = hdf5::create_file(temporary, seal_size);
    hdf5::write_attribute(file, "format", std::string(format_name));
    hdf5::write_attribute(file, "format_version", std::int64_t{checkpoint_format_version});
    hdf5::write_attribute(file, "code_version", code_version);
    hdf5::write_attribute(file, "created", created.empty() ? date_now() : created);
    hdf5::write_attribute(file, "step", step);
    hdf5::write_attribute(file, "time", time);
    hdf5::write_attribute(file, "rank", std::int64_t{rank});
    hdf5::write_attribute(file, "ranks", std::int64_t{ranks});
    hdf5::write_text(file, "case", case_text);
    {
      const hdf5::Id creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "no creation list");
      H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
      const hdf5::Id group(H5Gcreate2(file, "arrays", H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose,
                           "arrays");
      for (const Named& named : arrays_) {
        if (const auto* words = std::get_if<std::string>(&named.array))
          hdf5::write_text(group, named.name, *words);
        const auto numbers = [&](const auto* v) {
          if (v) hdf5::write_array(group, named.name, type_of(*v), v->data(), v->size());
        };
        numbers(std::get_if<Doubles>(&named.array));
        numbers(std::get_if<Integers>(&named.array));
        numbers(std::get_if<Bytes>(&named.array));
      }
    }
    file.close("cannot flush the file");
  } catch (const hdf5::Failure& failure) {
    std::error_code gone;
    fs::remove(temporary, gone);  // a full disk needs the room
    run_error("cannot write the checkpoint {}: HDF5 stopped at \"{}\"", path.string(), failure.what());
  }
  put_seal(temporary);
  commit_temporary(path);
}

Checkpoint Checkpoint::read_file(const fs::path& path, int rank, int ranks) {
  examine_seal(path);
  Checkpoint checkpoint;
  checkpoint.origin_ = "checkpoint " + path.string();
  try {
    const hdf5::Id file = hdf5::open_file(path);
    checkpoint.code_version = hdf5::read_attribute_text(file, "code_version");
    checkpoint.created = hdf5::read_attribute_text(file, "created");
    checkpoint.step = hdf5::read_integer(file, "step");
    checkpoint.time = hdf5::read_double(file, "time");
    const std::int64_t its_rank = hdf5::read_integer(file, "rank"),
                       its_ranks = hdf5::read_integer(file, "ranks");
    if (its_rank != rank || its_ranks != ranks)
      input_error("checkpoint {} belongs to rank {} of {}, expected rank {} of {}", path.string(), its_rank,
                  its_ranks, rank, ranks);
    checkpoint.case_text = hdf5::read_text(hdf5::Id(H5Dopen2(file, "case", H5P_DEFAULT), H5Dclose, "case"));
    const hdf5::Id group(H5Gopen2(file, "arrays", H5P_DEFAULT), H5Gclose, "arrays");
    H5G_info_t about{};
    if (H5Gget_info(group, &about) < 0) throw hdf5::Failure("arrays");
    for (hsize_t i = 0; i < about.nlinks; ++i) {
      const std::string name = link_name(group, i);
      checkpoint.arrays_.push_back(
          {name, read_array(hdf5::Id(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, name.c_str()))});
    }
  } catch (const hdf5::Failure& failure) {
    input_error("checkpoint {} cannot be read: HDF5 stopped at \"{}\"", path.string(), failure.what());
  }
  return checkpoint;
}

namespace {

fs::path index_path(const fs::path& folder) { return folder / "checkpoint.txt"; }

std::string index_text(const std::vector<CheckpointSet>& sets) {
  std::string text = fmt::format("{} index {}\n", format_name, checkpoint_format_version);
  for (const CheckpointSet& set : sets) text += fmt::format("step {} ranks {}\n", set.step, set.ranks);
  return text + fmt::format("crc32 {:08x}\n", checksum_of(text));
}

/// The sets that the index names, or nothing where it is damaged.
std::optional<std::vector<CheckpointSet>> parse_index(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::vector<CheckpointSet> sets;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string step, ranks;
    CheckpointSet set;
    if (words >> step >> set.step >> ranks >> set.ranks && step == "step" && ranks == "ranks")
      sets.push_back(set);
  }
  if (index_text(sets) != text) return std::nullopt;
  return sets;
}

/// Deletes the files of sets that the index no longer names, among them those of a killed run.
void delete_other_sets(const fs::path& folder, const std::vector<CheckpointSet>& sets) {
  std::set<std::string> kept;
  for (const CheckpointSet& set : sets)
    for (int r = 0; r < set.ranks; ++r) kept.insert(checkpoint_file(folder, set, r).filename().string());
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("checkpoint-") && name.ends_with(".h5") && !kept.contains(name))
      fs::remove(entry.path(), gone);
  }
}

std::vector<CheckpointSet> sets_or_none(const fs::path& folder) {
  if (!fs::exists(index_path(folder))) return {};
  return parse_index(read_whole(index_path(folder), "the index")).value_or(std::vector<CheckpointSet>{});
}

}  // namespace

fs::path checkpoint_file(const fs::path& folder, const CheckpointSet& set, int rank) {
  return folder / fmt::format("checkpoint-{:06}.rank-{}.h5", set.step, rank);
}

std::vector<CheckpointSet> checkpoint_sets(const fs::path& folder) {
  const fs::path path = index_path(folder);
  if (!fs::exists(path))
    input_error("there is no checkpoint in {} (no {})", folder.string(), path.filename().string());
  const std::string text = read_whole(path, "the index");
  const auto sets = parse_index(text);
  if (!sets) {
    const std::string expected = fmt::format("{} index {}\n", format_name, checkpoint_format_version);
    if (text.starts_with(fmt::format("{} index ", format_name)) && !text.starts_with(expected))
      input_error("{} has another format version, this program reads version {}", path.string(),
                  checkpoint_format_version);
    input_error("{} is truncated or damaged (its checksum does not match)", path.string());
  }
  if (sets->empty()) input_error("{} names no checkpoint", path.string());
  return *sets;
}

void Checkpoint::write(const fs::path& folder, const OutputRanks& place) {
  created = date_now();
  const CheckpointSet now{step, place.ranks};
  const fs::path path = checkpoint_file(folder, now, place.rank);
  // A run that went back to an earlier set may write a later step for the second time. Its files must not be
  // exchanged one by one while the index still counts on them, unless nothing else is left.
  std::vector<CheckpointSet> earlier;
  together(place, index_path(folder).string(), [&] {
    if (place.rank != 0) return;
    const std::vector<CheckpointSet> known = sets_or_none(folder);
    for (const CheckpointSet& set : known)
      if (set.step < step) earlier.push_back(set);
    if (!earlier.empty() && earlier.size() < known.size())
      write_atomically(index_path(folder), index_text(earlier));
  });
  together(place, path.string(), [&] { write_file(path, place.rank, place.ranks); });
  together(place, index_path(folder).string(), [&] {
    if (place.rank != 0) return;
    std::vector<CheckpointSet> sets{now};
    sets.insert(sets.end(), earlier.begin(), earlier.end());
    if (sets.size() > sets_kept) sets.resize(sets_kept);
    write_atomically(index_path(folder), index_text(sets));
    delete_other_sets(folder, sets);
  });
}

Checkpoint read_latest_checkpoint(const fs::path& folder, const OutputRanks& place,
                                  std::vector<std::string>* passed_over) {
  std::string reason;
  for (const CheckpointSet& set : checkpoint_sets(folder)) {
    if (set.ranks != place.ranks)
      input_error("the checkpoint of step {} in {} was written by {} ranks, this run has {}", set.step,
                  folder.string(), set.ranks, place.ranks);
    std::optional<Checkpoint> mine;
    std::string fault;
    try {
      mine = Checkpoint::read_file(checkpoint_file(folder, set, place.rank), place.rank, place.ranks);
      if (mine->step != set.step)
        input_error("checkpoint {} holds step {}", checkpoint_file(folder, set, place.rank).string(),
                    mine->step);
    } catch (const InputError& error) {
      fault = error.what();
      mine.reset();
    }
    if (place.all_succeeded(mine.has_value())) return std::move(*mine);
    if (fault.empty()) fault = fmt::format("another rank cannot read its checkpoint of step {}", set.step);
    if (reason.empty()) reason = fault;
    if (passed_over) passed_over->push_back(fault);
  }
  input_error("{}", reason);
}

Checkpoint CheckpointParts::read(int part) const {
  const fs::path file = checkpoint_file(folder, set, part);
  Checkpoint checkpoint = Checkpoint::read_file(file, part, set.ranks);
  if (checkpoint.step != set.step) input_error("checkpoint {} holds step {}", file.string(), checkpoint.step);
  return checkpoint;
}

CheckpointParts latest_checkpoint_parts(const fs::path& folder, std::vector<std::string>* passed_over) {
  std::string reason;
  for (const CheckpointSet& set : checkpoint_sets(folder)) {
    const CheckpointParts parts{folder, set};
    try {
      for (int r = 0; r < set.ranks; ++r) static_cast<void>(parts.read(r));
      return parts;
    } catch (const InputError& error) {
      if (reason.empty()) reason = error.what();
      if (passed_over) passed_over->push_back(error.what());
    }
  }
  input_error("{}", reason);
}

}  // namespace wisp
