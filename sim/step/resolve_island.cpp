#include "sim/step/resolve_island.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/mesh/row.h"

namespace pneuma::sim {
namespace {

/// Of moving boxes apart: in a stack each correction pushes into the next box.
constexpr int separation_sweeps = 4;

/// Where no box rests on another or on the ground. The paper makes one; with more than three the
/// scenes of soft bodies penetrate no less, rise in energy no less and end no more at rest (tried:
/// 1, 2, 3, 5, 10, 30): their springs go on with what is left.
constexpr int most_soft_sweeps = 3;

/// Of the shortest side of a box: points nearer than this are one, a step later.
constexpr double same_point = 0.05;

/// The contacts of an island, and the impulse of each.
class Island {
 public:
  Island(StepWorkspace& workspace, int island)
      : contacts_(workspace.contacts),
        numbers_(workspace.islands.island(island)),
        begin_(at(workspace.islands.begin(island))),
        impulses_(std::span(workspace.impulses).subspan(begin_, numbers_.size())),
        work_(std::span(workspace.pair_work).subspan(begin_, numbers_.size())) {}

  std::size_t size() const { return numbers_.size(); }
  const Contact& contact(std::size_t i) const { return contacts_[at(numbers_[i])]; }
  std::span<ContactImpulse> impulses() const { return impulses_; }
  ContactImpulse& impulse(std::size_t i) const { return impulses_[i]; }
  bool has_resting_box() const {
    return std::any_of(numbers_.begin(), numbers_.end(),
                       [this](int number) { return is_rigid(contacts_[at(number)]); });
  }
  double& work(std::size_t i) const { return work_[i]; }

