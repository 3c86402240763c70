#include "render/passes/surfaces.h"

#include <algorithm>
#include <string>

#include "render/passes/look.h"
#include "render/passes/shader_sources.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
uniform mat4 view_projection;
out vec3 world;
out vec3 albedo;
#ifdef SMOOTH
out vec3 outward;
#endif
#ifdef SHADOWED
uniform mat4 world_to_map;
out vec3 in_map;
#endif

void main() {
  world = position;
  albedo = colour;
#ifdef SMOOTH
  outward = normal;
#endif
#ifdef SHADOWED
  in_map = (world_to_map * vec4(position, 1.0)).xyz;
#endif
  gl_Position = view_projection * vec4(position, 1.0);
}
)";

constexpr const char* fragment_source = R"(
in vec3 world;
in vec3 albedo;
uniform vec3 eye;
uniform vec3 to_light;
out vec4 colour;
#ifdef SMOOTH
in vec3 outward;
#endif
#ifdef SHADOWED
in vec3 in_map;
uniform sampler2DShadow map;
uniform float edge;  // in the map's coordinates

// Four reads of two by two texels each, on a square turned so that no two share a row.
float lit_share() {
  vec3 a = vec3(edge, 0.4 * edge, 0.0);
  vec3 b = vec3(-0.4 * edge, edge, 0.0);
  return (texture(map, in_map + a) + texture(map, in_map - a) +
          texture(map, in_map + b) + texture(map, in_map - b)) * 0.25;
}
#endif

void main() {
#ifdef SMOOTH
  vec3 n = normalize(outward);
#else
  vec3 n = normalize(cross(dFdx(world), dFdy(world)));
#endif
  vec3 to_eye = normalize(eye - world);
  float facing = dot(n, to_light);
  float lit = max(facing, 0.0);
#ifdef SHADOWED
  lit *= lit_share();
#endif
  vec3 light = mix(bounce, sky, n.z * 0.5 + 0.5) + sun * lit;

  // Phong's highlight: the light's mirror direction against the eye's, to the power of 64.
  float shine = max(dot(2.0 * facing * n - to_light, to_eye), 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  // What grazes a surface mirrors the sky, which sets a body off from what lies behind it.
  float grazing = 1.0 - max(dot(n, to_eye), 0.0);
  grazing *= grazing * grazing;
  colour = vec4(to_srgb(albedo * light + sun * (0.6 * shine * min(4.0 * lit, 1.0)) +
                        sky * (0.25 * grazing)), 1.0);
}
)";

std::string preamble(bool smooth, bool shadowed) {
  return std::string(smooth ? "#define SMOOTH\n" : "") + (shadowed ? "#define SHADOWED\n" : "");
}

}  // namespace

Surfaces::Surfaces() = default;

Surfaces::Variant::Variant(bool smooth, bool shadowed)
    : program("surfaces", preamble(smooth, shadowed), vertex_source,
              look_source() + fragment_source),
      view_projection(program.uniform("view_projection")),
      eye(program.uniform("eye")),
      to_light(program.uniform("to_light")) {
  if (!shadowed) return;
  world_to_map = program.uniform("world_to_map");
  edge = program.uniform("edge");
  program.use();
  set_uniform(program.uniform("map"), 0);
}

void Surfaces::draw(const View& view, const std::vector<DrawnMesh>& meshes,
                    const ShadowMap* shadow) {
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  if (shadow != nullptr) shadow->bind(0);
  draw_variant(shadow != nullptr ? smooth_shadowed_ : smooth_lit_, true, view, meshes, shadow);
  draw_variant(shadow != nullptr ? flat_shadowed_ : flat_lit_, false, view, meshes, shadow);
}

void Surfaces::draw_variant(const Variant& variant, bool smooth, const View& view,
                            const std::vector<DrawnMesh>& meshes, const ShadowMap* shadow) {
  if (std::none_of(meshes.begin(), meshes.end(),
                   [smooth](const DrawnMesh& mesh) { return mesh.smooth == smooth; })) {
    return;
  }
  variant.program.use();
  set_uniform(variant.view_projection, view.view_projection);
  set_uniform(variant.eye, view.eye);
  set_uniform(variant.to_light, view.to_light);
  if (shadow != nullptr) {
    set_uniform(variant.world_to_map, shadow->world_to_map());
    // A body's shadow on another falls from near by and is crisper than one on the ground. Further
    // apart than this, the four reads would be seen one by one.
    set_uniform(variant.edge, std::min(0.5f * shadow->edge(), 2.2f * shadow->texel()));
  }
  // Far sides of closed bodies are never seen. With several samples a pixel llvmpipe shades even
  // what then fails the depth test, so that drawing them would cost as much again.
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  for (const DrawnMesh& mesh : meshes) {
    if (mesh.smooth != smooth) continue;
    glBindVertexArray(mesh.vao);
    glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_CULL_FACE);
}

ShaderSources surface_shaders() { return {vertex_source, fragment_source}; }

}  // namespace pneuma::render
