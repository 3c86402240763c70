// Piles of boxes by ours and by Bullet: how long a step takes, how deep boxes get into each other,
// how far a tower's top goes and when it all rests.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <exception>

#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/terminal/table.h"
#include "benchmarks/piles/pile_run.h"

namespace pneuma::benchmarks {
namespace {

using app::readable;

struct Typed {
  std::vector<std::string> worlds;
  PileOptions options;
  bool is_short = false;
  bool without_bullet = false;
};

void add_row(app::Table& table, const PileWorld& pile, const char* by, const PileResult& result) {
  table.add_row({pile.name, by, readable(1e6 * result.awake_seconds),
                 readable(1e6 * result.end_seconds), fmt::format("{:.4f}", result.deepest),
                 fmt::format("{:.4f}", result.end_speed),
                 pile.measures_top ? fmt::format("{:.4f}", result.drift) : "-",
                 readable(result.rests_at), std::to_string(result.crossings)});
}

void run(const Typed& typed) {
  fmt::print("{}\n", app::provenance_text(app::utc_date()));
  for (const std::string& warning : app::timing_warnings(app::timing_conditions())) {
    fmt::print("warning: {}\n", warning);
  }
  using Align = app::Table::Align;
  app::Table table({{"world", Align::left},
                    {"by", Align::left},
                    {"awake", Align::right, "us per step, median"},
                    {"at the end", Align::right, "us per step, median"},
                    {"deepest, m,\nafter a second"},
                    {"m/s at\nthe end"},
                    {"top has\nmoved, m"},
                    {"rests\nfrom, s"},
                    {"crossings"}});
  for (const PileWorld& pile : make_pile_worlds(typed.worlds, typed.is_short)) {
    add_row(table, pile, "ours", run_ours(pile, typed.options));
    if (!typed.without_bullet) add_row(table, pile, "Bullet", run_bullet(pile, typed.options));
  }
  fmt::print("{}\n", table.text());
}

}  // namespace
}  // namespace pneuma::benchmarks

int main(int argc, char** argv) {
  using namespace pneuma::benchmarks;
  CLI::App command("Piles of boxes by ours and by Bullet");
  Typed typed;
  command.add_option("WORLD", typed.worlds, "Worlds by name [all]");
  command.add_flag("--short", typed.is_short, "One second of each");
  command.add_flag("--no-sleep", typed.options.without_sleep, "Nothing of ours falls asleep");
  command.add_flag("--no-bullet", typed.without_bullet, "Ours alone");
  command.add_option("--look-every", typed.options.look_every, "Steps between two looks [6]");
  CLI11_PARSE(command, argc, argv);
  try {
    run(typed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
