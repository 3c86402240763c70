#include "app/study/choices/martin.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "app/study/error/conclusions.h"
#include "app/study/report_text.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

using Status = ErrorRun::Status;

constexpr const char* martin = "martin";
constexpr int paper_steps_per_second = 60;
constexpr double asked_error = 1e-2;

const ErrorRun* stable_run(const ErrorStudy& study, const std::string& method, int rate) {
  const auto run = std::ranges::find_if(study.runs, [&](const ErrorRun& candidate) {
    return candidate.ours && candidate.method == method && candidate.steps_per_second == rate &&
           candidate.status == Status::stable && error_of(candidate) > 0.0;
  });
  return run == study.runs.end() ? nullptr : &*run;
}

std::string microseconds(const ErrorRun& run) { return readable(1e6 * run.run_time); }

std::string sentence(const MartinComparison& comparison) {
  return fmt::format(
      "at 1/{} s the error of martin is {} times that of {}, at {:.2g} times its run time",
      comparison.steps_per_second, readable(comparison.error_ratio), comparison.other,
      comparison.time_ratio);
}

std::string what_an_error_takes(const ErrorStudy& study) {
  ErrorStudy only_martin = study;
  std::erase_if(only_martin.runs, [](const ErrorRun& run) { return run.method != martin; });
  const Choice slow = choose(only_martin, asked_error), best = choose(study, asked_error);
  if (!slow.ours || !best.ours) {
    return fmt::format("an error of {} martin reaches at none of the steps studied",
                       power_of_ten(asked_error));
  }
  return fmt::format(
      "an error of {} takes martin a step of 1/{} s and {} us per simulated second; {} does with "
      "1/{} "
      "s and {} us, {:.2g} times as fast",
      power_of_ten(asked_error), slow.ours->steps_per_second, microseconds(*slow.ours),
      best.ours->method, best.ours->steps_per_second, microseconds(*best.ours),
      slow.ours->run_time / best.ours->run_time);
}

}  // namespace

std::vector<MartinComparison> compare_martin(const ErrorStudy& study) {
  std::vector<MartinComparison> comparisons;
  for (const ErrorRun& run : study.runs) {
    if (!run.ours || run.method == martin) continue;
    const ErrorRun* ours = stable_run(study, martin, run.steps_per_second);
    const ErrorRun* other = stable_run(study, run.method, run.steps_per_second);
    if (ours == nullptr || other == nullptr) continue;
    comparisons.push_back({run.method, run.steps_per_second, error_of(*ours) / error_of(*other),
                           ours->run_time / other->run_time});
  }
  return comparisons;
}

std::vector<std::string> martin_sentences(const ErrorStudy& study) {
  std::vector<std::string> sentences;
  std::set<std::string> said;
  for (const MartinComparison& comparison : compare_martin(study)) {
    if (comparison.steps_per_second < paper_steps_per_second) continue;
    if (said.insert(comparison.other).second) sentences.push_back(sentence(comparison));
  }
  sentences.push_back(what_an_error_takes(study));
  return sentences;
}

}  // namespace pneuma::app
