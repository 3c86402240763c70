#include "sim/step/stepper.h"

#include <chrono>
#include <map>
#include <stdexcept>

#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// Runs one stage if the plan has it, and takes its time if asked to.
class StageRunner {
 public:
  explicit StageRunner(StepWorkspace& workspace) : workspace_(workspace) {}

  template <class Work>
  void operator()(Stage stage, const Work& work) const {
    if (!workspace_.plan.runs(stage)) return;
    if (!workspace_.options.profile) return work();
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    workspace_.stage_times[static_cast<std::size_t>(stage)] += taken.count();
  }

 private:
  StepWorkspace& workspace_;
};

SoftScratch make_soft_scratch(const World& world, int threads) {
  SoftScratch scratch;
  scratch.per_thread.resize(at(threads));
  std::map<const SoftMesh*, int> known;
  for (const SoftBody& body : world.soft) {
    if (!can_integrate(world.settings.integrator, body.material)) {
      throw std::invalid_argument(body.name +
                                  ": implicit integrators cannot step valence pressure");
    }
    const auto [entry, added] = known.try_emplace(body.mesh.get(), static_cast<int>(known.size()));
    if (added) {
      for (auto& meshes : scratch.per_thread) {
        meshes.emplace_back(*body.mesh, world.settings.integrator);
      }
    }
    scratch.mesh_of_body.push_back(entry->second);
  }
  return scratch;
}

std::vector<std::uint8_t> find_filled_centres(const World& world) {
  std::vector<std::uint8_t> filled;
  for (const SoftBody& body : world.soft) filled.push_back(has_filled_centre(*body.mesh) ? 1 : 0);
  return filled;
}

/// Takes back what the stages up to the one that failed have done.
void restore(World& world, StepWorkspace& workspace, Stage failed) {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    world.soft[i].positions = workspace.soft_start[i].positions;
    world.soft[i].velocities = workspace.soft_start[i].velocities;
  }
  if (failed == Stage::integrate_soft) return;
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    RigidBox& box = world.rigid[i];
    const RigidStart& start = workspace.rigid_start[i];
    box.position = start.position;
    box.orientation = start.orientation;
    box.velocity = start.velocity;
    box.angular_velocity = start.angular_velocity;
  }
  if (failed == Stage::integrate_rigid || !workspace.plan.runs(Stage::find_pairs)) return;
  world.particles = workspace.particles_start;
  world.parting = workspace.parting_start;
  world.resting_impulses = workspace.resting_start;
}

}  // namespace

StepWorkspace::StepWorkspace(const World& world, StepperOptions given)
    : options(std::move(given)),
      plan(options.plan ? *options.plan : make_plan(world)),
      workers(options.threads),
      soft(make_soft_scratch(world, options.threads)),
      soft_start(world.soft.size()),
      rigid_start(world.rigid.size()),
      soft_outcome(world.soft.size()),
      has_filled_centre(plan.runs(Stage::part_bodies) ? find_filled_centres(world)
                                                      : std::vector<std::uint8_t>{}),
      particles(at(options.threads)),
      soft_soft(at(options.threads)),
      exact(at(options.threads)),
      columns(at(options.threads)),
      found(at(options.threads - 1)),
      islands(world) {}

Stepper::Stepper(const World& world, StepperOptions options)
    : workspace_(std::make_unique<StepWorkspace>(world, std::move(options))) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;
Stepper& Stepper::operator=(Stepper&&) noexcept = default;

std::optional<Divergence> Stepper::step(World& world) {
  StepWorkspace& workspace = *workspace_;
  const StageRunner run(workspace);
  std::optional<Divergence> divergence;

  run(Stage::integrate_soft, [&] { divergence = integrate_soft(world, workspace); });
  if (!divergence) {
    run(Stage::integrate_rigid, [&] { divergence = integrate_rigid(world, workspace); });
  }
  if (!divergence) {
    run(Stage::find_pairs, [&] { find_pairs(world, workspace); });
    run(Stage::move_particles, [&] { move_particles(world, workspace); });
    run(Stage::find_contacts, [&] { find_contacts(world, workspace); });
    run(Stage::resolve_contacts, [&] { divergence = resolve_contacts(world, workspace); });
  }
  if (!divergence) {
    run(Stage::part_bodies, [&] { divergence = part_bodies(world, workspace); });
  }
  if (divergence) {
    restore(world, workspace, divergence->stage);
    return divergence;
  }

  ++world.steps;
  return std::nullopt;
}

const Plan& Stepper::plan() const { return workspace_->plan; }
std::span<const Contact> Stepper::contacts() const { return workspace_->contacts; }
const StageTimes& Stepper::stage_times() const { return workspace_->stage_times; }

}  // namespace pneuma::sim
