#include "app/export/replay/recording.h"

#include <utility>

#include "app/picture/overlay.h"
#include "render/geometry/rounding.h"

namespace pneuma::app {

Recorder::Recorder(const scenes::Scene& scene, const sim::World& start, int threads,
                   CameraEvents events)
    : builder_(scene, start),
      camera_(scene, start, threads, OnDivergence::automatic, std::move(events)) {
  camera_.keep_frames();
  recording_.name = scene.name;
  recording_.title = scene.title.empty() ? scene.name : scene.title;
  recording_.frames_per_second = scene.picture.frames_per_second;
  recording_.steps_per_frame = scenes::steps_per_frame(scene);
  recording_.aspect =
      static_cast<float>(scene.picture.width) / static_cast<float>(scene.picture.height);
}

void Recorder::add(const Simulation& simulation) {
  const sim::World& world = simulation.world();
  const auto contacts = simulation.contacts();
  render::Frame drawn = builder_.build(world, camera_.at(world));
  camera_.prepare_next();
  RecordedFrame frame;
  frame.camera = drawn.camera;
  for (const render::Mesh& mesh : drawn.meshes) {
    frame.positions.insert(frame.positions.end(), mesh.positions.begin(), mesh.positions.end());
    if (mesh.room.empty()) continue;
    const std::vector<float> shares =
        render::bulge_shares(mesh.shape->triangles, mesh.positions, mesh.normals, mesh.room);
    frame.shares.insert(frame.shares.end(), shares.begin(), shares.end());
  }
  render::Frame overlay;
  add_particles(world, contacts, overlay);
  frame.particles = std::exchange(overlay.points, {});
  add_contacts(contacts, overlay);
  frame.contacts = std::move(overlay.points);
  frame.normals = std::move(overlay.lines);
  frame.energy = sim::energy(world);
  for (const sim::SoftBody& body : world.soft) {
    frame.volume += sim::volume(body.mesh->topology, body.positions);
  }
  frame.penetration = sim::max_penetration(world);
  if (recording_.frames.empty()) {
    recording_.first_frame = simulation.frame();
    recording_.first = std::move(drawn);
  }
  recording_.frames.push_back(std::move(frame));
}

}  // namespace pneuma::app
