#include "sim/step/swept/end_contacts.h"

#include <algorithm>
#include <span>

#include "sim/step/swept/between_walls.h"
#include "sim/step/swept/contact_places.h"

namespace pneuma::sim {
namespace {

/// Of what a step of free fall gains: what arrives at the end of a step bounces by no less.
constexpr double least_of_falls = 4.0;
/// The same of what does not bounce: what arrives with less rests.
constexpr double least_arrival = 0.05;
/// Of the speed that a bounce returns: more is all of it.
constexpr double elastic = 0.99;

/// What a pair of features has been given at the start.
struct Given {
  bool is_known = false;
  bool is_of_end = false;  // the speed with which they meet
  bool is_near = false;    // of the first contact that they made
  bool is_floor = false;   // likewise
  double approach = 0.0;   // m/s, of that
  double drift = 0.0;      // m/s, of that
  double normal = 0.0;     // N s, of all
  bool acted = false;
  Vec3 friction = Vec3::Zero();
  Vec3 impulse = Vec3::Zero();  // N s, of all, along the normals that they had
  const SweptContact* strongest = nullptr;
};

class EndContacts {
 public:
  EndContacts(const World& world, const MotionStart& start, SweptMemory& memory,
              const SweptWarmStart& warm_start)
      : world_(world),
        m_(memory),
        start_(start),
        motion_(world, start, memory.bodies),
        places_(world, start, memory.bodies),
        warm_start_(warm_start) {}

  void find() {
    const auto all = std::span(m_.candidates);
    for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
      const BodyPair bodies = all[first].bodies;
      while (end < all.size() && all[end].bodies == bodies) ++end;
      touch(all.subspan(first, end - first));
    }
  }

 private:
  bool has_met(const SweptCandidate& candidate) const {
    return candidate.contact >= 0 && m_.first_contacts[at(candidate.contact)].has_met;
  }

  Given given_at_start(const SweptCandidate& candidate) const {
    Given given;
    double greatest = 0.0;
    for (int i = candidate.contact; i >= 0; i = m_.first_contacts[at(i)].previous) {
      given.is_known = true;
      given.is_near = m_.first_contacts[at(i)].is_near;
      given.is_floor = m_.first_contacts[at(i)].is_floor;
      given.approach = m_.first_contacts[at(i)].approach;
      given.drift = m_.first_contacts[at(i)].drift;
      given.normal += m_.first_impulses[at(i)].normal_given();
      given.acted |= m_.first_impulses[at(i)].may_act();
      given.friction += m_.first_impulses[at(i)].friction_impulse();
      given.impulse += m_.first_impulses[at(i)].given();
      if (m_.first_impulses[at(i)].normal_impulse() > greatest) {
        greatest = m_.first_impulses[at(i)].normal_impulse();
        given.strongest = &m_.first_contacts[at(i)];
      }
    }
    return given;
  }

  /// Of two bodies. The points of faces that come together differ by what is left of a solution;
  /// boxes of which one corner alone were hit would turn.
  void touch(std::span<const SweptCandidate> candidates) {
    const std::size_t before = m_.contacts.size();
    for (const SweptCandidate& candidate : candidates) {
      if (!has_met(candidate)) touch(candidate);
    }
    const auto touched = std::span(m_.contacts).subspan(before);
    if (touched.empty() || !keep_shapes(touched.front())) return;
    if (std::ranges::none_of(touched, is_hit)) return;
    for (const SweptCandidate& candidate : candidates) {
      if (!has_met(candidate)) hit_as_well(candidate);
    }
  }

  /// What touches at the end does not approach, or bounces. An impulse of the start whose features
  /// did not meet is given back.
  void touch(const SweptCandidate& candidate) {
    const Given before = given_at_start(candidate);
    const bool acted = before.acted;
    auto contact = places_.place_at_end(candidate, before.strongest);
    if (!contact) return;
    const ContactMaterial both = motion_.material(*contact);
    if (!acted && !before.is_floor && is_left_to_next_step(*contact, both.restitution)) return;
    const bool rubs = contact->is_near || (acted && before.is_near);
    SweptImpulse impulse = motion_.impulse(*contact, rubs ? both.friction : 0.0);
    if (acted) impulse.start_from(before.normal, before.friction);
    squeeze_between_walls(world_, m_, step(), *contact, impulse);
    const bool pulls = before.normal < 0.0 && !contact->is_gripped;  // as it was gripped
    if (pulls) impulse.start_from(0.0, before.friction);
    if (!contact->is_near) impulse.only_give_back();
    contact->is_new = !before.is_known;
    const bool arrives = !acted && keep_shapes(*contact) && (!before.is_known || flew(*contact));
    set_parting(arrives ? hit_at_end(*contact, true) : before, both.restitution, *contact);
    add_at_end(*contact, impulse, before.impulse);
  }

  /// Points of boxes that one of them was hit beside, and that have room: stopped here, they would
  /// lose what a bounce returns.
  bool is_left_to_next_step(const SweptContact& contact, double restitution) const {
    return keep_shapes(contact) && restitution > elastic && contact.distance > contact.wanted &&
           !flew(contact);
  }

  /// What touch() has left.
  std::optional<SweptContact> left_to_next_step(const SweptCandidate& candidate,
                                                const Given& before) const {
    if (before.acted || before.is_floor) return std::nullopt;
    auto contact = places_.place_at_end(candidate, nullptr);
    if (!contact || !is_left_to_next_step(*contact, motion_.material(*contact).restitution))
      return std::nullopt;
    return contact;
  }

  /// Nothing has pushed it in this step: it has the speed with which it arrives.
  bool flew(int body) const { return body == swept_ground || m_.is_pushed[at(body)] == 0; }
  bool flew(const SweptContact& contact) const {
    return flew(contact.first.body) && flew(contact.second.body);
  }

