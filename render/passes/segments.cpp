#include "render/passes/segments.h"

#include <cstddef>
#include <map>

#include "render/passes/mesh_marks.h"
#include "render/passes/shader_sources.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec3 line_colour;
layout(location = 3) in float width;
uniform mat4 view;
uniform mat4 projection;
uniform vec2 picture_size;
uniform float near;
noperspective out float across;  // pixels from the middle of the line
flat out float half_width;
flat out vec3 shade;

void main() {
  // Nearer to the eye by a thousandth, along the line of sight, so that what lies on a surface is
  // not lost in it.
  vec3 a = (view * vec4(from, 1.0)).xyz * 0.999;
  vec3 b = (view * vec4(to, 1.0)).xyz * 0.999;
  // What lies behind the eye has no place in the picture: shorten the line to what lies before it.
  float plane = -near * 1.001;
  if (a.z > plane && b.z < plane) a = mix(b, a, (plane - b.z) / (a.z - b.z));
  if (b.z > plane && a.z < plane) b = mix(a, b, (plane - a.z) / (b.z - a.z));
  vec4 clip_a = projection * vec4(a, 1.0);
  vec4 clip_b = projection * vec4(b, 1.0);
  bool at_b = (gl_VertexID & 1) == 1;
  vec4 clip = at_b ? clip_b : clip_a;

  vec2 along = (clip_b.xy / clip_b.w - clip_a.xy / clip_a.w) * picture_size;
  along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  float side = (gl_VertexID & 2) == 2 ? 1.0 : -1.0;
  half_width = 0.5 * width;
  float reach = half_width + 1.0;  // one more pixel for the soft edge
  vec2 offset = vec2(-along.y, along.x) * side * reach + along * (at_b ? half_width : -half_width);
  across = side * reach;
  shade = line_colour;
  gl_Position = clip + vec4(offset * 2.0 / picture_size * clip.w, 0.0, 0.0);
}
)";

constexpr const char* fragment_source = R"(
noperspective in float across;
flat in float half_width;
flat in vec3 shade;
uniform float opacity;
out vec4 colour;

void main() {
  float covered = clamp(half_width + 0.5 - abs(across), 0.0, min(2.0 * half_width, 1.0));
  colour = vec4(shade, covered * opacity);
}
)";

constexpr float faint = 0.4f;  // opacity

}  // namespace

Segments::Segments()
    : quads_("lines", vertex_source, fragment_source,
             {{3, offsetof(Instance, from)},
              {3, offsetof(Instance, to)},
              {3, offsetof(Instance, colour)},
              {1, offsetof(Instance, width)}}),
      near_(quads_.program().uniform("near")) {}

void Segments::add(const View& view, const Line& line) {
  instances_.push_back({line.from, line.to, line.colour, line.width * view.pixel_scale});
}

void Segments::draw_lines(const View& view, const std::vector<Line>& lines) {
  instances_.clear();
  for (const Line& line : lines) {
    if (line.always_visible && !line.through) add(view, line);
  }
  draw(view, GL_GEQUAL, faint);
  draw_through(view, lines);
  instances_.clear();
  for (const Line& line : lines) add(view, line);
  draw(view, GL_LESS, 1.0f);
}

void Segments::draw_through(const View& view, const std::vector<Line>& lines) {
  std::map<std::uint32_t, std::vector<const Line*>> by_mesh;
  for (const Line& line : lines) {
    if (line.always_visible && line.through) by_mesh[*line.through].push_back(&line);
  }
  if (by_mesh.empty()) return;
  glEnable(GL_STENCIL_TEST);
  for (const auto& [mesh, own] : by_mesh) {
    instances_.clear();
    for (const Line* line : own) add(view, *line);
    for (const GLint mark : {MeshMarks::none, MeshMarks::of(mesh)}) {
      glStencilFunc(GL_EQUAL, mark, 0xff);
      draw(view, GL_GEQUAL, faint);
    }
  }
  glDisable(GL_STENCIL_TEST);
}

void Segments::draw_wireframe(const View& view, const std::vector<Mesh>& meshes) {
  const Colour ink = {0.09f, 0.10f, 0.12f};
  instances_.clear();
  for (const Mesh& mesh : meshes) {
    for (const auto& [from, to] : mesh.shape->edges) {
      instances_.push_back(
          {mesh.positions[from], mesh.positions[to], ink, 1.1f * view.pixel_scale});
    }
  }
  draw(view, GL_LESS, 0.7f);
}

void Segments::draw(const View& view, GLenum depth_test, float opacity) {
  if (instances_.empty()) return;
  quads_.begin(view);
  set_uniform(near_, view.near);
  quads_.draw(instances_, depth_test, opacity);
}

ShaderSources line_shaders() { return {vertex_source, fragment_source}; }

}  // namespace pneuma::render
