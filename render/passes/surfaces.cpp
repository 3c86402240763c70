#include "render/passes/surfaces.h"

#include <algorithm>
#include <string>

#include "render/passes/look.h"
#include "render/passes/shader_sources.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;    // and flatness
layout(location = 2) in vec4 material;  // linear colour, roughness
layout(location = 3) in vec3 bounced;   // light from other bodies
layout(location = 4) in vec2 open_to;   // how much is seen of the sky, and of the lit ground
#ifdef NEAR_BOXES
layout(location = 5) in vec4 first_box;
layout(location = 6) in vec4 second_box;
out vec4 near_first;
out vec4 near_second;
#endif
uniform mat4 view_projection;
out vec3 world;
out vec4 surface;
out vec3 indirect;
out vec2 openness;
#ifdef SMOOTH
out vec4 outward;
#endif
#ifdef SHADOWED
uniform mat4 world_to_map;
out vec3 in_map;
#endif

void main() {
  world = position;
  surface = material;
  indirect = bounced;
  openness = open_to;
#ifdef NEAR_BOXES
  near_first = first_box;
  near_second = second_box;
#endif
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
in vec4 surface;
in vec3 indirect;
in vec2 openness;
uniform vec3 eye;
uniform vec3 to_light;
out vec4 colour;
#ifdef SMOOTH
in vec4 outward;  // and flatness
#endif
#ifdef OUTLINE
flat in vec3 facet;
noperspective in float covered;
#endif
#ifdef NEAR_BOXES
in vec4 near_first;
in vec4 near_second;

// See light/box_contacts.h. `at`: a raised point in the box's axes, and half its side, in reaches.
float left_by_box(vec4 at) {
  vec3 away = abs(at.xyz) - at.w;
  float outside = length(max(away, 0.0));
  float inside = min(max(away.x, max(away.y, away.z)), 0.0);
  return clamp(0.5 + 0.5 * (outside + inside), 0.0, 1.0);
}
#endif
#ifdef SHADOWED
in vec3 in_map;
uniform sampler2DShadow map;
uniform mat4 world_to_map;
uniform float edge;       // in the map's coordinates
uniform float texel;      // likewise
uniform vec3 lean_scale;  // see SurfaceUniforms

// Three reads of two by two texels each, on a triangle turned so that no two share a row. The facet
// has another depth there: where it meets the far side, which is in the map, that is no deeper.
float lit_share(vec3 facet, float bend) {
  vec3 turned = mat3(world_to_map) * facet;
  // How fast its depth changes over the map, within a limit: light that comes along a facet hardly
  // lights it. That of a coarse surface is lit as its normals say; with as much as a box's, light
  // would get in under a plate on it.
  float least = lean_scale.y * min(1.0 + 40.0 * bend, 3.0);
  vec2 lean = turned.xy * (lean_scale.x / max(-turned.z, least));
  // A read mixes texels that lie up to one away. Both sides of a body that has collapsed lie in
  // each other: half a texel lets the sun through.
  vec3 at = in_map - vec3(0.0, 0.0, (abs(lean.x) + abs(lean.y) + lean_scale.z) * texel);
  vec2 first = vec2(0.97, 0.26) * edge;
  vec2 second = vec2(-0.71, 0.71) * edge;
  vec3 a = vec3(first, dot(first, lean));
  vec3 b = vec3(second, dot(second, lean));
  return (texture(map, at + a) + texture(map, at + b) + texture(map, at - a - b)) * (1.0 / 3.0);
}
#endif

void main() {
#ifndef OUTLINE
  vec3 facet = normalize(cross(dFdx(world), dFdy(world)));
  const float covered = 1.0;
#endif
#ifdef SMOOTH
  vec3 n = normalize(outward.xyz);
  float bend = 1.0 - outward.w;
#else
  vec3 n = facet;
  const float bend = 0.0;
#endif
  vec3 to_eye = normalize(eye - world);
  float towards_eye = dot(n, to_eye);
  float nv = clamp(towards_eye, 0.0, 1.0);
  float nl = max(dot(n, to_light), 0.0);
  // Of the half vector h: |to_eye + to_light|^2 = 2 + 2 to_eye . to_light.
  float el = dot(to_eye, to_light);
  float over_length = inversesqrt(max(2.0 + 2.0 * el, 1e-6));
  float nh = max(towards_eye + dot(n, to_light), 0.0) * over_length;
  float vh = (1.0 + el) * over_length;
  float lit = nl;
#ifdef SHADOWED
  lit *= lit_share(facet, bend);
#endif
  float roughness = surface.a;
#ifdef NEAR_BOXES
  float left_by_first = left_by_box(near_first);
  float left_by_second = left_by_box(near_second);
  float left = left_by_first * left_by_second;
  // Between faces that nearly touch, the gap is too narrow for the shadow map.
  lit *= min(2.0 * min(left_by_first, left_by_second), 1.0);
#else
  const float left = 1.0;
#endif
  vec2 open = openness * left;
  vec3 diffuse = sun * lit + sky_irradiance(n.z) * open.x + indirect * left +
                 floor_light * (0.5 - 0.5 * n.z) * open.y;
  // What is mirrored of sky and ground; a rough surface blurs the horizon between them.
  float up = 2.0 * nv * n.z - to_eye.z;
  vec3 mirrored = mix(floor_light * open.y, sky_light(max(up, 0.0)) * open.x,
                      smoothstep(-roughness, roughness, up));
  // Interpolated normals of a coarse surface turn away from the eye long before it does itself.
  float reflected = fresnel(max((towards_eye + bend) / (1.0 + bend), 0.0), roughness);
  float shine = highlight(nl, nv, nh, vh, roughness);
  vec3 light = mix(entering * surface.rgb * diffuse, mirrored, reflected) + sun * (lit * shine);
  colour = vec4(shown(light), min(covered, 1.0));
}
)";

}  // namespace

