#include "sim/step/stages/resolve_island.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/mesh/vec4d.h"
#include "sim/response/ground_contact.h"

namespace pneuma::sim {
namespace {

/// Iterations that move boxes apart: in a stack each correction pushes into the next box.
constexpr int separation_iterations = 4;

/// Gauss-Seidel iterations where no box rests on another or on the ground. The paper makes one;
/// more than three do not improve scenes of soft bodies (tests/benchmarks/README.md): their springs
/// go on with what is left (ERRATA row 57).
constexpr int max_soft_iterations = 3;

/// Fraction of the shortest side of a box: points nearer than this are one, a step later.
constexpr double same_point = 0.05;

/// The contacts of an island, and the impulse of each.
class Island {
 public:
  Island(std::span<const Contact> contacts, int number, ResolveContactsMemory& memory)
      : contacts_(contacts),
        numbers_(memory.islands.island(number)),
        begin_(at(memory.islands.begin(number))),
        impulses_(std::span(memory.impulses).subspan(begin_, numbers_.size())),
        work_(std::span(memory.pair_work).subspan(begin_, numbers_.size())) {}

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

Vec3 start_velocity(const World& world, const MotionStart& motion, const ContactSide& side,
                    const Vec3& point) {
  switch (side.kind) {
    case SideKind::soft: {
      const auto vertices = world.soft[at(side.body)].mesh->topology.feature_vertices(side.feature);
      const VertexReader velocities(motion.soft[at(side.body)].velocities);
      Vec4d sum{};
      for (const int v : vertices) sum += velocities[v];
      return to_vec3(sum / static_cast<double>(vertices.size()));
    }
    case SideKind::rigid: {
      const RigidState& start = motion.rigid[at(side.body)];
      const Vec3 arm = point - world.rigid[at(side.body)].position;
      return start.velocity + start.angular_velocity.cross(arm);
    }
    case SideKind::ground:
      break;
  }
  return Vec3::Zero();
}

double start_approach(const World& world, const MotionStart& motion, const Contact& contact) {
  const Vec3 relative = start_velocity(world, motion, contact.first, contact.point) -
                        start_velocity(world, motion, contact.second, contact.point);
  return -relative.dot(contact.normal);
}

/// Contacts of the same bodies follow each other. Vertices on the ground each stand for themselves.
bool are_of_same_bodies(const Contact& a, const Contact& b) {
  const auto same = [](const ContactSide& x, const ContactSide& y) {
    return x.kind == y.kind && x.body == y.body;
  };
  return !is_soft_ground(a) && same(a.first, b.first) && same(a.second, b.second);
}

void make_impulses(World& world, const MotionStart& motion, std::span<const BoxMass> box_masses,
                   const Island& island) {
  std::size_t pair = 0;
  for (std::size_t i = 0; i < island.size(); ++i) {
    const Contact& contact = island.contact(i);
    if (i > 0 && !are_of_same_bodies(island.contact(i - 1), contact)) pair = i;
    island.work(i) = 0.0;
    std::construct_at(&island.impulse(i), world, box_masses, contact,
                      start_approach(world, motion, contact), island.work(pair));
  }
}

/// Gives the impulse that held a point of a box in the last step to the nearest of the contacts
/// begin..end of the same boxes, if that is near enough to be the same point. Names of corners and
/// edges would not do: of aligned boxes in a stack, rounding decides in each step which corner lies
/// inside which face. With it the number of contacts changes, so several impulses may go to one
/// contact: if one were lost, the stack would get a jolt (ERRATA row 59).
void warm_start_nearest(const World& world, const Island& island, std::size_t begin,
                        std::size_t end, const WarmStartImpulse& resting) {
  const RigidBox& first = world.rigid[at(resting.first)];
  const Vec3 point = first.position + first.orientation * resting.point;
  const double near = same_point * first.size.minCoeff();
  double min_squared = near * near;
  ContactImpulse* nearest = nullptr;
  for (std::size_t i = begin; i < end; ++i) {
    const double squared = (island.contact(i).point - point).squaredNorm();
    if (squared < min_squared) {
      min_squared = squared;
      nearest = &island.impulse(i);
    }
  }
  if (nearest) nearest->warm_start(resting.impulse);
}

/// Starts resting contacts from their impulses of the last step. The contacts of one pair of boxes
/// follow each other.
void warm_start_island(const World& world, const Island& island) {
  const std::vector<WarmStartImpulse>& resting = world.warm_start_impulses;
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
                                  [](const WarmStartImpulse& r, const std::pair<int, int>& wanted) {
                                    return boxes(r) < wanted;
                                  });
    for (; known != resting.end() && boxes(*known) == pair; ++known) {
      warm_start_nearest(world, island, begin, end, *known);
    }
  }
}

/// Projected Gauss-Seidel: at most so many iterations, fewer if the corrections die away.
void correct_all(std::span<ContactImpulse> impulses, int iterations) {
  for (int i = 0; i < iterations; ++i) {
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

/// Stops bodies from approaching, then lets them bounce (ERRATA row 56). Where anything bounces,
/// all iterations run a second time.
void apply_impulses(std::span<ContactImpulse> impulses, int iterations) {
  correct_all(impulses, iterations);
  bool bounces = false;
  for (ContactImpulse& impulse : impulses) bounces |= impulse.bounce();
  if (bounces) correct_all(impulses, iterations);
}

bool is_soft_soft(const Contact& contact) {
  return contact.first.kind == SideKind::soft && contact.second.kind == SideKind::soft;
}

/// The paper moves a vertex out of the skin of a triangle at once. A particle that comes to a new
/// feature finds it deep in the skin, and to push it out in one step strains the springs by far
/// more than they bear at rest: bodies that lie on each other never come to rest. Given a few
/// steps, the membrane yields instead (ERRATA row 61).
double separation_fraction(const Settings& settings) {
  if (settings.relaxation_time == 0.0) return 1.0;
  return -std::expm1(-time_step(settings) / settings.relaxation_time);
}

void separate(World& world, const MotionStart& motion, const Island& island) {
  const double soft_fraction = separation_fraction(world.settings);
  bool moves = true;
  for (int i = 0; i < separation_iterations && moves; ++i) {
    moves = false;
    for (std::size_t c = 0; c < island.size(); ++c) {
      const Contact& contact = island.contact(c);
      if (is_soft_ground(contact)) continue;
      moves |= island.impulse(c).separate(is_soft_soft(contact) ? soft_fraction : 1.0);
    }
  }
  for (std::size_t i = 0; i < island.size() && is_soft_ground(island.contact(i)); ++i) {
    const Contact& contact = island.contact(i);
    put_onto_ground(world, motion.soft[at(contact.first.body)], contact,
                    island.impulse(i).sticks());
  }
}

}  // namespace

void resolve_island(World& world, const MotionStart& start, std::span<const Contact> contacts,
                    int number, ResolveContactsMemory& memory) {
  const Island island(contacts, number, memory);
  make_impulses(world, start, memory.box_masses, island);
  int iterations = world.settings.contact_iterations;
  if (island.has_resting_box()) {
    warm_start_island(world, island);
  } else {
    iterations = std::min(iterations, max_soft_iterations);
  }
  apply_impulses(island.impulses(), iterations);
  separate(world, start, island);
}

}  // namespace pneuma::sim
