#include "app/study/study_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>

#include "app/files/refuse_to_replace.h"
#include "app/host/command_line.h"
#include "app/host/errors.h"
#include "app/host/own_program.h"
#include "app/host/standard_streams.h"
#include "app/host/version.h"
#include "app/record/provenance.h"
#include "app/record/world_json.h"
#include "app/study/study_folder.h"
#include "app/terminal/table.h"
#include "scenes/loader/print_scene.h"
#include "sim/base/file.h"
#include "sim/base/hash.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The arguments that say what is measured: not those that say where it is left or how it is told.
std::vector<std::string> what_is_measured(const SplitOptions& typed) {
  static constexpr auto with_value =
      std::to_array<std::string_view>({"--out", "--snakemake", "--part"});
  static constexpr auto flags =
      std::to_array<std::string_view>({"--gather", "--quiet", "--json", "--overwrite"});
  std::vector<std::string> kept;
  for (std::size_t i = 1; i < typed.arguments.size(); ++i) {
    const std::string& argument = typed.arguments[i];
    const std::string_view name = std::string_view(argument).substr(0, argument.find('='));
    if (std::ranges::count(with_value, name) > 0) {
      if (name == argument) ++i;
    } else if (std::ranges::count(flags, name) == 0) {
      kept.push_back(argument);
    }
  }
  return kept;
}

std::string fingerprint_of(const SplitOptions& typed, std::span<const scenes::Scene> scenes) {
  base::Hash hash;
  hash.add(program_json().dump());
  hash.add(shell_line(what_is_measured(typed)));
  for (const scenes::Scene& scene : scenes) hash.add(scenes::scene_fingerprint(scene));
  return hex(hash.value());
}

void require_one_name_each(std::span<const StudyPart> parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (parts[i].name != parts[j].name) continue;
      throw UsageError(
          fmt::format("two parts of the study would be named {}; give every scene once, and files "
                      "of equal names "
                      "in studies of their own",
                      parts[i].name));
    }
  }
}

std::string part_command(const SplitOptions& typed, const std::string& what) {
  std::vector<std::string> words = {own_program()};
  for (std::string& argument : what_is_measured(typed)) words.push_back(std::move(argument));
  words.emplace_back("--out");
  words.push_back(fs::absolute(typed.out).lexically_normal().string());
  return fmt::format("{} {}", shell_line(words), what);
}

fs::path part_file(const fs::path& folder, const StudyPart& part) {
  return folder / "parts" / (part.name + ".json");
}

void refuse_old_part(const SplitOptions& typed, const StudyPart& part) {
  if (typed.overwrite) return;
  refuse_to_replace(part_file(typed.out, part), "choose another folder with --out");
}

/// Leaves it in the folder too, so that --gather finds what was done before an interruption.
json measure_part(const StudyFolder& folder, const std::string& fingerprint,
                  const StudyPart& part) {
  json report = provenance_json();
  report.update({{"study", fingerprint}, {"part", part.name}, {"measured", part.measure()}});
  folder.write(part.name + ".json", report.dump() + '\n');
  return report["measured"];
}

const StudyPart& named_part(const SplitOptions& typed, std::span<const StudyPart> parts) {
  const auto part = std::ranges::find(parts, typed.part, &StudyPart::name);
  if (part == parts.end()) {
    std::vector<std::string> names;
    for (const StudyPart& one : parts) names.push_back(one.name);
    throw UsageError(
        fmt::format("--part {}: the study's parts are {}", typed.part, fmt::join(names, ", ")));
  }
  return *part;
}

json read_part(const fs::path& path, const std::string& fingerprint) {
  const std::string text = base::read_text_file(path.string());
  json report = json::parse(text, nullptr, false);
  if (!report.is_object() || !report.contains("measured")) {
    throw base::IoError(fmt::format("{}: this is no part of a study; remove it", path.string()));
  }
  if (report.value("study", "") == fingerprint) return report["measured"];
  throw base::IoError(fmt::format(
      "{}: it was measured by another command, of other scenes or by another build of the program; "
      "remove it and measure the part again",
      path.string()));
}

std::vector<json> read_parts(const SplitOptions& typed, const std::string& fingerprint,
                             std::span<const StudyPart> parts) {
  std::vector<json> measured;
  for (const StudyPart& part : parts) {
    const fs::path path = part_file(typed.out, part);
    if (!fs::exists(path)) {
      throw base::IoError(fmt::format("{} is missing; make it with: {}", path.string(),
                                      part_command(typed, "--part " + part.name)));
    }
    measured.push_back(read_part(path, fingerprint));
  }
  return measured;
}

