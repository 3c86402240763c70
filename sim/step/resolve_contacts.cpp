#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/response/keep_volume.h"
#include "sim/soft/pressure_force.h"
#include "sim/step/find_divergence.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// Of moving boxes apart: in a stack each correction pushes into the next box.
constexpr int separation_sweeps = 4;

/// Of the shortest side of a box: points nearer than this are one, a step later.
constexpr double same_point = 0.05;

Vec3 start_velocity(const World& world, const StepWorkspace& workspace, const ContactSide& side,
                    const Vec3& point) {
  switch (side.kind) {
    case BodyKind::soft: {
      const auto vertices = world.soft[at(side.body)].mesh->topology.feature_vertices(side.feature);
      Vec3 sum = Vec3::Zero();
      for (const int v : vertices) sum += workspace.soft_start[at(side.body)].velocities[v];
      return sum / static_cast<double>(vertices.size());
    }
    case BodyKind::rigid: {
      const RigidStart& start = workspace.rigid_start[at(side.body)];
      const Vec3 arm = point - world.rigid[at(side.body)].position;
      return start.velocity + start.angular_velocity.cross(arm);
    }
    case BodyKind::ground:
      break;
  }
  return Vec3::Zero();
}

double start_approach(const World& world, const StepWorkspace& workspace, const Contact& contact) {
  const Vec3 relative = start_velocity(world, workspace, contact.first, contact.point) -
                        start_velocity(world, workspace, contact.second, contact.point);
  return -relative.dot(contact.normal);
}

/// Whether the contact is between boxes, or a box and the ground: one that can rest.
bool is_rigid(const Contact& contact) {
  return contact.first.kind == BodyKind::rigid && contact.second.kind != BodyKind::soft;
}

/// Boxes of a resting contact; -1 for the ground.
std::pair<int, int> boxes(const Contact& contact) {
  return {contact.first.body, contact.second.kind == BodyKind::ground ? -1 : contact.second.body};
}

std::pair<int, int> boxes(const RestingImpulse& resting) { return {resting.first, resting.second}; }

Vec3 place_on_first(const World& world, const Contact& contact) {
  const RigidBox& box = world.rigid[at(contact.first.body)];
  return box.orientation.conjugate() * (contact.point - box.position);
}

/// Contacts of the same bodies follow each other. Vertices on the ground each stand for themselves.
bool are_of_same_bodies(const Contact& a, const Contact& b) {
  const auto same = [](const ContactSide& x, const ContactSide& y) {
    return x.kind == y.kind && x.body == y.body;
  };
  return !is_soft_ground(a) && same(a.first, b.first) && same(a.second, b.second);
}

void prepare(World& world, StepWorkspace& workspace) {
  workspace.box_masses.clear();
  for (const RigidBox& box : world.rigid) workspace.box_masses.push_back(box_mass(box));
  workspace.impulses.clear();
  const std::vector<Contact>& contacts = workspace.contacts;
  workspace.pair_work.assign(contacts.size(), 0.0);
  std::size_t pair = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (i > 0 && !are_of_same_bodies(contacts[i - 1], contacts[i])) pair = i;
    workspace.impulses.emplace_back(world, workspace.box_masses, contacts[i],
                                    start_approach(world, workspace, contacts[i]),
                                    workspace.pair_work[pair]);
  }
}

/// What held a point of a box in the last step goes to the nearest of the contacts begin..end of
/// the same boxes, if that is near enough to be the same point. Names of corners and edges would
/// not do: of aligned boxes in a stack, which corner lies inside which face changes with every
/// breath. With it their number changes, so several may go to one contact: none of them may be
/// lost, or the stack gets a jolt.
void hand_on(const World& world, StepWorkspace& workspace, std::size_t begin, std::size_t end,
             const RestingImpulse& resting) {
  const double near = same_point * world.rigid[at(resting.first)].size.minCoeff();
  double least = near * near;
  ContactImpulse* nearest = nullptr;
  for (std::size_t i = begin; i < end; ++i) {
    const Vec3 place = place_on_first(world, workspace.contacts[i]);
    const double squared = (place - resting.place).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = &workspace.impulses[i];
    }
  }
  if (nearest) nearest->start_from(resting.impulse);
}

/// The contacts of one pair of boxes follow each other.
void start_from_last_step(const World& world, StepWorkspace& workspace) {
  const std::vector<Contact>& contacts = workspace.contacts;
  const std::vector<RestingImpulse>& resting = world.resting_impulses;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < contacts.size(); begin = end) {
    end = begin + 1;
    if (!is_rigid(contacts[begin])) continue;
    const std::pair<int, int> pair = boxes(contacts[begin]);
    while (end < contacts.size() && is_rigid(contacts[end]) && boxes(contacts[end]) == pair) ++end;
    auto known = std::lower_bound(resting.begin(), resting.end(), pair,
                                  [](const RestingImpulse& r, const std::pair<int, int>& wanted) {
                                    return boxes(r) < wanted;
                                  });
    for (; known != resting.end() && boxes(*known) == pair; ++known) {
      hand_on(world, workspace, begin, end, *known);
    }
  }
}

