// Boxes that touch each other, the ground and what is driven, moved through a part of a step in
// substeps: gravity, the contacts' impulses, motion, and the impulses once more without what only
// pushed boxes apart ("TGS soft": Macklin and others 2019, "Small steps in physics simulation";
// Catto's Box2D and box3d). The contacts are found once a part.
#pragma once

#include <span>
#include <vector>

#include "sim/boxes/substep_contact.h"
#include "sim/collision/oriented_box.h"
#include "sim/response/motion_start.h"

namespace pneuma::sim {

/// The boxes of one island. Keeps its memory from island to island.
class SubstepSolver {
 public:
  /// `fineness`: 1, or more where a step is repeated.
  void clear(double fineness = 1.0);
  /// A box that the solver moves, from where it is when a part begins; its velocities are those at
  /// `start`, its drag is that of substeps of `substep` s. Returns its number.
  int add(RigidBox& box, const RigidStart& start, double substep);
  /// A box that keeps the velocities that it has at `start`.
  int add_driven(const RigidBox& box, const RigidStart& start);
  /// The number of the ground.
  int add_ground();

  int box_count() const { return static_cast<int>(boxes_.size()); }
  const SubstepBox& box(int number) const { return boxes_[at(number)]; }
  /// As it lies when the part begins.
  const OrientedBox& shape(int number) const { return movers_[at(number)].shape; }
  /// As it lies after end_part.
  OrientedBox shape_now(int number) const;
  std::vector<SubstepContact>& contacts() { return contacts_; }

  /// What was moved in the part before is there now; there are no contacts.
  void begin_part();
  void run(int substeps, double substep, const Vec3& gravity);
  /// Moves the boxes.
  void end_part();
  /// J since clear(): by what is driven, and of what has parted boxes that were too near.
  double driven_work() const { return driven_work_; }
  double parting_work() const { return parting_work_; }

 private:
  struct Mover {
    RigidBox* moved = nullptr;  // none: it is driven
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    OrientedBox shape;
    double kept = 1.0;  // of its velocities, by drag in a substep
    bool is_cube = true;
  };

  template <class Act>
  void for_all(const Act& act);
  template <class Push>
  void push_until_still(const Push& push, double tolerance);
  void relax(double substep);
  void accelerate(double substep, const Vec3& gravity);
  void move(double substep);
  void turn(std::size_t number, double substep);

  std::vector<SubstepBox> boxes_;
  std::vector<Mover> movers_;
  std::vector<SubstepContact> contacts_;
  bool any_driven_ = false;
  double thinnest_ = 0.0;  // m
  double fineness_ = 1.0;
  double driven_work_ = 0.0;
  double parting_work_ = 0.0;
};

}  // namespace pneuma::sim
