#include "benchmarks/peer/simulation.h"

#include "app/world/replay.h"
#include "sim/step/stepper.h"

namespace pneuma::benchmarks {
namespace {

class ByBullet : public Simulation {
 public:
  ByBullet(const sim::World& start, const BulletOptions& options)
      : bullet_(start, options), state_(start) {}
  void advance(int count) override {
    for (int i = 0; i < count; ++i) bullet_.step();
  }
  std::size_t contact_count() const override { return bullet_.contact_count(); }
  const sim::World& state() override {
    bullet_.copy_state(state_);
    return state_;
  }

 private:
  BulletWorld bullet_;
  sim::World state_;
};

class ByOurs : public Simulation {
 public:
  ByOurs(const sim::World& start, std::string name, int threads)
      : name_(std::move(name)), world_(start), stepper_(world_, options(threads)) {}
  void advance(int count) override { app::advance(stepper_, world_, count, name_); }
  std::size_t contact_count() const override { return stepper_.contacts().size(); }
  const sim::World& state() override { return world_; }

 private:
  static sim::StepperOptions options(int threads) {
    sim::StepperOptions options;
    options.threads = threads;
    return options;
  }

  std::string name_;
  sim::World world_;
  sim::Stepper stepper_;
};

}  // namespace

std::unique_ptr<Simulation> simulate_by_bullet(const sim::World& start,
                                               const BulletOptions& options) {
  return std::make_unique<ByBullet>(start, options);
}

std::unique_ptr<Simulation> simulate_by_ours(const sim::World& start, const std::string& name,
                                             int threads) {
  return std::make_unique<ByOurs>(start, name, threads);
}

}  // namespace pneuma::benchmarks