 private:
  std::span<const Contact> contacts_;
  std::span<const int> numbers_;
  std::size_t begin_;
  std::span<ContactImpulse> impulses_;
  std::span<double> work_;
};

Vec3 start_velocity(const World& world, const StepWorkspace& workspace, const ContactSide& side,
                    const Vec3& point) {
  switch (side.kind) {
    case BodyKind::soft: {
      const auto vertices = world.soft[at(side.body)].mesh->topology.feature_vertices(side.feature);
      const RowReader velocities(workspace.soft_start[at(side.body)].velocities);
      Row sum{};
      for (const int v : vertices) sum += velocities[v];
      return to_vec3(sum / static_cast<double>(vertices.size()));
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

/// Contacts of the same bodies follow each other. Vertices on the ground each stand for themselves.
bool are_of_same_bodies(const Contact& a, const Contact& b) {
  const auto same = [](const ContactSide& x, const ContactSide& y) {
    return x.kind == y.kind && x.body == y.body;
  };
  return !is_soft_ground(a) && same(a.first, b.first) && same(a.second, b.second);
}

void make_impulses(World& world, StepWorkspace& workspace, const Island& island) {
  std::size_t pair = 0;
  for (std::size_t i = 0; i < island.size(); ++i) {
    const Contact& contact = island.contact(i);
    if (i > 0 && !are_of_same_bodies(island.contact(i - 1), contact)) pair = i;
    island.work(i) = 0.0;
    std::construct_at(&island.impulse(i), world, workspace.box_masses, contact,
                      start_approach(world, workspace, contact), island.work(pair));
  }
}

/// What held a point of a box in the last step goes to the nearest of the contacts begin..end of
/// the same boxes, if that is near enough to be the same point. Names of corners and edges would
/// not do: of aligned boxes in a stack, which corner lies inside which face changes with every
/// breath. With it their number changes, so several may go to one contact: none of them may be
/// lost, or the stack gets a jolt.
void hand_on(const World& world, const Island& island, std::size_t begin, std::size_t end,
             const RestingImpulse& resting) {
  const RigidBox& first = world.rigid[at(resting.first)];
  const Vec3 place = first.position + first.orientation * resting.place;
  const double near = same_point * first.size.minCoeff();
  double least = near * near;
  ContactImpulse* nearest = nullptr;
  for (std::size_t i = begin; i < end; ++i) {
    const double squared = (island.contact(i).point - place).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = &island.impulse(i);
    }
  }
  if (nearest) nearest->start_from(resting.impulse);
}

/// The contacts of one pair of boxes follow each other.
void start_from_last_step(const World& world, const Island& island) {
  const std::vector<RestingImpulse>& resting = world.resting_impulses;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < island.size(); begin = end) {
    end = begin + 1;
    if (!is_rigid(island.contact(begin))) continue;
    const std::pair<int, int> pair = boxes(island.contact(begin));
    while (end < island.size() && is_rigid(island.contact(end)) &&
           boxes(island.contact(end)) == pair) {
      ++end;
    }
    auto known = std::lower_bound(resting.begin(), resting.end(), pair,
                                  [](const RestingImpulse& r, const std::pair<int, int>& wanted) {
                                    return boxes(r) < wanted;
                                  });
    for (; known != resting.end() && boxes(*known) == pair; ++known) {
      hand_on(world, island, begin, end, *known);
    }
  }
}

/// Until the corrections have died away, or for so many sweeps.
void correct_all(std::span<ContactImpulse> impulses, int sweeps) {
  for (int i = 0; i < sweeps; ++i) {
    double change = 0.0, total = 0.0;
    const auto correct = [&](ContactImpulse& impulse) {
      change += impulse.correct();
      total += impulse.impulse().normal;
    };
    // There and back, so that what holds a stack travels up it as fast as down.
    if (i % 2 == 0) {
      std::for_each(impulses.begin(), impulses.end(), correct);
    } else {
      std::for_each(impulses.rbegin(), impulses.rend(), correct);
    }
    if (change <= 1e-6 * total) return;
  }
}

/// First what stops bodies from approaching, then what makes them bounce.
void apply_impulses(std::span<ContactImpulse> impulses, int sweeps) {
  correct_all(impulses, sweeps);
  bool bounces = false;
  for (ContactImpulse& impulse : impulses) bounces |= impulse.bounce();
  if (bounces) correct_all(impulses, sweeps);
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

void separate(World& world, const StepWorkspace& workspace, const Island& island) {
  const double soft_share = separation_share(world.settings);
  bool moves = true;
  for (int sweep = 0; sweep < separation_sweeps && moves; ++sweep) {
    moves = false;
    for (std::size_t i = 0; i < island.size(); ++i) {
      const Contact& contact = island.contact(i);
      if (is_soft_ground(contact)) continue;
      moves |= island.impulse(i).separate(is_soft_soft(contact) ? soft_share : 1.0);
    }
  }
  for (std::size_t i = 0; i < island.size() && is_soft_ground(island.contact(i)); ++i) {
    put_onto_ground(world, workspace, island.contact(i), island.impulse(i).sticks());
  }
}

}  // namespace

void put_onto_ground(World& world, const StepWorkspace& workspace, const Contact& contact,
                     bool sticks) {
  VertexArray& positions = world.soft[at(contact.first.body)].positions;
  const int v = contact.first.feature.index;
  Vec3 position = positions[v];
  // Implicit integrators hold by friction what is on the ground, and below it, themselves.
  if (sticks && !is_implicit(world.settings.integrator)) {
    const SoftState& start = workspace.soft_start[at(contact.first.body)];
    position = start.positions[v] + 0.5 * time_step(world.settings) * Vec3(start.velocities[v]);
  }
  position.z() = 0.0;
  positions[v] = position;
}

void resolve_island(World& world, StepWorkspace& workspace, int number) {
  const Island island(workspace, number);
  make_impulses(world, workspace, island);
  int sweeps = world.settings.impulse_sweeps;
  if (island.has_resting_box()) {
    start_from_last_step(world, island);
  } else {
    sweeps = std::min(sweeps, most_soft_sweeps);
  }
  apply_impulses(island.impulses(), sweeps);
  separate(world, workspace, island);
}

}  // namespace pneuma::sim
