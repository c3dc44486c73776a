#include "io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace wisp {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view part_suffix = ".part";

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

[[noreturn]] void cannot_write(const fs::path& path) {
  run_error("cannot write {}: {}", path.string(), std::strerror(errno));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error && !fs::is_directory(folder))
    run_error("cannot create the folder {}: {}", folder.string(), error.message());
}

/// Without this the rename itself may be lost when the machine stops. Some file systems refuse to flush a
/// folder; the rename then is as safe as they make it, so the result is not examined.
void flush_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void rename_into_place(const fs::path& temporary, const fs::path& path) {
  if (std::rename(temporary.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    ::unlink(temporary.c_str());
    errno = reason;
    cannot_write(path);
  }
  flush_folder(folder_of(path));
}

}  // namespace

void together(const OutputRanks& place, std::string_view what, const std::function<void()>& work) {
  std::exception_ptr error;
  try {
    work();
  } catch (...) {
    error = std::current_exception();
  }
  const bool all = place.all_succeeded(!error);
  if (error) std::rethrow_exception(error);
  if (!all) run_error("another rank could not write {}", what);
}

fs::path temporary_name(const fs::path& path) {
  return folder_of(path) / fmt::format(".{}{}", path.filename().string(), part_suffix);
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)), temporary_(temporary_name(path_)) {
  make_folder(folder_of(path_));
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) cannot_write(path_);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) { write(bytes.data(), bytes.size()); }

void AtomicFile::write(const void* bytes, std::size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t done = ::write(descriptor_, next, count);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) cannot_write(path_);
    next += done;
    count -= static_cast<std::size_t>(done);
  }
}

void AtomicFile::commit() {
  if (::fsync(descriptor_) != 0) cannot_write(path_);
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0) cannot_write(path_);
  rename_into_place(temporary_, path_);
}

void commit_temporary(const fs::path& path) {
  const fs::path temporary = temporary_name(path);
  const int descriptor = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) cannot_write(path);
  const bool flushed = ::fsync(descriptor) == 0;
  const int reason = errno;
  ::close(descriptor);
  errno = reason;
  if (!flushed) cannot_write(path);
  rename_into_place(temporary, path);
}

void write_atomically(const fs::path& path, std::string_view contents) {
  AtomicFile file(path);
  file.write(contents);
  file.commit();
}

void remove_unfinished(const fs::path& folder) {
  make_folder(folder);
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > part_suffix.size() && name.front() == '.' && name.ends_with(part_suffix)) {
      std::error_code gone;
      fs::remove(entry.path(), gone);
    }
  }
}

std::string read_whole(const fs::path& path, std::string_view what) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) input_error("cannot read {} {}: {}", what, path.string(), std::strerror(errno));
  std::string contents{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) input_error("cannot read {} {}: {}", what, path.string(), std::strerror(errno));
  return contents;
}

}  // namespace wisp
