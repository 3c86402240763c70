#include <fmt/format.h>

#include <optional>
#include <utility>

#include "app/study/error/solver.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

/// Everything moves, nothing touches.
sim::Plan flight_plan(const sim::World& world) {
  using sim::Stage;
  sim::Plan plan = sim::make_plan(world);
  for (const Stage stage :
       {Stage::broad_phase, Stage::move_particles, Stage::find_contacts, Stage::resolve_contacts}) {
    plan.stages[static_cast<std::size_t>(stage)] = {false, "free flight"};
  }
  return plan;
}

class StepperSolver final : public Solver {
 public:
  StepperSolver(sim::World world, bool contacts)
      : world_(std::move(world)),
        stepper_(world_, {.plan = contacts ? sim::make_plan(world_) : flight_plan(world_)}) {}

  bool advance(std::size_t i) override {
    const auto last =
        static_cast<std::int64_t>(i + 1) * (world_.settings.steps_per_second / samples_per_second);
    while (world_.steps < last) {
      divergence_ = stepper_.step(world_);
      if (divergence_) return false;
    }
    return true;
  }

  Sample sample() const override { return take_sample(world_); }

  std::string failure() const override {
    return divergence_ ? fmt::format("at {:.4g} s: {}", failure_time(), divergence_->what) : "";
  }
  double failure_time() const override {
    return static_cast<double>(divergence_ ? divergence_->step : world_.steps) *
           sim::time_step(world_.settings);
  }
  long evaluations() const override { return 0; }

 private:
  sim::World world_;
  sim::Stepper stepper_;
  std::optional<sim::Divergence> divergence_;
};

}  // namespace

std::unique_ptr<Solver> make_stepper_solver(sim::World world, bool contacts) {
  return std::make_unique<StepperSolver>(std::move(world), contacts);
}

}  // namespace pneuma::app
