// wisp verify [ID...] [--json FILE] [--full] [--list]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>

#include "app/launch.h"
#include "app/program.h"
#include "core/progress.h"
#include "io/atomic_file.h"
#include "parallel/session.h"

namespace wisp {
namespace {

struct VerifyOptions {
  std::vector<std::string> ids;
  std::string json;
  VerificationRequest request;
  bool list = false;
};

int verify(const std::vector<const VerificationTable*>& selected, const VerifyOptions& o) {
  std::vector<std::pair<std::string, std::vector<VerificationRow>>> all;
  const bool first_rank = Session::rank() == 0;
  std::size_t gated = 0, failed = 0;
  for (const auto* table : selected) {
    const auto start = std::chrono::steady_clock::now();
    auto rows = table->compute(o.request);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (const auto& row : rows) {
      gated += row.gated ? 1 : 0;
      failed += row.gated && !row.passed() ? 1 : 0;
    }
    if (first_rank) fmt::print("{}  ({})\n\n", table_text(*table, rows), duration_text(seconds));
    std::fflush(stdout);
    all.emplace_back(table->id, std::move(rows));
    // After each table, so that an interrupted verification leaves what it has.
    if (first_rank && !o.json.empty()) write_atomically(o.json, rows_json(all));
  }
  if (first_rank)
    fmt::print("{} of {} gated values pass{}\n", gated - failed, gated,
               failed > 0 ? fmt::format(", {} fail", failed) : "");
  return failed > 0 ? 1 : 0;
}

}  // namespace

void add_verify(CLI::App& app, const Engine& engine, int* status) {
  auto o = std::make_shared<VerifyOptions>();
  CLI::App* command = app.add_subcommand("verify", "compute published tables and figures anew, and compare");
  command->add_option("id", o->ids, "tables by id or the beginning of it, such as ghost.table-5")
      ->type_name("ID");
  command->add_option("--json", o->json, "also write the rows to this file")->type_name("FILE");
  command->add_option("--out", o->request.folder, "folder for the data of figures")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_flag("--full", o->request.full, "also what takes long");
  command->add_flag("--list", o->list, "only list the ids");
  command->callback([o, &engine, status] {
    const auto selected = select_tables(engine.tables, o->ids, o->request.full || o->list);
    if (o->list) {
      for (const auto* table : selected)
        fmt::print("{:<28} {}{}\n", table->id, table->summary, table->only_full ? " (--full)" : "");
      *status = 0;
      return;
    }
    *status = with_session([&] { return verify(selected, *o); });
  });
}

}  // namespace wisp
