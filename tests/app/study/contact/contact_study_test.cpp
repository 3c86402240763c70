#include "app/study/contact/contact_study.h"

#include <gtest/gtest.h>

#include "app/host/errors.h"
#include "app/study/contact/contact_report.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/crossings.h"
#include "tests/app/study/error/small_study.h"

namespace pneuma::app {
namespace {

const auto says_nothing = [](const std::string&) {};

/// Two small balls that meet in the air.
scenes::Scene balls(double distance) {
  return scenes::parse_scene(
      "title = \"Two balls\"\nduration = 1.0\n[simulation]\ngravity = [0, 0, 0]\n[ground]\npresent "
      "= false\n[[body]]\nshape = \"icosphere\"\nsubdivisions = 1\nposition = [-1.05, 0, 0]\n"
      "radius = 1.0\ninflation = 1.05\nvelocity = [0.5, 0, 0]\n[[body]]\nshape = "
      "\"icosphere\"\nsubdivisions = 1\n"
      "position = [1.05, 0.2, 0]\nradius = 1.0\ninflation = 1.05\nvelocity = [-0.5, 0, 0]\n",
      "balls.toml",
      std::vector<std::string>{"simulation.contact=potential",
                               "simulation.potential.distance=" + std::to_string(distance)});
}

Flight flight_of_balls() {
  FlightOptions options;
  options.seconds = 0.4;
  return prepare_flight(balls(0.02), options);
}

TEST(ContactLimit, IsApproachedWithTheDistance) {
  const Flight flight = flight_of_balls();
  ASSERT_TRUE(flight.contacts);
  const ContactLimit limit =
      find_contact_limit(flight, {.halvings = 4, .longest_run = 60.0}, says_nothing);
  ASSERT_EQ(limit.distances.size(), 5U);
  for (std::size_t i = 1; i < limit.errors.size(); ++i) {
    EXPECT_EQ(limit.distances[i], 0.5 * limit.distances[i - 1]);
    // Of first order halved; friction and restitution have not quite the same share at each.
    EXPECT_LT(limit.errors[i], 0.75 * limit.errors[i - 1]) << limit.distances[i];
  }
  EXPECT_LT(limit.reference.uncertainty, 0.5 * limit.errors.back());
}

// Adams' method has steps that are longer than a thin potential is wide.
TEST(ContactReference, CrossesNothing) {
  sim::World world = flight_of_balls().world;
  for (const double distance : {2e-3, 1e-3, 5e-4}) {
    world.settings.potential.distance = distance;
    const auto solver = make_contact_reference_solver(world, 1e-6);
    const Trajectory motion = follow(*solver, 6);
    ASSERT_EQ(motion.size(), 6U) << solver->failure();
    for (const Sample& sample : motion) {
      for (std::size_t b = 0; b < world.soft.size(); ++b) {
        world.soft[b].positions = sample.soft[b].positions;
      }
      EXPECT_EQ(sim::crossings(world).between_bodies, 0) << distance;
    }
  }
}

ContactStudy made_up_contacts() {
  ContactStudy study;
  study.name = "made_up";
  study.title = "Made up";
  study.seconds = 1.0;
  study.rest_radius = 3.0;
  study.limit.reference.seconds = 1.0;
  study.limit.reference.method = "nothing";
  study.limit.reference.uncertainty = 1e-3;
  study.limit.distances = {0.1};
  study.limit.errors = {1e-2};
  study.forms = {{ContactForm::swept,
                  {made_up_run("rk4", 30, 4e-2, 1e-3), made_up_run("rk4", 60, 8e-3, 2e-3),
                   made_up_run("rk4", 120, 9e-3, 4e-3), made_up_unstable_run("rk4", 240)}},
                 {ContactForm::potential,
                  {made_up_run("rk4", 60, 1e-3, 1e-4), made_up_run("implicit_euler", 60, 3e-2, 0.1),
                   made_up_run("sdirk2", 60, 2e-3, 0.5)}}};
  return study;
}

TEST(ContactChoices, AreTheCheapestThatAreGoodEnough) {
  ContactStudy study = made_up_contacts();
  std::vector<ContactChoice> choices = choose_contacts(study);
  ASSERT_EQ(choices.size(), 4U);
  EXPECT_EQ(choices[0].form, ContactForm::potential);
  EXPECT_EQ(choices[1].run.run_time, 1e-4);
  EXPECT_FALSE(choices[2].known);  // to 1e-3, of 1e-3
  EXPECT_EQ(choices[3].run.method, "implicit_euler");
  study.forms[1].runs[0].run_time = 1.0;
  choices = choose_contacts(study);
  EXPECT_EQ(choices[0].form, ContactForm::swept);
  EXPECT_EQ(choices[0].run.steps_per_second, 30);
  EXPECT_EQ(choices[1].run.steps_per_second, 60);
}

TEST(ContactChoices, AreNoneWhereNothingTouches) {
  ContactStudy study = made_up_contacts();
  EXPECT_EQ(contact_text(study).find("Nothing touches"), std::string::npos);
  study.first_contact = 1.1;
  for (const ContactChoice& choice : choose_contacts(study)) EXPECT_FALSE(choice.form);
  EXPECT_NE(contact_text(study).find("Nothing touches until then, the first time at 1.1 s"),
            std::string::npos);
}

TEST(ContactChoices, TakeTheBestGuaranteeWhereNoneIsGoodEnough) {
  ContactStudy study = made_up_contacts();
  study.forms[1].runs[1].errors.greatest.position = 0.2;
  study.forms[1].runs[2].errors.greatest.position = 0.1;
  EXPECT_EQ(choose_contacts(study)[3].run.method, "sdirk2");
  study.forms[1].runs.resize(1);
  EXPECT_EQ(choose_contacts(study)[3].form, std::nullopt);
}

TEST(ContactChoices, OfTheCheapestRunsEachIsBetterThanThoseBefore) {
  const std::vector<ErrorRun> front = cheapest_runs(made_up_contacts().forms[0]);
  ASSERT_EQ(front.size(), 2U);
  EXPECT_EQ(front[0].steps_per_second, 30);
  EXPECT_EQ(front[1].steps_per_second, 60);
}

TEST(ContactReport, HasEveryRun) {
  const ContactStudy study = made_up_contacts();
  EXPECT_NE(contact_text(study).find("1/30  4.0e-02"), std::string::npos);
  EXPECT_NE(advice_text(std::vector{study}).find("not known"), std::string::npos);
  const std::string csv = contact_csv(study);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 8);
  EXPECT_EQ(contact_diagram(study).series.size(), 3U);
}

TEST(ContactStudy, ComparesAllFormsWithOneMotion) {
  ContactOptions options = short_contact_options();
  options.errors.steps_per_second = {60, 120};
  const ContactStudy study = study_contacts(balls(0.02), options, says_nothing);
  ASSERT_EQ(study.forms.size(), 4U);
  EXPECT_EQ(study.forms[0].runs.size(), 14U);  // seven integrators at two steps
  EXPECT_EQ(study.forms[3].runs.size(), 2U);   // the paper's alone
  for (const ContactRuns& form : study.forms) {
    EXPECT_FALSE(cheapest_runs(form).empty()) << to_string(form.form);
  }
}

TEST(ContactStudy, ComparesAStaticBoxOnlyByContactsThatKnowIt) {
  scenes::Scene scene = balls(0.02);
  scenes::BodyScene& box = scene.bodies.emplace_back();
  box.name = "table";
  box.kind = scenes::BodyKind::fixed;
  box.shape = scenes::Shape::box;
  box.position = {0.0, 0.0, -9.0};
  ContactOptions options = short_contact_options();
  options.errors.steps_per_second = {60};
  const ContactStudy study = study_contacts(scene, options, says_nothing);
  ASSERT_EQ(study.forms.size(), 2U);
  EXPECT_EQ(study.forms[0].form, ContactForm::swept);
  EXPECT_EQ(study.forms[1].form, ContactForm::potential);
  EXPECT_NE(contact_text(study).find("no static"), std::string::npos);
}

TEST(ContactStudy, RefusesWhereNothingTouches) {
  EXPECT_THROW(study_contacts(small_scene(), short_contact_options(), says_nothing), UsageError);
}

}  // namespace
}  // namespace pneuma::app
