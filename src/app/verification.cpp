#include "app/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/nearest.h"

namespace wisp {

std::optional<double> VerificationRow::difference() const {
  const auto t = target();
  if (!t) return std::nullopt;
  return *t == 0.0 ? computed : (computed - *t) / std::abs(*t);
}

bool VerificationRow::passed() const {
  if (verdict) return *verdict;
  if (!std::isfinite(computed)) return false;
  const auto d = difference();
  return !tolerance || !d || std::abs(*d) <= *tolerance;
}

std::vector<const VerificationTable*> select_tables(const std::vector<VerificationTable>& tables,
                                                    const std::vector<std::string>& words, bool full) {
  std::vector<std::string> ids;
  for (const auto& table : tables) ids.push_back(table.id);
  std::vector<bool> wanted(tables.size(), false);
  for (const auto& word : words) {
    bool known = false;
    for (std::size_t i = 0; i < tables.size(); ++i) {
      if (!tables[i].id.starts_with(word)) continue;
      known = true;
      if (full || !tables[i].only_full || tables[i].id == word) wanted[i] = true;
    }
    if (!known) input_error("verify: unknown id '{}'{}", word, suggestion(word, ids));
  }
  std::vector<const VerificationTable*> selected;
  for (std::size_t i = 0; i < tables.size(); ++i)
    if (words.empty() ? full || !tables[i].only_full : wanted[i]) selected.push_back(&tables[i]);
  return selected;
}

namespace {

std::string number(const std::optional<double>& value) { return value ? fmt::format("{:.6g}", *value) : "-"; }

std::string percent(const VerificationRow& row) {
  const auto d = row.difference();
  if (!d) return "-";
  if (row.target() == 0.0) return fmt::format("{:+.1e}", *d);
  return std::abs(*d) < 10.0 ? fmt::format("{:+.2f} %", 100.0 * *d) : fmt::format("{:+.1e}", *d);
}

std::string json_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      result += c;
  }
  return result + "\"";
}

std::string json_number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{}", *value) : "null";
}

}  // namespace

std::string table_text(const VerificationTable& table, const std::vector<VerificationRow>& rows) {
  std::vector<std::vector<std::string>> cells{{"case", "quantity", "published", "ours", "difference", ""}};
  for (const auto& row : rows) {
    std::string remark = row.gated ? (row.passed() ? "ok" : "FAILED") : "";
    if (row.expected && row.reference != "published")
      remark =
          fmt::format("{}: {}{}{}", row.reference, number(row.expected), remark.empty() ? "" : "  ", remark);
    cells.push_back({row.case_name, row.quantity, number(row.published), fmt::format("{:.6g}", row.computed),
                     percent(row), remark});
  }
  std::size_t widths[6] = {};
  for (const auto& line : cells)
    for (std::size_t c = 0; c < 6; ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string text = fmt::format("{}: {}\n", table.id, table.summary);
  for (const auto& line : cells) {
    std::string out =
        fmt::format("  {:<{}}  {:<{}}  {:>{}}  {:>{}}  {:>{}}  {}", line[0], widths[0], line[1], widths[1],
                    line[2], widths[2], line[3], widths[3], line[4], widths[4], line[5]);
    out.erase(out.find_last_not_of(' ') + 1);
    text += out + "\n";
  }
  return text;
}

std::string rows_json(const std::vector<std::pair<std::string, std::vector<VerificationRow>>>& tables) {
  std::string text = "[";
  bool first = true;
  for (const auto& [id, rows] : tables)
    for (const auto& row : rows) {
      text += first ? "\n" : ",\n";
      first = false;
      text += fmt::format(
          R"(  {{"id": {}, "case": {}, "quantity": {}, "published": {}, "computed": {}, "reference": {}, )"
          R"("expected": {}, "tolerance": {}, "gated": {}, "passed": {}}})",
          json_text(id), json_text(row.case_name), json_text(row.quantity), json_number(row.published),
          json_number(row.computed), json_text(row.reference), json_number(row.target()),
          json_number(row.tolerance), row.gated, row.passed());
    }
  return text + "\n]\n";
}

}  // namespace wisp
