#include "render/passes/discs.h"

#include <algorithm>
#include <cstddef>

#include "render/passes/shader_sources.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 point_colour;
layout(location = 2) in float radius;
uniform mat4 view;
uniform mat4 projection;
uniform vec2 picture_size;
noperspective out vec2 from_centre;  // pixels
flat out float rim;
flat out vec3 shade;

void main() {
  vec4 in_view = view * vec4(position, 1.0);
  // A disc stands for a small ball: its depth is that of the ball's front, at most halfway to the
  // eye.
  float ball = radius * 2.0 / (picture_size.y * projection[1][1]);  // per metre of distance
  in_view.xyz *= 1.0 - min(ball, 0.5);
  vec4 clip = projection * in_view;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  from_centre = corner * (radius + 1.0);  // one more pixel for the soft edge
  rim = radius;
  shade = point_colour;
  gl_Position = clip + vec4(from_centre * 2.0 / picture_size * clip.w, 0.0, 0.0);
}
)";

constexpr const char* fragment_source = R"(
noperspective in vec2 from_centre;
flat in float rim;
flat in vec3 shade;
uniform float opacity;
out vec4 colour;

void main() {
  float away = length(from_centre);
  float covered = clamp(rim + 0.5 - away, 0.0, 1.0);
  float core = clamp(rim * 0.70 + 0.5 - away, 0.0, 1.0);
  colour = vec4(mix(vec3(0.05, 0.06, 0.08), shade, core), covered * opacity);
}
)";

constexpr float readable = 5.0f;  // pixels: in small pictures discs shrink no further

float shown_diameter(float diameter, float pixel_scale) {
  return std::max(diameter * pixel_scale, std::min(diameter, readable));
}

}  // namespace

Discs::Discs()
    : quads_("points", vertex_source, fragment_source,
             {{3, offsetof(Instance, position)},
              {3, offsetof(Instance, colour)},
              {1, offsetof(Instance, radius)}}) {}

void Discs::draw(const View& view, const std::vector<Point>& points) {
  if (points.empty()) return;
  std::vector<Point> ordered = points;
  // Far ones first, equal ones as they come: rims are blended, so that the order shows.
  const Vec3f forward = view.target - view.eye;
  std::stable_sort(ordered.begin(), ordered.end(), [&forward](const Point& a, const Point& b) {
    return a.position.dot(forward) > b.position.dot(forward);
  });
  std::vector<Instance> all;
  std::vector<Instance> shining_through;
  for (const Point& point : ordered) {
    const Instance instance = {point.position, point.colour,
                               0.5f * shown_diameter(point.diameter, view.pixel_scale)};
    all.push_back(instance);
    if (point.always_visible) shining_through.push_back(instance);
  }

  quads_.begin(view);
  if (!shining_through.empty()) quads_.draw(shining_through, GL_GEQUAL, 0.55f);
  quads_.draw(all, GL_LESS, 1.0f);
}

ShaderSources disc_shaders() { return {vertex_source, fragment_source}; }

}  // namespace pneuma::render
