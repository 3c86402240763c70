#include "scenes/loader/scene.h"

#include <fmt/format.h>

#include <cmath>

namespace pneuma::scenes {
namespace {

constexpr double bytes_per_gib = 1024.0 * 1024.0 * 1024.0;

}  // namespace

std::int64_t vertex_count(const BodyScene& body) {
  const std::int64_t stacks = body.stacks;
  const std::int64_t slices = body.slices;
  const std::int64_t divisions = body.divisions;
  if (is_box(body)) return 8;
  switch (body.shape) {
    case Shape::sphere:
      return 2 + (stacks - 1) * slices;
    case Shape::torus:
      return stacks * slices;
    case Shape::box:  // a closed surface of 6 d^2 squares has two vertices more than squares
      return 6 * divisions * divisions + 2;
    case Shape::icosphere:
      return 10 * (std::int64_t{1} << (2 * body.subdivisions)) + 2;
    case Shape::model:
      return 0;
  }
  return 0;
}

std::int64_t copy_count(const BodyScene& body) {
  return std::int64_t{body.copies[0]} * body.copies[1] * body.copies[2];
}

const BodyScene& body_of(const Scene& scene, int body) {
  std::int64_t left = body;
  for (const bool boxes : {false, true}) {
    for (const BodyScene& each : scene.bodies) {
      if (is_box(each) != boxes) continue;
      left -= copy_count(each);
      if (left < 0) return each;
    }
  }
  return scene.bodies.back();
}

std::int64_t frame_count(const Scene& scene) {
  return std::llround(scene.duration * scene.picture.frames_per_second);
}

int default_steps_per_second(int frames_per_second) {
  const int least = sim::Settings{}.steps_per_second;
  return frames_per_second * ((least + frames_per_second - 1) / frames_per_second);
}

int steps_per_frame(const Scene& scene) {
  return scene.settings.steps_per_second / scene.picture.frames_per_second;
}

double estimated_memory_gib(std::int64_t vertices, std::int64_t copies) {
  // A closed mesh has about three edges and two triangles per vertex. Its topology, with feature
  // neighbours, is shared by the copies; state, integrator scratch and render buffers are not.
  constexpr double mesh_bytes = 500.0;
  constexpr double copy_bytes = 500.0;
  return static_cast<double>(vertices) * (mesh_bytes + copy_bytes * static_cast<double>(copies)) /
         bytes_per_gib;
}

std::string memory_text(double gib) {
  return fmt::format("{:.2f} GiB", std::ceil(100.0 * gib) / 100.0);
}

double estimated_memory_gib(const Scene& scene) {
  // Colour and depth per sample; the resolved colours and a few images on their way to files.
  constexpr double sample_bytes = 8.0;
  constexpr double pixel_bytes = 32.0;

  double result = 0.0;
  for (const BodyScene& body : scene.bodies) {
    result += estimated_memory_gib(vertex_count(body), copy_count(body));
  }
  const double pixels = static_cast<double>(scene.picture.width) * scene.picture.height;
  return result + pixels * (pixel_bytes + sample_bytes * scene.picture.samples) / bytes_per_gib;
}

}  // namespace pneuma::scenes
