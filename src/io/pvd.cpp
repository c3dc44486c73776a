#include "io/pvd.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/xml.h"

namespace wisp {
namespace fs = std::filesystem;

namespace {

std::optional<std::string_view> attribute(std::string_view tag, std::string_view name) {
  const std::string opening = fmt::format(" {}=\"", name);
  const std::size_t start = tag.find(opening);
  if (start == std::string_view::npos) return std::nullopt;
  const std::size_t first = start + opening.size();
  const std::size_t end = tag.find('"', first);
  if (end == std::string_view::npos) return std::nullopt;
  return tag.substr(first, end - first);
}

template <class T>
bool parse(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

PvdSeries PvdSeries::resume(fs::path path, double time) {
  PvdSeries series(std::move(path));
  if (!fs::exists(series.path_)) return series;
  const std::string text = read_whole(series.path_, "the series");
  const std::string_view view = text;
  if (view.find("type=\"Collection\"") == std::string_view::npos ||
      view.find("</VTKFile>") == std::string_view::npos)
    input_error("{} is not a complete collection of VTK files", series.path_.string());
  for (std::size_t at = view.find("<DataSet "); at != std::string_view::npos;
       at = view.find("<DataSet ", at + 1)) {
    const std::string_view tag = view.substr(at, view.find('>', at) - at);
    const auto when = attribute(tag, "timestep"), file = attribute(tag, "file"),
               part = attribute(tag, "part");
    Entry entry;
    if (!when || !file || !parse(*when, entry.time) || (part && !parse(*part, entry.part)))
      input_error("{}: cannot understand the entry {}>", series.path_.string(), tag);
    entry.file = xml_unescape(*file);
    if (entry.time <= time) series.entries_.push_back(std::move(entry));
  }
  series.write();
  return series;
}

void PvdSeries::add(double time, const fs::path& file, int part) {
  const fs::path folder = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
  const std::string relative = fs::absolute(file)
                                   .lexically_normal()
                                   .lexically_relative(fs::absolute(folder).lexically_normal())
                                   .string();
  std::erase_if(entries_, [&](const Entry& entry) { return entry.time == time && entry.part == part; });
  entries_.push_back({time, relative, part});
  write();
}

void PvdSeries::write() const {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (const Entry& entry : entries_)
    text += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"{}\" file=\"{}\"/>\n", entry.time,
                        entry.part, xml_escape(entry.file));
  text += "</Collection>\n</VTKFile>\n";
  write_atomically(path_, text);
}

}  // namespace wisp
