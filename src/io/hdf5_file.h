// HDF5's C interface with errors as exceptions: what checkpoints need of it, and no more. Serial access, one
// process.
#pragma once
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace wisp::hdf5 {

/// What HDF5 could not do; turned into an InputError or a RunError by those who know the file's purpose.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline hid_t checked(hid_t id, const char* what) {
  if (id < 0) throw Failure(what);
  return id;
}

/// An identifier that is closed at the end of its scope.
class Id {
 public:
  using Close = herr_t (*)(hid_t);
  Id(hid_t id, Close closing, const char* what) : id_(checked(id, what)), close_(closing) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT: stands for the identifier in every call
  /// Closes now, so that a failure to flush is seen.
  void close(const char* what) {
    if (close_(std::exchange(id_, -1)) < 0) throw Failure(what);
  }

 private:
  hid_t id_;
  Close close_;
};

/// A new file, beginning with a user block of `user_block` bytes for the caller.
Id create_file(const std::filesystem::path& path, hsize_t user_block);
Id open_file(const std::filesystem::path& path);

void write_array(hid_t file, const std::string& name, hid_t type, const void* values, std::size_t count);
/// Number of values of a one-dimensional array.
std::size_t array_size(hid_t dataset);
std::string read_text(hid_t dataset);
void write_text(hid_t file, const std::string& name, const std::string& text);

void write_attribute(hid_t object, const char* name, std::int64_t value);
void write_attribute(hid_t object, const char* name, double value);
void write_attribute(hid_t object, const char* name, const std::string& text);
std::int64_t read_integer(hid_t object, const char* name);
double read_double(hid_t object, const char* name);
std::string read_attribute_text(hid_t object, const char* name);

}  // namespace wisp::hdf5