  /// `alone`: no other point of the two bodies says that they are hit. What something has pushed in
  /// this step arrives with no more speed than it had at its start, as a box that slides against a
  /// wall has: what the step gave it, the next one may take again.
  Given hit_at_end(const SweptContact& contact, bool alone) const {
    double approach = -contact.normal.dot(motion_.end_velocity(contact));
    if (alone && !flew(contact)) {
      const Vec3 before = velocity_before(contact.first) - velocity_before(contact.second);
      approach = std::min(approach, -contact.normal.dot(before));
    }
    return {.is_known = true, .is_of_end = alone, .approach = approach};
  }

  /// m/s, of a point of a box as it moved when the step began; of what is moved as its keys say, as
  /// it moves now.
  Vec3 velocity_before(const SurfacePoint& point) const {
    if (point.body == swept_ground || is_kinematic(world_, point.body)) {
      return m_.bodies.end_velocity(world_, point);
    }
    const int box = m_.bodies.box(point.body);
    const RigidState& start = start_.rigid[at(box)];
    return start.velocity +
           start.angular_velocity.cross(point.point - world_.rigid[at(box)].position);
  }

  void hit_as_well(const SweptCandidate& candidate) {
    const Given before = given_at_start(candidate);
    if (before.normal > 0.0) return;
    auto contact = places_.place_beside_hit(candidate);
    if (!contact) contact = left_to_next_step(candidate, before);
    if (!contact) return;
    const ContactMaterial both = motion_.material(*contact);
    set_parting(hit_at_end(*contact, false), both.restitution, *contact);
    if (!is_hit(*contact)) return;
    add_at_end(*contact, motion_.impulse(*contact, both.friction), Vec3::Zero());
  }

  void add_at_end(const SweptContact& contact, SweptImpulse impulse, const Vec3& given_at_start) {
    const Vec3 velocity = motion_.end_velocity(contact);
    Vec3 sliding = velocity;
    if (motion_.is_rigid(contact)) sliding += warm_start_.slip(contact) / step();
    impulse.aim(contact.parting - contact.normal.dot(velocity), sliding);
    m_.contacts.push_back(contact);
    m_.impulses.push_back(impulse);
    m_.end_velocities.push_back(velocity);
    m_.given_at_start.push_back(given_at_start);
  }

  /// m/s. A box that gravity brings back within the step does not bounce: it would fall by other
  /// ways as it leaves and as it comes back, and bounce for ever. At the end of a step, and of what
  /// is near as it begins, the speed may be that of such a fall, more than once if it turns.
  double least_bounce(const Given& before, const SweptContact& contact) const {
    if (!keep_shapes(contact)) return min_bounce_speed;
    const double fallen = step() * world_.settings.gravity.norm();
    const bool may_be_fall = before.is_of_end || before.is_near;
    return std::max(min_bounce_speed, may_be_fall ? least_of_falls * fallen : 0.5 * fallen);
  }

  void set_parting(const Given& before, double restitution, SweptContact& contact) const {
    const double bounce = restitution * before.approach;
    // Soft bodies that touch at the start are pressed together, whatever their vertices' speed.
    const bool may_bounce = before.is_known && (!before.is_near || keep_shapes(contact));
    if (!contact.is_near) {
      contact.parting = -before.approach;
      contact.returns_energy = true;
    } else if (may_bounce && bounce >= least_bounce(before, contact)) {
      contact.approach = before.approach;
      contact.drift = before.drift;
      contact.restitution = restitution;
      contact.parting = bounce - before.drift;  // of what is borne: it moves by its first velocity
      contact.returns_energy = true;
    } else {
      const auto kept = contact.is_gripped ? std::nullopt : kept_between_walls(world_, m_, contact);
      contact.parting =
          kept ? std::min(0.0, (*kept - contact.distance) / step()) : contact.gap_rate;
      const double arrival = arrival_of(before, contact);
      if (arrival > least_arrival * step() * world_.settings.gravity.norm()) {
        contact.approach = arrival;
        contact.drift = before.drift;
        contact.stops = true;
      }
    }
  }

  /// m/s, with which a box arrives, without what the step has given it: none of what has touched.
  /// On boxes that move the points of contacts change from step to step, and the path would add
  /// energy.
  double arrival_of(const Given& before, const SweptContact& contact) const {
    if (!before.is_known || before.is_near || !is_on_still(contact)) return 0.0;
    if (!before.is_of_end) return before.approach;
    const Vec3 velocity = velocity_before(contact.first) - velocity_before(contact.second);
    return std::min(before.approach, -contact.normal.dot(velocity));
  }

  /// Of two boxes, or one and the ground.
  bool is_on_still(const SweptContact& contact) const {
    const auto [first, second] = pair_of(contact);
    return motion_.is_rigid(contact) &&
           (m_.bodies.stands_still(world_, first) || m_.bodies.stands_still(world_, second));
  }
  /// Two boxes, or one and an obstacle or the ground.
  bool keep_shapes(const SweptContact& contact) const {
    return m_.bodies.keep_shapes(pair_of(contact));
  }
  double step() const { return time_step(world_.settings); }

  const World& world_;
  SweptMemory& m_;
  const MotionStart& start_;
  ContactMotion motion_;
  ContactPlaces places_;
  const SweptWarmStart& warm_start_;
};

}  // namespace

void find_end_contacts(const World& world, const MotionStart& start, SweptMemory& memory,
                       const SweptWarmStart& warm_start) {
  EndContacts(world, start, memory, warm_start).find();
}

}  // namespace pneuma::sim
