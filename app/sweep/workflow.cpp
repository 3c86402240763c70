#include "app/sweep/workflow.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/host/clock.h"
#include "app/host/command_line.h"
#include "app/host/interrupt.h"
#include "app/sweep/frame_chunks.h"
#include "app/sweep/sweep_chunks.h"
#include "app/sweep/sweep_row.h"
#include "app/world/open_scene.h"

namespace pneuma::app {
namespace {

constexpr double seconds_to_measure = 10.0;
constexpr int most_measured = 32;
constexpr int vertices_of_model = 1000;  // only its file knows
constexpr int vertices_of_world = 50;    // what a step takes however small its bodies

/// Steps times vertices; 0 of a run that cannot be loaded.
double work_of(const Sweep& sweep, const SweepRun& run) {
  try {
    const scenes::Scene scene = open_scene(run.scene_path, run.overrides(sweep));
    double vertices = vertices_of_world;
    for (const scenes::BodyScene& body : scene.bodies) {
      const std::int64_t one = scenes::vertex_count(body);
      vertices +=
          static_cast<double>((one > 0 ? one : vertices_of_model) * scenes::copy_count(body));
    }
    const double frames = static_cast<double>(scenes::frame_count(scene));
    return frames * scenes::steps_per_frame(scene) * vertices;
  } catch (const std::exception&) {
    return 0.0;
  }
}

/// Every number below `count` once, each as far as may be from those before (van der Corput).
std::int64_t spread_number(std::int64_t i, std::int64_t count) {
  double fraction = 0.0, digit = 0.5;
  for (std::int64_t rest = i + 1; rest > 0; rest /= 2, digit *= 0.5) {
    if (rest % 2 == 1) fraction += digit;
  }
  return std::min(count - 1, static_cast<std::int64_t>(fraction * static_cast<double>(count)));
}

}  // namespace

double CostEstimate::total() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

CostEstimate estimate_cost(const Sweep& sweep, Progress& progress) {
  CostEstimate estimate;
  const std::int64_t count = run_count(sweep);
  for (std::int64_t i = 0; i < count; ++i) {
    throw_if_interrupted();
    estimate.seconds.push_back(work_of(sweep, run_of(sweep, i)));
  }
  Sweep without_pictures = sweep;
  without_pictures.frames = SweepFrames::none;
  const auto start = Clock::now();
  double work = 0.0, seconds = 0.0;
  while (estimate.runs < most_measured && estimate.runs < count &&
         (estimate.runs == 0 || seconds_since(start) < seconds_to_measure)) {
    const std::int64_t number = spread_number(estimate.runs, count);
    progress.show(fmt::format("measuring: run {}", number));
    // Also of one that diverges early: others like it will.
    seconds += run_one(without_pictures, run_of(sweep, number), {}).seconds;
    work += estimate.seconds[static_cast<std::size_t>(number)];
    ++estimate.runs;
  }
  estimate.measured = seconds_since(start);
  for (double& one : estimate.seconds) one *= work > 0.0 ? seconds / work : 0.0;
  return estimate;
}

std::vector<RunRange> make_chunks(const std::vector<double>& seconds, double most_seconds) {
  std::vector<RunRange> chunks;
  double sum = 0.0;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    if (chunks.empty() || sum + seconds[i] > most_seconds) {
      chunks.push_back({number, number});
      sum = 0.0;
    }
    chunks.back().last = number;
    sum += seconds[i];
  }
  return chunks;
}

namespace {

std::string listed(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += fmt::format("    \"{}\",\n", item);
  return text;
}

constexpr const char* head =
    R"(# The sweep {name} in chunks of about {seconds:g} s, written by `pneuma sweep --snakemake`. From this folder:
#   snakemake --cores 2
#   snakemake --jobs 100 --cluster "sbatch --parsable --cpus-per-task 1" --latency-wait 60     (Slurm)
# What was interrupted goes on where it was, with --rerun-incomplete if Snakemake asks for it.
CHUNKS = [
{chunks}]
FRAMES = [
{frames}]

localrules: all, gather

rule all:
    input: "{name}.csv", "{name}.json"

rule chunk:
    output: "chunks/{{first}}-{{last}}.json"
    wildcard_constraints: first="[0-9]+", last="[0-9]+"
    retries: 3
    shell: "{command} --jobs {{wildcards.first}}-{{wildcards.last}}{no_pictures}"

rule frames:
    output: "pictures/run_{{run}}/{{first}}-{{last}}/run.json"
    wildcard_constraints: run="[0-9]+", first="[0-9]+", last="[0-9]+"
    retries: 3
    shell: "{command} --frames {{wildcards.run}}:{{wildcards.first}}-{{wildcards.last}}"

rule gather:
    input: expand("chunks/{{chunk}}.json", chunk=CHUNKS), expand("pictures/{{frames}}/run.json", frames=FRAMES)
    output: "{name}.csv", "{name}.json"
    shell: "{command} --gather --overwrite"
)";

}  // namespace

std::string snakefile(const Sweep& sweep, const std::string& program, const Workflow& workflow) {
  std::vector<std::string> chunks, frames;
  for (const RunRange& chunk : workflow.chunks) chunks.push_back(range_text(chunk));
  for (const FrameChunk& chunk : workflow.frames) {
    frames.push_back(fmt::format("run_{}/{}-{}", chunk.run, chunk.first, chunk.last));
  }
  return fmt::format(
      fmt::runtime(head), fmt::arg("name", sweep.name),
      fmt::arg("seconds", workflow.seconds_per_chunk), fmt::arg("chunks", listed(chunks)),
      fmt::arg("frames", listed(frames)),
      fmt::arg("command", snakemake_text(shell_line(std::vector<std::string>{
                              program, "sweep", sweep.file.string(), "--out", ".", "--quiet"}))),
      fmt::arg("no_pictures", frames.empty() ? "" : " --no-pictures"));
}

}  // namespace pneuma::app
