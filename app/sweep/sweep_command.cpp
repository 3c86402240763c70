#include "app/sweep/sweep_command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>

#include "app/files/refuse_to_replace.h"
#include "app/host/command_line.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/host/machine.h"
#include "app/host/own_program.h"
#include "app/host/standard_streams.h"
#include "app/study/study_folder.h"
#include "app/sweep/frame_chunks.h"
#include "app/sweep/read_sweep.h"
#include "app/sweep/render_run.h"
#include "app/sweep/sweep_chunks.h"
#include "app/sweep/sweep_pictures.h"
#include "app/sweep/sweep_plots.h"
#include "app/sweep/sweep_table.h"
#include "app/sweep/workflow.h"
#include "app/terminal/common_options.h"
#include "app/terminal/number_text.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

struct SweepArguments {
  std::string file;
  std::string out;
  std::string jobs;
  std::string frames;
  std::string snakemake;
  double chunk_seconds = 60.0;
  int cores = 0;
  bool gather = false;
  bool no_pictures = false;
  bool keys = false;
  bool overwrite = false;
  bool resume = false;
  bool quiet = false;
  std::vector<std::string> command_line;
};

/// Tables, then diagrams and pictures, which need gnuplot and the runs' own pictures.
void write_results(const StudyFolder& folder, const Sweep& sweep, const SweepRows& rows,
                   const std::string& fingerprint) {
  folder.write(sweep.name + "_seconds.csv", seconds_csv(rows));
  const auto csv = folder.write(sweep.name + ".csv", sweep_csv(sweep, rows));
  const auto json =
      folder.write(sweep.name + ".json", sweep_json(sweep, rows, fingerprint).dump(2) + '\n');
  fmt::print("{}\n{}\n", csv.string(), json.string());
  for (const std::string& plot : write_sweep_plots(folder, sweep, rows))
    fmt::print("{}.svg\n", plot);
  if (const auto sheet = write_sweep_sheet(folder, sweep, rows)) fmt::print("{}\n", *sheet);
  print_message("{}\n", sweep_summary(sweep, rows));
}

/// Before anything is run. A journal says whose they are.
void refuse_old_results(const SweepArguments& typed, const Sweep& sweep) {
  if (typed.overwrite) return;
  refuse_to_replace(typed.out,
                    {sweep.name + ".csv", sweep.name + ".json", sweep.name + "_seconds.csv",
                     sweep.name + "_sheet.png"},
                    "choose another folder with --out");
}

int cores_of(const SweepArguments& typed) {
  if (typed.cores > 0) return typed.cores;
  // A scheduler gives a chunk one core.
  return typed.jobs.empty() ? std::max(1, machine().cores) : 1;
}

std::string resume_command(std::vector<std::string> command_line) {
  std::erase_if(command_line, [](const std::string& argument) {
    return argument == "--overwrite" || argument == "--resume";
  });
  command_line.emplace_back("--resume");
  return shell_line(command_line);
}

ExitCode run_here(const SweepArguments& typed, const Sweep& sweep, const std::string& fingerprint,
                  Progress& progress) {
  const StudyFolder folder(typed.out);
  ExistingRun existing = ExistingRun::refuse;
  if (typed.overwrite) existing = ExistingRun::overwrite;
  if (typed.resume) existing = ExistingRun::resume;
  const std::filesystem::path place = folder.path() / (sweep.name + ".journal");
  if (!std::filesystem::exists(place)) refuse_old_results(typed, sweep);
  SweepJournal journal(place, fingerprint, existing);
  if (typed.overwrite) remove_pictures(folder.path());
  if (typed.resume && journal.rows().empty()) {
    progress.say(fmt::format("{} holds no run of this sweep: it starts from the beginning",
                             folder.path().string()));
  }
  try {
    run_sweep(sweep, {0, run_count(sweep) - 1}, cores_of(typed), folder.path(), journal, progress);
  } catch (const Interrupted&) {
    throw Interrupted("interrupted; continue with: " + resume_command(typed.command_line));
  }
  write_results(folder, sweep, journal.rows(), fingerprint);
  return exit_code_of(journal.rows());
}

/// Parts of long renders, of a sweep that has them.
void add_frame_chunks(const SweepArguments& typed, const Sweep& sweep, const CostEstimate& cost,
                      Workflow& workflow, Progress& progress) {
  const auto dearest = std::ranges::max_element(cost.seconds) - cost.seconds.begin();
  progress.show(fmt::format("measuring: drawing of run {}", dearest));
  const DrawingCost drawing = measure_drawing(sweep, run_of(sweep, dearest), typed.snakemake);
  workflow.frames = make_frame_chunks(sweep, cost.seconds, drawing, typed.chunk_seconds);
  const double again = simulated_again(workflow.frames, sweep, cost.seconds);
  print_message(
      "pictures in {}, each simulated again from the start, which takes {:.3g} s in all; "
      "drawing takes {:.3g} ms a frame. Going on from states would save no more than that, and "
      "each part would wait for a run ahead of up to {:.3g} s\n",
      counted(std::ssize(workflow.frames), "part"), again, 1e3 * drawing.frame,
      cost.seconds[static_cast<std::size_t>(dearest)]);
}

