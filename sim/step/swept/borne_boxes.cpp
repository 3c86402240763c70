// The part of SweptSearch that says which boxes something bears.
#include "sim/base/disjoint_sets.h"
#include "sim/step/swept/swept_search.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// What each free box touches at the start of a step.
class TouchedByBoxes {
 public:
  TouchedByBoxes(const World& world, const SweptBodies& bodies, SweptMemory& memory)
      : world_(world), bodies_(bodies), m_(memory) {
    m_.touched_by_box.assign(world.rigid.size(), TouchedByBox::nothing);
  }

  bool knows(const BodyPair& pair) const {
    return knows(pair.first, pair.second) && knows(pair.second, pair.first);
  }
  void add(const BodyPair& pair) {
    add(pair.first, pair.second);
    add(pair.second, pair.first);
  }
  bool is_free_box(int body) const { return bodies_.is_box(body) && !is_fixed(world_, body); }
  bool are_others(int box) const { return m_.touched_by_box[at(box)] == TouchedByBox::others; }

 private:
  bool knows(int body, int other) const {
    if (!is_free_box(body)) return true;
    const TouchedByBox touched = m_.touched_by_box[at(bodies_.box(body))];
    return touched == TouchedByBox::others ||
           (touched == TouchedByBox::still && bodies_.stands_still(world_, other));
  }
  void add(int body, int other) {
    if (knows(body, other)) return;
    m_.touched_by_box[at(bodies_.box(body))] =
        bodies_.stands_still(world_, other) ? TouchedByBox::still : TouchedByBox::others;
  }

  const World& world_;
  const SweptBodies& bodies_;
  SweptMemory& m_;
};

}  // namespace

/// What parts so fast that gravity does not bring it back within the step is on its way.
bool SweptSearch::touches(const SweptCandidate& candidate) const {
  const SweptContact contact = candidate.bodies.second == swept_ground
                                   ? places_.place_on_ground(candidate, Moment::start)
                                   : places_.place(candidate, candidate.start, Moment::start);
  const double returns = 0.5 * time_step(world_.settings) * world_.settings.gravity.norm();
  return contact.is_near && contact.normal.dot(motion_.start_velocity(contact)) <= returns;
}

/// Boxes that touch each other alone fall together: none must fall by another way than the next.
void SweptSearch::find_borne_boxes() {
  base::DisjointSets& sets = m_.near_groups.sets;
  sets.reset();
  const int boxes = static_cast<int>(world_.rigid.size()), bearer = boxes;
  TouchedByBoxes touched(world_, bodies_, m_);
  const auto number = [&](int body) {
    return touched.is_free_box(body) ? bodies_.box(body) : bearer;
  };
  for (const SweptCandidate& candidate : m_.candidates) {
    const int first = number(candidate.bodies.first), second = number(candidate.bodies.second);
    const bool is_known = sets.find(first) == sets.find(second) && touched.knows(candidate.bodies);
    if (is_known || !touches(candidate)) continue;
    sets.unite(first, second);
    touched.add(candidate.bodies);
  }
  m_.is_borne.resize(world_.rigid.size());
  for (int i = 0; i < boxes; ++i) {
    const bool is_borne = touched.are_others(i) && sets.find(i) == sets.find(bearer);
    m_.is_borne[at(i)] = is_borne ? 1 : 0;
  }
}

}  // namespace pneuma::sim
