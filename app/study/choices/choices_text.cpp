#include <fmt/format.h>

#include "app/study/choices/choices_report.h"
#include "app/study/choices/martin.h"
#include "app/study/report_text.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

using Align = Table::Align;

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.3g}", *value) : "-";
}

/// Both dampings side by side, a row per step.
std::string damping_table(const DampingStudy& study) {
  constexpr const char* fall = "fall speed, m/s";
  constexpr const char* swing = "swing left";
  Table table({{"step, s"},
               {"dashpot", Align::right, fall},
               {"literal", Align::right, fall},
               {"dashpot", Align::right, swing},
               {"literal", Align::right, swing}});
  const std::size_t rates = study.runs.size() / 2;
  for (std::size_t i = 0; i < rates; ++i) {
    const DampingRun& dashpot = study.runs[i];
    const DampingRun& literal = study.runs[rates + i];
    table.add_row({fmt::format("1/{}", dashpot.steps_per_second), number(dashpot.fall_speed),
                   number(literal.fall_speed), number(dashpot.swing_left),
                   number(literal.swing_left)});
  }
  return table.text();
}

}  // namespace

std::string choices_text(const ChoicesStudy& study) {
  std::string text = fmt::format("{}: {}\n\n", study.name, study.title);
  text += fmt::format(
      "Pressure, uniform or valence (ERRATA row 4): {} trials from vertices moved by "
      "up to {:.2g} m, no gravity\n",
      study.drift.uniform.size(), study.drift.perturbation);
  text += list_item(drift_sentence(study.drift));
  text += fmt::format("\nDamping, dashpot or literal (ERRATA row 5), {:g} s with rk4\n",
                      study.damping.seconds);
  text += damping_table(study.damping);
  text += "\"-\": diverged, or there is no swing\n";
  for (const std::string& sentence : damping_sentences(study.damping)) text += list_item(sentence);
  text += fmt::format(
      "\nThe paper's integrator beside the others (ERRATA row 7), {:.3g} s of free "
      "flight\n",
      study.integrators.reference.seconds);
  for (const std::string& sentence : martin_sentences(study.integrators))
    text += list_item(sentence);
  return text;
}

}  // namespace pneuma::app
