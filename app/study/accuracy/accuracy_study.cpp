#include "app/study/accuracy/accuracy_study.h"

#include <fmt/format.h>

#include "app/accuracy/choose_step.h"
#include "app/study/error/reference.h"
#include "app/world/open_scene.h"

namespace pneuma::app {
namespace {

/// The scene's integrator and step, measured.
ErrorRun measure(const sim::Settings& settings, const Flight& flight, ErrorMeter& meter,
                 const AccuracyOptions& options,
                 const std::function<void(const std::string&)>& say) {
  ErrorOptions one;
  one.integrators = {settings.integrator};
  one.steps_per_second = {settings.steps_per_second};
  one.repeats = options.repeats;
  return measure_runs(flight, meter, one, say).front();
}

}  // namespace

std::string contacts_text(const AccuracyStudy& study) {
  if (study.max_contacts == 0) {
    return fmt::format(
        "{}: nothing touched anything in the {:.4g} s compared; errors with contacts may be "
        "greater.",
        study.name, study.seconds);
  }
  return fmt::format("{}: up to {} contact{} at a time in the {:.4g} s compared.", study.name,
                     study.max_contacts, study.max_contacts == 1 ? "" : "s", study.seconds);
}

AccuracyStudy study_accuracy(const std::string& name, const std::vector<std::string>& overrides,
                             const AccuracyOptions& options,
                             const std::function<void(const std::string&)>& say) {
  const scenes::Scene scene = open_scene(name, overrides);
  FlightOptions flight_options;
  flight_options.seconds = options.seconds;
  const Flight flight = prepare_flight(scene, flight_options);
  say("the reference");
  const Reference reference = make_reference(flight, options.finest_steps_per_second);
  ErrorMeter meter(flight.world, reference.trajectory);
  AccuracyStudy study{scene.name,
                      reference.seconds,
                      reference.uncertainty,
                      max_contacts(flight, reference.seconds),
                      {}};
  study.rows.push_back({"", 0.0, measure(flight.world.settings, flight, meter, options, say)});
  for (const Accuracy accuracy : {Accuracy::picture, Accuracy::hundredth, Accuracy::thousandth}) {
    const scenes::Scene chosen = open_scene(name, overrides, {}, accuracy).scene;
    study.rows.push_back({std::string(to_string(accuracy)), max_error(accuracy),
                          measure(chosen.settings, flight, meter, options, say)});
  }
  return study;
}

}  // namespace pneuma::app