void write_workflow(const SweepArguments& typed, const Sweep& sweep, Progress& progress) {
  const std::string file = "Snakefile";
  if (!typed.overwrite) {
    refuse_to_replace(std::filesystem::path(typed.snakemake) / file,
                      "choose another folder with --snakemake");
  }
  const StudyFolder folder(typed.snakemake);
  const CostEstimate cost = estimate_cost(sweep, progress);
  Workflow workflow{make_chunks(cost.seconds, typed.chunk_seconds), {}, typed.chunk_seconds};
  if (sweep.frames == SweepFrames::all) add_frame_chunks(typed, sweep, cost, workflow, progress);
  const auto path = folder.write(file, snakefile(sweep, own_program(), workflow));
  fmt::print("{}\n", path.string());
  print_message(
      "{} of together about {:.3g} s on one core ({} measured in {:.2g} s), in {}; here: cd {} "
      "&& snakemake --cores {}\n",
      counted(run_count(sweep), "run"), cost.total(), cost.runs, cost.measured,
      counted(std::ssize(workflow.chunks), "chunk"),
      shell_line(std::vector{folder.path().string()}), machine().cores);
}

void gather(const Sweep& sweep, const std::string& fingerprint, const StudyFolder& folder) {
  const SweepRows rows = gather_chunks(sweep, fingerprint, folder.path());
  join_frame_chunks(rows, folder.path());
  write_results(folder, sweep, rows, fingerprint);
}

ExitCode sweep(SweepArguments typed) {
  if (typed.keys) {
    fmt::print("{}", sweep_reference());
    return ExitCode::done;
  }
  if (typed.file.empty()) {
    throw UsageError("sweep: name a sweep file, or ask for the reference of its keys with --keys");
  }
  Progress progress(progress_style(typed.quiet));
  const Sweep sweep = with_nothing_to_keep([&] { return read_sweep(find_sweep(typed.file)); });
  if (typed.out.empty()) typed.out = "out/sweep/" + sweep.name;
  const std::string fingerprint = with_nothing_to_keep([&] { return sweep_fingerprint(sweep); });
  if (!typed.snakemake.empty()) {
    write_workflow(typed, sweep, progress);
  } else if (!typed.jobs.empty()) {
    run_chunk(sweep, fingerprint, parse_runs(typed.jobs, sweep),
              {.threads = cores_of(typed), .pictures = !typed.no_pictures}, typed.out, progress);
  } else if (!typed.frames.empty()) {
    draw_frame_chunk(sweep, parse_frame_chunk(typed.frames, sweep), typed.out);
  } else if (typed.gather) {
    refuse_old_results(typed, sweep);
    gather(sweep, fingerprint, StudyFolder(typed.out));
  } else {
    return run_here(typed, sweep, fingerprint, progress);
  }
  return ExitCode::done;
}

}  // namespace

void add_sweep_command(CLI::App& app, Action& action, std::span<const std::string> command_line) {
  CLI::App* command = app.add_subcommand(
      "sweep", "Many runs from one file: what is varied, what is measured; here or on a cluster");
  const auto typed = std::make_shared<SweepArguments>();
  typed->command_line.assign(command_line.begin(), command_line.end());
  command->add_option("FILE", typed->file, "A sweep file, or the name of one in scenes/sweeps/")
      ->type_name("SWEEP");
  command
      ->add_option("--out", typed->out, "Folder for table, diagrams and pictures [out/sweep/NAME]")
      ->type_name("DIR");
  command->add_option("--cores", typed->cores, "Runs at once, each on one thread [all cores]")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  auto* overwrite = command->add_flag("--overwrite", typed->overwrite,
                                      "Replace the sweep, or its workflow, in the folder");
  command->add_flag("--resume", typed->resume, "Continue the interrupted sweep in the folder")
      ->excludes(overwrite);
  auto* snakemake =
      command
          ->add_option("--snakemake", typed->snakemake, "Write a workflow of chunks for Snakemake")
          ->type_name("DIR");
  command
      ->add_option("--chunk-seconds", typed->chunk_seconds,
                   "About how long a chunk is to take, as measured here [60]")
      ->type_name("S")
      ->check(number_range(0.1, 1e6))
      ->needs(snakemake);
  auto* jobs =
      command
          ->add_option("--jobs", typed->jobs,
                       "Only these runs, as 100-199, into chunks/; continues what is there")
          ->type_name("A-B");
  jobs->excludes(snakemake)->excludes(overwrite);
  command->add_flag("--no-pictures", typed->no_pictures, "Of --jobs: measure only")->needs(jobs);
  auto* frames =
      command
          ->add_option("--frames", typed->frames,
                       "Only these pictures of one run, as 3:120-179, into a part of their own")
          ->type_name("RUN:A-B");
  frames->excludes(snakemake)->excludes(jobs);
  command->add_flag("--gather", typed->gather, "Put finished chunks together")
      ->excludes(jobs)
      ->excludes(frames)
      ->excludes(snakemake);
  command->add_flag("--keys", typed->keys, "Print the reference of all keys of sweep files");
  add_quiet_option(*command, typed->quiet);
  add_examples(*command,
               {"pneuma sweep gas_and_springs", "pneuma sweep gas_and_springs --snakemake flow",
                "pneuma sweep study.toml --out results --resume",
                "pneuma sweep stability_map --snakemake map",
                "pneuma sweep stability_map --jobs 0-99 --out map",
                "pneuma sweep stability_map --gather --out map", "pneuma sweep --keys"});
  command->callback([typed, &action] { action = [typed] { return sweep(*typed); }; });
}

}  // namespace pneuma::app
