#include "sim/boxes/substep_solver.h"

#include <algorithm>
#include <cmath>

#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"

namespace pneuma::sim {
namespace {

/// Of contacts as springs. Softer ones let a tower lean, as what contacts give way by grows with
/// what they carry; with stiffer ones, from a quarter of the substeps' frequency on, stacks
/// tremble. What leans on something that does not move may be stiffer.
constexpr double frequency_of_substeps = 0.2;
constexpr double of_driven = 2.0;
constexpr double damping_ratio = 10.0;
/// Of the thinnest box: if an impulse moves boxes by more in a substep, all are looked at again. At
/// rest none does; an impact travels through a heap.
constexpr double tolerance_of_side = 2e-4;
constexpr int max_iterations = 16;
/// m/s: velocities are relaxed to this, as long as that takes no more than so many solutions of a
/// contact in a substep. A few boxes are solved for to the end; in a heap what is left is taken up
/// by the next substep.
constexpr double relaxed_speed = 3e-4;
constexpr std::size_t most_relaxations = 300;
/// Of a contact.
constexpr std::size_t often_enough = 50;

}  // namespace

void SubstepSolver::clear(double fineness) {
  fineness_ = fineness;
  boxes_.clear();
  movers_.clear();
  contacts_.clear();
  any_driven_ = false;
  driven_work_ = parting_work_ = 0.0;
}

int SubstepSolver::add(RigidBox& box, const RigidStart& start, double substep) {
  Mover mover;
  mover.moved = &box;
  mover.shape.half = 0.5 * box.size;
  thinnest_ = box_count() == 0 ? box.size.minCoeff() : std::min(thinnest_, box.size.minCoeff());
  mover.kept = box.rho_g == 0.0 ? 1.0 : std::pow(1.0 - box.rho_g, 60.0 * substep);
  mover.is_cube = is_cube(box);
  movers_.push_back(mover);
  SubstepBox& in_substeps = boxes_.emplace_back();
  in_substeps.velocity = to_vec4d(start.velocity);
  in_substeps.angular_velocity = to_vec4d(start.angular_velocity);
  in_substeps.inverse_mass = 1.0 / box.mass;
  return box_count() - 1;
}

int SubstepSolver::add_driven(const RigidBox& box, const RigidStart& start) {
  Mover mover;
  mover.orientation = start.orientation;
  mover.shape.centre = start.position;
  mover.shape.half = 0.5 * box.size;
  movers_.push_back(mover);
  SubstepBox& in_substeps = boxes_.emplace_back();
  in_substeps.velocity = to_vec4d(start.velocity);
  in_substeps.angular_velocity = to_vec4d(start.angular_velocity);
  any_driven_ = any_driven_ || !start.velocity.isZero(0.0) || !start.angular_velocity.isZero(0.0);
  return box_count() - 1;
}

int SubstepSolver::add_ground() { return add_driven({}, {}); }

void SubstepSolver::begin_part() {
  contacts_.clear();
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    Mover& mover = movers_[i];
    SubstepBox& box = boxes_[i];
    if (mover.moved) {
      mover.orientation = mover.moved->orientation;
      mover.shape.centre = mover.moved->position;
      box.inverse_inertia = mat3x4(world_inverse_inertia(*mover.moved));
    } else {
      mover.shape.centre += to_vec3(box.moved);
      mover.orientation = turned(mover.orientation, to_vec3(box.turned));
    }
    mover.shape.axes = mover.orientation.toRotationMatrix();
    box.centre = to_vec4d(mover.shape.centre);
    box.moved = box.turned = Vec4d{};
  }
}

OrientedBox SubstepSolver::shape_now(int number) const {
  const Mover& mover = movers_[at(number)];
  const SubstepBox& box = boxes_[at(number)];
  const Eigen::Quaterniond orientation =
      mover.moved ? mover.moved->orientation : turned(mover.orientation, to_vec3(box.turned));
  return {mover.shape.centre + to_vec3(box.moved), orientation.toRotationMatrix(),
          mover.shape.half};
}

void SubstepSolver::accelerate(double substep, const Vec3& gravity) {
  const Vec4d gained = to_vec4d(substep * gravity);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!movers_[i].moved) continue;
    boxes_[i].velocity = movers_[i].kept * (boxes_[i].velocity + gained);
    boxes_[i].angular_velocity *= movers_[i].kept;
  }
}