/// Coupled contacts are corrected until the corrections have died away.
void correct_all(const Settings& settings, const ContactCoupling& coupling) {
  for (ContactImpulse* impulse : coupling.alone()) impulse->correct();
  const std::span<ContactImpulse* const> coupled = coupling.coupled();
  for (int i = 0; i < settings.impulse_sweeps; ++i) {
    double change = 0.0, total = 0.0;
    const auto correct = [&](ContactImpulse* impulse) {
      change += impulse->correct();
      total += impulse->impulse().normal;
    };
    // There and back, so that what holds a stack travels up it as fast as down.
    if (i % 2 == 0) {
      std::for_each(coupled.begin(), coupled.end(), correct);
    } else {
      std::for_each(coupled.rbegin(), coupled.rend(), correct);
    }
    if (change <= 1e-6 * total) return;
  }
}

/// First what stops bodies from approaching, then what makes them bounce.
void apply_impulses(const Settings& settings, StepWorkspace& workspace) {
  workspace.coupling.part(workspace.contacts, workspace.impulses);
  correct_all(settings, workspace.coupling);
  bool bounces = false;
  for (ContactImpulse& impulse : workspace.impulses) bounces |= impulse.bounce();
  if (bounces) correct_all(settings, workspace.coupling);
}

/// A vertex is put back onto the ground (3.1.4). One that friction holds is also put where it would
/// be had it slowed down evenly over the step; left where the step's forces carried it, it would
/// creep down the gentlest slope.
void put_onto_ground(World& world, const Contact& contact, bool sticks, const SoftState& start) {
  VertexArray& positions = world.soft[at(contact.first.body)].positions;
  const int v = contact.first.feature.index;
  Vec3 position = positions[v];
  if (sticks) {
    position = start.positions[v] + 0.5 * time_step(world.settings) * Vec3(start.velocities[v]);
  }
  position.z() = 0.0;
  positions[v] = position;
}

bool is_soft_soft(const Contact& contact) {
  return contact.first.kind == BodyKind::soft && contact.second.kind == BodyKind::soft;
}

/// The paper moves a vertex out of the skin of a triangle at once. A particle that comes to a new
/// feature finds it deep in the skin, and to push it out in one step strains the springs by far
/// more than they bear at rest: bodies that lie on each other never come to rest. Given a few
/// steps, the membrane yields instead.
double separation_share(const Settings& settings) {
  if (settings.separation_time == 0.0) return 1.0;
  return -std::expm1(-time_step(settings) / settings.separation_time);
}

void separate(World& world, const StepWorkspace& workspace) {
  const double soft_share = separation_share(world.settings);
  for (int sweep = 0; sweep < separation_sweeps; ++sweep) {
    for (std::size_t i = 0; i < workspace.contacts.size(); ++i) {
      const Contact& contact = workspace.contacts[i];
      if (is_soft_ground(contact)) continue;
      workspace.impulses[i].separate(is_soft_soft(contact) ? soft_share : 1.0);
    }
  }
  for (std::size_t i = 0; i < workspace.contacts.size(); ++i) {
    const Contact& contact = workspace.contacts[i];
    if (!is_soft_ground(contact)) continue;
    // Implicit integrators hold by friction what is on the ground, and below it, themselves.
    const bool sticks = !is_implicit(world.settings.integrator) && workspace.impulses[i].sticks();
    put_onto_ground(world, contact, sticks, workspace.soft_start[at(contact.first.body)]);
  }
}

/// What an implicit integrator promises, contacts keep: a body that holds gas has a volume.
void separate_with_volume(World& world, StepWorkspace& workspace) {
  workspace.before_contacts.resize(world.soft.size());
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    workspace.before_contacts[i] = world.soft[i].positions;
  }
  separate(world, workspace);
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    SoftBody& body = world.soft[i];
    if (gas_strength(body.material) == 0.0) continue;
    keep_volume(body.mesh->topology, workspace.before_contacts[i], body.positions);
  }
}

void remember(World& world, const StepWorkspace& workspace) {
  world.resting_impulses.clear();
  for (std::size_t i = 0; i < workspace.contacts.size(); ++i) {
    const Contact& contact = workspace.contacts[i];
    if (!is_rigid(contact)) continue;
    const auto [first, second] = boxes(contact);
    world.resting_impulses.push_back(
        {first, second, place_on_first(world, contact), workspace.impulses[i].total()});
  }
  // Not a stable sort, which allocates: the order within a pair need not be that of the contacts,
  // only the same each time.
  std::sort(world.resting_impulses.begin(), world.resting_impulses.end(),
            [](const RestingImpulse& a, const RestingImpulse& b) { return boxes(a) < boxes(b); });
}

/// The last look at a step: the first of all bodies.
std::optional<Divergence> find_first_divergence(const World& world, StepWorkspace& workspace) {
  const auto block = [&world, &workspace](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      workspace.soft_outcome[at(i)] = find_divergence(world, world.soft[at(i)]);
    }
  };
  workspace.workers.for_blocks(static_cast<int>(world.soft.size()), block);
  for (const std::optional<Divergence>& outcome : workspace.soft_outcome) {
    if (outcome) return outcome;
  }
  for (const RigidBox& box : world.rigid) {
    if (auto divergence = find_divergence(world, box)) return divergence;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Divergence> resolve_contacts(World& world, StepWorkspace& workspace) {
  if (workspace.contacts.empty()) {
    world.resting_impulses.clear();
    return std::nullopt;
  }
  prepare(world, workspace);
  start_from_last_step(world, workspace);
  apply_impulses(world.settings, workspace);
  if (is_implicit(world.settings.integrator)) {
    separate_with_volume(world, workspace);
  } else {
    separate(world, workspace);
  }
  if (auto divergence = find_first_divergence(world, workspace)) return divergence;
  remember(world, workspace);
  return std::nullopt;
}

}  // namespace pneuma::sim
