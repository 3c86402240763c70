// Drops a soft ball for half a second and writes a picture of it.
#include <cstdint>
#include <memory>
#include <utility>

#include "render/image/png.h"
#include "render/renderer.h"
#include "sim/base/file.h"
#include "sim/mesh/primitives.h"
#include "sim/step/stepper.h"

using namespace pneuma;

int main() {
  sim::SoftBody ball;
  ball.name = "ball";
  ball.mesh = sim::make_soft_mesh(sim::make_sphere(1.0, 16, 16));
  ball.positions = ball.mesh->rest_positions;
  ball.velocities = sim::VertexArray(ball.positions.size());
  for (int v = 0; v < ball.positions.size(); ++v) ball.positions[v].z() += 3.0;

  sim::World world;
  world.soft.push_back(std::move(ball));
  sim::Stepper stepper(world);
  while (sim::time(world) < 0.5) {
    if (stepper.step(world)) return 1;  // diverged
  }

  auto shape = std::make_shared<render::MeshShape>();
  render::Mesh mesh;
  for (const auto& [a, b, c] : world.soft[0].mesh->topology.triangles()) {
    shape->triangles.push_back({std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)});
  }
  for (int v = 0; v < world.soft[0].positions.size(); ++v) {
    mesh.positions.emplace_back(world.soft[0].positions[v].cast<float>());
    shape->colours.emplace_back(0.8f, 0.3f, 0.2f);
  }
  mesh.shape = std::move(shape);
  render::Frame frame;
  frame.meshes.push_back(std::move(mesh));
  render::Image image;
  render::Renderer({.width = 320, .height = 240}).draw(frame, image);
  base::write_file_atomically("ball.png", render::encode_png(image));
}
