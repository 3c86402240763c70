#include "app/study/error/samples.h"

namespace pneuma::app {

Sample take_sample(const sim::World& world) {
  Sample sample;
  for (const sim::SoftBody& body : world.soft) {
    sample.soft.push_back({body.positions, body.velocities});
  }
  sample.rigid = world.rigid;
  return sample;
}

}  // namespace pneuma::app