constexpr const char* workflow =
    R"(# The study {study} in parts, written by `pneuma study {study} --snakemake`. From this folder:
#   snakemake --cores 1     (times are compared: one part at a time on a machine)
#   snakemake --jobs 100 --cluster "sbatch --parsable --cpus-per-task 1 --exclusive" --latency-wait 60     (Slurm)
PARTS = [
{parts}]

localrules: all, gather

rule all:
    input: "{study}.json"

rule part:
    output: "parts/{{part}}.json"
    retries: 1
    shell: "cd {here} && {command} --part {{wildcards.part}}"

rule gather:
    input: expand("parts/{{part}}.json", part=PARTS)
    output: "{study}.json"
    # 5: a scene could not be compared; the study names it, and is complete without it.
    shell: "cd {here} && {command} --gather --overwrite || [ $? -eq 5 ]"
)";

void write_workflow(SplitOptions typed, const std::string& study,
                    std::span<const StudyPart> parts) {
  typed.out = typed.snakemake;
  if (!typed.overwrite) {
    refuse_to_replace(fs::path(typed.out) / "Snakefile", "choose another folder with --snakemake");
  }
  std::string listed;
  for (const StudyPart& part : parts) listed += fmt::format("    \"{}\",\n", part.name);
  const std::string here = fs::current_path().string();
  const std::string text =
      fmt::format(fmt::runtime(workflow), fmt::arg("study", study), fmt::arg("parts", listed),
                  fmt::arg("here", snakemake_text(shell_line(std::span(&here, 1)))),
                  fmt::arg("command", snakemake_text(part_command(typed, "--quiet"))));
  fmt::print("{}\n", StudyFolder(typed.out).write("Snakefile", text).string());
  print_message("{}; here: cd {} && snakemake --cores 1\n", counted(std::ssize(parts), "part"),
                shell_line(std::span(&typed.out, 1)));
}

}  // namespace

void add_split_options(CLI::App& command, SplitOptions& options,
                       std::span<const std::string> command_line,
                       const std::string& what_is_short) {
  add_study_options(command, options, command_line, what_is_short);
  options.arguments.assign(command_line.begin(), command_line.end());
  auto* snakemake = command
                        .add_option("--snakemake", options.snakemake,
                                    "Measure nothing: write a workflow of parts for Snakemake")
                        ->type_name("DIR")
                        ->excludes(command.get_option("--out"));
  auto* part =
      command
          .add_option("--part", options.part, "Measure only this part of the workflow, into parts/")
          ->type_name("NAME")
          ->excludes(snakemake);
  command.add_flag("--gather", options.gather, "Put measured parts together")
      ->excludes(snakemake)
      ->excludes(part);
}

std::string part_name(std::initializer_list<std::string> words) {
  std::string name;
  for (const std::string& word : words) {
    if (!name.empty()) name += '.';
    for (const char c : word) {
      const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '-' || c == '.';
      name += plain ? c : '_';
    }
  }
  return name;
}

std::optional<std::vector<json>> measure_parts(const SplitOptions& typed, const SplitStudy& study,
                                               std::span<const scenes::Scene> scenes,
                                               std::span<const StudyPart> parts) {
  require_one_name_each(parts);
  if (!typed.snakemake.empty()) {
    write_workflow(typed, study.name, parts);
    return {};
  }
  const std::string fingerprint = fingerprint_of(typed, scenes);
  if (typed.part.empty()) refuse_old_files(typed, study.leaves);
  if (typed.gather) return read_parts(typed, fingerprint, parts);
  const StudyFolder folder(fs::path(typed.out) / "parts");
  if (!typed.part.empty()) {
    const StudyPart& part = named_part(typed, parts);
    refuse_old_part(typed, part);
    measure_part(folder, fingerprint, part);
    fmt::print("{}\n", part_file(typed.out, part).string());
    return {};
  }
  for (const StudyPart& part : parts) refuse_old_part(typed, part);
  std::vector<json> measured;
  for (const StudyPart& part : parts) {
    measured.push_back(measure_part(folder, fingerprint, part));
  }
  return measured;
}

}  // namespace pneuma::app
