#include "sim/step/swept/start_aims.h"

#include <algorithm>

#include "sim/step/swept/between_walls.h"
#include "sim/step/swept/shift_boxes.h"

namespace pneuma::sim {
namespace {

/// Of the distance wanted: what a step leaves of it between boxes that it brings together. More
/// than it is solved for, so that they do not cross.
constexpr double least_of_wanted = 0.02;

class StartAims {
 public:
  StartAims(const World& world, const MotionStart& start, SweptMemory& memory,
            const SweptWarmStart& warm_start, double fraction)
      : world_(world),
        m_(memory),
        motion_(world, start, memory.bodies),
        warm_start_(warm_start),
        made_up_(fraction * made_up_per_step) {}

  void aim() {
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      const SweptContact& contact = m_.contacts[i];
      const Vec3 shift = motion_.shift(contact);
      const Vec3 moved = (motion_.displacement(contact) - shift) / step();
      const Vec3 free = moved - m_.impulses[i].change();
      const double parting = may_move(contact, contact.normal.dot(shift)) / step();
      const Vec3 slip = warm_start_.slip(contact) / step();
      m_.impulses[i].aim(parting - contact.normal.dot(free), free + slip);
    }
  }

 private:
  /// m, along the normal in this step and besides the `shift` (m) along it, at least: negative if
  /// there is room.
  double may_move(const SweptContact& contact, double shift) const {
    if (contact.is_gripped) return contact.gap_rate * step();
    const double closer = std::max(0.0, -shift);
    if (m_.bodies.keep_shapes(pair_of(contact))) {
      const double left = std::max(0.0, room(contact, shift));
      // What shifts have used up is not taken back, for which there may be no room between walls;
      // but for those that bring free boxes through each other, as of boxes that start so.
      const bool both_are_free = contact.second.body != swept_ground && !motion_.is_driven(contact);
      return both_are_free && closer > contact.distance ? closer - left
                                                        : -std::max(0.0, left - closer);
    }
    if (contact.distance > contact.wanted) return closer + contact.wanted - contact.distance;
    // Springs take back most of what holds up a vertex that others press into the ground.
    const double made_up = contact.second.body == swept_ground ? 1.0 : made_up_;
    return closer + made_up * std::max(0.0, missing_distance(contact));
  }

  /// m, by which what keeps its shape may come nearer. Shifts do the rest.
  double room(const SweptContact& contact, double shift) const {
    if (contact.distance > contact.wanted) return contact.distance - contact.wanted;
    if (contact.wanted < 0.0) return 0.0;  // boxes that turn past each other
    if (const auto kept = kept_between_walls(world_, m_, contact)) return contact.distance - *kept;
    const bool on_ground = contact.second.body == swept_ground;
    if (!on_ground && (!contact.is_of_near_boxes || stands_on_still(contact))) return 0.0;
    // What presses boxes together must not take shifts back.
    const bool is_held = shift > 0.0 || is_carried(contact.first) || is_carried(contact.second);
    const double least = on_ground ? 0.0 : least_of_wanted * contact.wanted;
    return is_held ? -missing_distance(contact) : contact.distance - least;
  }

  bool is_carried(const SurfacePoint& box) const {
    return box.body != swept_ground && m_.carried_boxes.is_carried(m_.bodies.box(box.body));
  }

  /// A box that touches only what stands still would fall into the room that others leave to
  /// shifts, and tilt where rounding leaves it to one side only.
  bool stands_on_still(const SweptContact& contact) const {
    return stands_on(contact.first, contact.second) || stands_on(contact.second, contact.first);
  }
  bool stands_on(const SurfacePoint& side, const SurfacePoint& still) const {
    return m_.bodies.is_box(side.body) && !is_kinematic(world_, side.body) &&
           m_.touched_by_box[at(m_.bodies.box(side.body))] == TouchedByBox::still &&
           m_.bodies.stands_still(world_, still.body);
  }

  double step() const { return time_step(world_.settings); }

  const World& world_;
  SweptMemory& m_;
  ContactMotion motion_;
  const SweptWarmStart& warm_start_;
  double made_up_;  // of what is missing: by all parts of a step as much as by a whole one
};

}  // namespace

void aim_at_distances(const World& world, const MotionStart& start, SweptMemory& memory,
                      const SweptWarmStart& warm_start, double fraction) {
  StartAims(world, start, memory, warm_start, fraction).aim();
}

}  // namespace pneuma::sim
