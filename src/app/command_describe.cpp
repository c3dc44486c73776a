// wisp describe [KIND [NAME]] [--markdown]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/program.h"
#include "core/error.h"

namespace wisp {

void add_describe(CLI::App& app, int* status) {
  struct Options {
    std::vector<std::string> words;
    bool markdown = false;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("describe", "list what a case file can say");
  command->add_option("words", o->words, "a kind of table, and a name of that kind")
      ->type_name("KIND NAME")
      ->expected(0, 2);
  command->add_flag("--markdown", o->markdown, "the whole reference as Markdown");
  command->callback([o, status] {
    if (o->markdown && !o->words.empty())
      input_error("describe: --markdown writes everything and takes no kind");
    fmt::print("{}", o->markdown ? describe_markdown(case_description())
                                 : describe_text(case_description(), o->words));
    *status = 0;
  });
}

}  // namespace wisp