void SubstepSolver::move(double substep) {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    SubstepBox& box = boxes_[i];
    box.moved = fma(substep, box.velocity, box.moved);
    box.turned = fma(substep, box.angular_velocity, box.turned);
    if (!movers_[i].is_cube) turn(i, substep);
  }
}

/// As its angular momentum lets it.
void SubstepSolver::turn(std::size_t number, double substep) {
  RigidBox& box = *movers_[number].moved;
  box.angular_velocity = to_vec3(boxes_[number].angular_velocity);
  rotate_freely(box, substep);
  boxes_[number].angular_velocity = to_vec4d(box.angular_velocity);
  boxes_[number].inverse_inertia = mat3x4(world_inverse_inertia(box));
}

void SubstepSolver::run(int substeps, double substep, const Vec3& gravity) {
  const double frequency = frequency_of_substeps / substep;
  const Softness of_boxes = soft_spring(frequency, damping_ratio, substep);
  const Softness of_fixed = soft_spring(of_driven * frequency, damping_ratio, substep);
  const auto push = [&](SubstepContact& contact, SubstepBox& a, SubstepBox& b) {
    return contact.push(a, b, a.is_driven() || b.is_driven() ? of_fixed : of_boxes, substep);
  };
  for (int i = 0; i < substeps; ++i) {
    accelerate(substep, gravity);
    for_all([](auto& contact, auto& a, auto& b) { contact.warm_start(a, b); });
    push_until_still(push, tolerance_of_side * thinnest_ / substep / fineness_);
    move(substep);
    for_all([&](const auto& contact, const auto& a, const auto& b) {
      parting_work_ += contact.parting_work(a, b, substep);
    });
    relax(substep);
    if (!any_driven_) continue;
    for_all([&](auto& contact, auto& a, auto& b) { driven_work_ += contact.driven_work(a, b); });
  }
  for_all([](auto& contact, auto& a, auto& b) { contact.bounce(a, b); });
}

/// Friction turns boxes about their contacts, which then press otherwise.
void SubstepSolver::relax(double substep) {
  const std::size_t times = std::clamp(
      most_relaxations / std::max<std::size_t>(contacts_.size(), 1), std::size_t{1}, often_enough);
  for (std::size_t i = 0; i < times; ++i) {
    double changed = 0.0;
    for_all([&](auto& contact, auto& a, auto& b) {
      changed = std::max(changed, contact.relax(a, b, substep));
    });
    if (changed <= relaxed_speed) return;
  }
}

template <class Act>
void SubstepSolver::for_all(const Act& act) {
  for (SubstepContact& contact : contacts_) {
    act(contact, boxes_[at(contact.first())], boxes_[at(contact.second())]);
  }
}

/// From the last contact to the first, which is downwards if boxes were put on each other in their
/// order, and back, and so on; what leans on something driven comes after all others.
template <class Push>
void SubstepSolver::push_until_still(const Push& push, double tolerance) {
  std::size_t free = contacts_.size();
  while (free > 0 && boxes_[at(contacts_[free - 1].second())].is_driven()) --free;
  double changed = 0.0;
  const auto push_one = [&](std::size_t i) {
    SubstepContact& contact = contacts_[i];
    changed =
        std::max(changed, push(contact, boxes_[at(contact.first())], boxes_[at(contact.second())]));
  };
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    changed = 0.0;
    for (std::size_t i = 0; i < free; ++i) push_one(iteration % 2 == 0 ? free - 1 - i : i);
    for (std::size_t i = free; i < contacts_.size(); ++i) push_one(i);
    if (changed <= tolerance) return;
  }
}

void SubstepSolver::end_part() {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!movers_[i].moved) continue;
    RigidBox& box = *movers_[i].moved;
    box.position += to_vec3(boxes_[i].moved);
    if (movers_[i].is_cube) box.orientation = turned(box.orientation, to_vec3(boxes_[i].turned));
    box.velocity = to_vec3(boxes_[i].velocity);
    box.angular_velocity = to_vec3(boxes_[i].angular_velocity);
  }
}

}  // namespace pneuma::sim
