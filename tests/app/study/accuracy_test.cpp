// --accuracy: what it chooses keeps the error that it names, is stable, and leaves what is given.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/accuracy/choose_step.h"
#include "app/host/errors.h"
#include "app/study/error/error_meter.h"
#include "app/study/error/reference.h"
#include "app/study/error/solver.h"
#include "app/world/build_world.h"
#include "sim/soft/stability_limit.h"
#include "tests/support/run_pneuma.h"

namespace pneuma::app {
namespace {

scenes::Scene chosen(const std::string& name, Accuracy accuracy,
                     const std::vector<std::string>& overrides = {}) {
  return open_scene(name, overrides, {}, accuracy).scene;
}

/// Over the rest radius, in as much of the time as is known.
double error_of(const scenes::Scene& scene, double seconds) {
  const Flight flight =
      prepare_flight(scene, {.body = "", .free_flight = false, .seconds = seconds});
  const Reference reference = make_reference(flight, 7680);
  EXPECT_GT(reference.seconds, 0.4) << scene.name;
  ErrorMeter meter(flight.world, reference.trajectory);
  const auto solver = make_stepper_solver(flight.world, flight.contacts);
  Trajectory trajectory;
  while (trajectory.size() < reference.trajectory.size()) {
    EXPECT_TRUE(solver->advance(trajectory.size())) << scene.name << ": " << solver->failure();
    trajectory.push_back(solver->sample());
  }
  return meter.errors(trajectory).greatest.position;
}

TEST(Accuracy, IsReached) {
  for (const char* name : {"one_sphere", "one_torus", "two_spheres_contact", "torus_four_cubes"}) {
    for (const Accuracy accuracy : {Accuracy::picture, Accuracy::hundredth}) {
      EXPECT_LT(error_of(chosen(name, accuracy), 0.8), max_error(accuracy))
          << name << ' ' << to_string(accuracy);
    }
  }
  EXPECT_LT(error_of(chosen("one_sphere", Accuracy::thousandth), 0.8), 1e-3);
  for (const char* name : {"pressure_soft", "torus_three_spheres"}) {
    EXPECT_LT(error_of(chosen(name, Accuracy::hundredth), 1.2), 1e-2) << name;
  }
}

// Its springs are so stiff that few implicit steps stand beside hundreds of explicit ones, each of
// which is cheaper by far more than that.
TEST(Accuracy, TheCatIsSteppedExplicitly) {
  const scenes::Scene scene = chosen("cat_on_sphere", Accuracy::picture);
  EXPECT_FALSE(sim::is_implicit(scene.settings.integrator));
}

TEST(Accuracy, StaysWithinTheLimitOfStability) {
  for (const char* k : {"body.k=1e3", "body.k=1e5", "body.k=1e7"}) {
    const scenes::Scene scene = chosen("one_sphere", Accuracy::picture, {k, "body.k_max=1e9"});
    const sim::World world = build_world(scene);
    const double limit =
        sim::settled_stability_limit(world.settings.integrator, world.soft[0]).step;
    EXPECT_LT(1.0 / world.settings.steps_per_second, limit) << k;
  }
}

TEST(Accuracy, LeavesWhatIsGiven) {
  const scenes::Scene scene =
      chosen("one_sphere", Accuracy::hundredth, {"simulation.integrator=rk4"});
  EXPECT_EQ(scene.settings.integrator, sim::Integrator::rk4);
  EXPECT_GT(chosen("one_sphere", Accuracy::thousandth).settings.steps_per_second,
            chosen("one_sphere", Accuracy::hundredth).settings.steps_per_second);
  const auto message = [](const std::vector<std::string>& overrides) -> std::string {
    try {
      chosen("one_sphere", Accuracy::hundredth, overrides);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({"simulation.steps_per_second=30"}).find("are too few: at least"),
            std::string::npos);
  EXPECT_NE(message({"simulation.method=paper"}).find("--accuracy 1e-2: simulation.method"),
            std::string::npos);
  EXPECT_NE(message({"simulation.contact=potential"}).find("leave out --set simulation.contact"),
            std::string::npos);
}

TEST(Accuracy, OfAnotherNameIsRefused) {
  const ProgramResult result = run_pneuma("check one_sphere --accuracy fine 2>&1");
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_NE(result.output.find("1e-2"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace pneuma::app
