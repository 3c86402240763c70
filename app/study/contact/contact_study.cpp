#include "app/study/contact/contact_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/accuracy/accuracy.h"
#include "app/host/errors.h"
#include "sim/base/enum_name.h"
#include "sim/world/paper_method.h"

namespace pneuma::app {
namespace {

using Status = ErrorRun::Status;

constexpr std::array all_forms = {ContactForm::swept, ContactForm::impulses, ContactForm::potential,
                                  ContactForm::paper};
// Of the error that is asked for: better must be known.
constexpr double known_fraction = 0.5;
constexpr double seconds_of_contact = 1.0;

sim::World world_by(ContactForm form, sim::World world) {
  switch (form) {
    case ContactForm::swept:
      world.settings.contact = sim::ContactMethod::swept;
      break;
    case ContactForm::impulses:
      world.settings.contact = sim::ContactMethod::impulses;
      break;
    case ContactForm::potential:
      world.settings.contact = sim::ContactMethod::potential;
      break;
    case ContactForm::paper:
      sim::use_paper_method(world);
      break;
  }
  return world;
}

/// Static and moved boxes came after the paper's contacts, whose scenes must not have them.
bool takes(ContactForm form, const sim::World& world) {
  return form == ContactForm::swept || form == ContactForm::potential ||
         std::ranges::none_of(world.rigid, &sim::RigidBox::is_kinematic);
}

Flight flight_of(const scenes::Scene& scene, const ContactOptions& options) {
  scenes::Scene by_potential = scene;
  by_potential.settings.contact = sim::ContactMethod::potential;
  FlightOptions whole;
  whole.seconds = options.seconds.value_or(scene.duration);
  Flight flight = prepare_flight(by_potential, whole);
  if (!flight.first_contact) {
    throw UsageError(
        fmt::format("{}: nothing touches in the first {:.4g} s: `pneuma study error` measures that",
                    scene.name, flight.seconds));
  }
  if (!options.seconds) {
    flight.seconds =
        std::min(flight.seconds, whole_samples(*flight.first_contact + seconds_of_contact));
  }
  return flight;
}

bool is_cheaper(const ErrorRun& one, const ErrorRun& other) {
  return one.run_time < other.run_time;
}
bool is_better(const ErrorRun& one, const ErrorRun& other) {
  return error_of(one) < error_of(other);
}

/// Of the stable runs that count the first in an order.
template <class Counts, class ComesBefore>
void choose_first(const ContactStudy& study, const Counts& counts, const ComesBefore& comes_before,
                  ContactChoice& choice) {
  for (const ContactRuns& runs : study.forms) {
    for (const ErrorRun& run : runs.runs) {
      if (run.status != Status::stable || !counts(runs.form, run)) continue;
      if (choice.form && !comes_before(run, choice.run)) continue;
      choice.form = runs.form;
      choice.run = run;
    }
  }
}

/// With an error of at most `greatest`; `counts` says of which runs.
template <class Counts>
ContactChoice cheapest(const ContactStudy& study, std::string purpose, double greatest,
                       const Counts& counts) {
  ContactChoice choice{.purpose = std::move(purpose), .form = {}, .run = {}};
  choice.known =
      reaches_a_contact(study) && study.limit.reference.uncertainty <= known_fraction * greatest;
  const auto is_good = [&](ContactForm form, const ErrorRun& run) {
    return counts(form, run) && error_of(run) <= greatest;
  };
  if (choice.known) choose_first(study, is_good, is_cheaper, choice);
  return choice;
}

bool gives_a_guarantee(ContactForm form, const ErrorRun& run) {
  return form == ContactForm::potential &&
         (run.method == "implicit_euler" || run.method == "sdirk2");
}

ContactChoice guarantee(const ContactStudy& study) {
  ContactChoice choice =
      cheapest(study, "guarantee", max_error(Accuracy::picture), gives_a_guarantee);
  if (!choice.form && reaches_a_contact(study)) {
    choose_first(study, gives_a_guarantee, is_better, choice);
  }
  return choice;
}

}  // namespace

std::string_view to_string(ContactForm form) {
  static constexpr auto names =
      std::to_array<std::string_view>({"swept", "impulses", "potential", "paper"});
  return base::enum_name(names, form);
}

bool reaches_a_contact(const ContactStudy& study) {
  return study.limit.reference.seconds > study.first_contact;
}

ContactOptions full_contact_options() {
  ContactOptions options;
  options.errors = full_sweep();
  options.errors.steps_per_second.resize(8);  // to 1/1920 s
  options.errors.repeats = 2;
  options.errors.longest_run = 5.0;
  return options;
}

ContactOptions short_contact_options() {
  ContactOptions options;
  options.errors = short_sweep();
  options.errors.steps_per_second.resize(4);  // to 1/120 s
  options.errors.repeats = 1;
  options.errors.longest_run = 1.0;
  options.limit = {.halvings = 4, .longest_run = 2.0};
  return options;
}

std::vector<ContactChoice> choose_contacts(const ContactStudy& study) {
  const auto any = [](ContactForm, const ErrorRun&) { return true; };
  std::vector<ContactChoice> choices;
  choices.push_back(cheapest(study, "picture", max_error(Accuracy::picture), any));
  for (const Accuracy accuracy : {Accuracy::hundredth, Accuracy::thousandth}) {
    choices.push_back(cheapest(study, std::string(to_string(accuracy)), max_error(accuracy), any));
  }
  choices.push_back(guarantee(study));
  return choices;
}

std::vector<ErrorRun> cheapest_runs(const ContactRuns& runs) {
  std::vector<ErrorRun> stable;
  std::ranges::copy_if(runs.runs, std::back_inserter(stable),
                       [](const ErrorRun& run) { return run.status == Status::stable; });
  std::ranges::sort(stable, {}, &ErrorRun::run_time);
  std::vector<ErrorRun> front;
  for (const ErrorRun& run : stable) {
    if (front.empty() || error_of(run) < error_of(front.back())) front.push_back(run);
  }
  return front;
}

ContactStudy study_contacts(const scenes::Scene& scene, const ContactOptions& options,
                            const std::function<void(const std::string&)>& say) {
  ContactStudy study;
  study.name = scene.name;
  study.title = scene.title;
  say("what touches");
  const Flight flight = flight_of(scene, options);
  study.seconds = flight.seconds;
  study.first_contact = *flight.first_contact;
  study.rest_radius = radius_of_first_body(flight.world);
  study.limit = find_contact_limit(flight, options.limit, say);
  ErrorMeter meter(flight.world, study.limit.reference.trajectory);
  ErrorOptions errors = options.errors;
  errors.tolerances.clear();  // ours alone
  for (const ContactForm form : all_forms) {
    if (!takes(form, flight.world)) continue;
    Flight by_form = flight;
    by_form.world = world_by(form, flight.world);
    const auto say_form = [&](const std::string& what) {
      say(fmt::format("{}, {}", to_string(form), what));
    };
    study.forms.push_back({form, measure_runs(by_form, meter, errors, say_form)});
  }
  return study;
}

}  // namespace pneuma::app