Surfaces::Surfaces() = default;

SurfaceUniforms::SurfaceUniforms(const Program& program, bool shadowed)
    : view_projection(program.uniform("view_projection")),
      eye(program.uniform("eye")),
      to_light(program.uniform("to_light")) {
  if (!shadowed) return;
  world_to_map = program.uniform("world_to_map");
  edge = program.uniform("edge");
  texel = program.uniform("texel");
  lean_scale = program.uniform("lean_scale");
  program.use();
  set_uniform(program.uniform("map"), 0);
}

void SurfaceUniforms::set(const View& view, const ShadowMap* shadow) const {
  set_uniform(view_projection, view.view_projection);
  set_uniform(eye, view.eye);
  set_uniform(to_light, view.to_light);
  if (shadow == nullptr) return;
  shadow->bind(0);
  set_uniform(world_to_map, shadow->world_to_map());
  // A body's shadow on another falls from near by and is crisper than one on the ground. Further
  // apart than this, the three reads would be seen one by one.
  set_uniform(edge, std::min(0.5f * shadow->edge(), 2.2f * shadow->texel()));
  set_uniform(texel, shadow->texel());
  // A normal is scaled the other way than the axes. Light comes along a facet by up to ten to one.
  const float steepness = shadow->extent() / shadow->depth_range();
  set_uniform(lean_scale,
              Vec3f(steepness * steepness, 0.1f / shadow->depth_range(), 0.5f * steepness));
}

Surfaces::Variant::Variant(bool shadowed, bool near_boxes)
    : program("surfaces",
              std::string("#define SMOOTH\n") + (near_boxes ? "#define NEAR_BOXES\n" : "") +
                  (shadowed ? "#define SHADOWED\n" : ""),
              vertex_source, look_source() + fragment_source),
      uniforms(program, shadowed) {}

void Surfaces::use(const Variant& variant, const View& view, const ShadowMap* shadow) {
  variant.program.use();
  variant.uniforms.set(view, shadow);
}

void Surfaces::draw(const View& view, const SurfaceBuffers& surface, const ShadowMap* shadow,
                    bool near_boxes, bool under_lines) {
  const Variants& variants = near_boxes ? of_near_boxes_ : usual_;
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  // Far sides of closed bodies are never seen. With several samples a pixel llvmpipe shades even
  // what then fails the depth test, so that drawing them would cost as much again.
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  if (under_lines) {
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0f, 0.0f);  // by what the depth changes over one pixel
  }
  if (shadow != nullptr) {
    use(variants.shadowed, view, shadow);
    surface.draw_sunward();
    // The sun does not reach these, whatever the map says.
    use(variants.lit, view, nullptr);
    surface.draw_averted();
  } else {
    use(variants.lit, view, nullptr);
    surface.draw();
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CULL_FACE);
}

ShaderSources surface_shaders() { return {vertex_source, fragment_source}; }

}  // namespace pneuma::render
