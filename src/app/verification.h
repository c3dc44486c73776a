// What `wisp verify` needs to know of a published table or figure. The tables themselves live in
// verification/<paper>.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wisp {

/// One compared number.
struct VerificationRow {
  std::string case_name{};            ///< "h = 0.125, 4x4 points"
  std::string quantity{};             ///< "Newton iterations"
  std::optional<double> published{};  ///< absent where nothing is printed
  double computed = 0.0;
  std::string reference = "published";  ///< "published", "exact" or "converged": what `expected` is
  std::optional<double> expected{};     ///< what `computed` is compared with; absent: the published value
  std::optional<double> tolerance{};    ///< on |computed - expected| / |expected| (absolute if expected is 0)
  bool gated = false;                   ///< counts for the exit status
  std::optional<bool> verdict{};        ///< of a test that is not a tolerance (a trend, a bound)

  /// Published or expected value to compare with.
  std::optional<double> target() const { return expected ? expected : published; }
  /// Relative difference (absolute where the target is zero); absent without a target.
  std::optional<double> difference() const;
  /// The verdict, or the tolerance kept; a row with neither passes if its number is finite or it is not
  /// gated.
  bool passed() const;
};

struct VerificationRequest {
  bool full = false;                                ///< also what takes long
  std::filesystem::path folder = "results/verify";  ///< for data of figures
};

struct VerificationTable {
  std::string id;       ///< "ghost.table-5"
  std::string summary;  ///< one line
  std::function<std::vector<VerificationRow>(const VerificationRequest&)> compute;
  bool only_full = false;  ///< left out unless --full or named in full
};

/// Tables whose id is `words` or starts with one of them (all if there is none), in the order of the list.
/// InputError for a word that fits no table.
std::vector<const VerificationTable*> select_tables(const std::vector<VerificationTable>& tables,
                                                    const std::vector<std::string>& words, bool full);

/// The lines `published · ours · difference` of a table.
std::string table_text(const VerificationTable& table, const std::vector<VerificationRow>& rows);

/// JSON list of rows; numbers that are not finite become null.
std::string rows_json(const std::vector<std::pair<std::string, std::vector<VerificationRow>>>& tables);

}  // namespace wisp
