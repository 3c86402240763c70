#include "render/passes/outlines.h"

#include <Eigen/Geometry>
#include <cstddef>

#include "render/passes/look.h"
#include "render/passes/shader_sources.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec3 from;
layout(location = 1) in vec4 from_normal;
layout(location = 2) in vec4 from_material;
layout(location = 3) in vec3 from_bounced;
layout(location = 4) in vec2 from_open;
layout(location = 5) in vec4 from_first_box;
layout(location = 6) in vec4 from_second_box;
layout(location = 7) in vec3 to;
layout(location = 8) in vec4 to_normal;
layout(location = 9) in vec4 to_material;
layout(location = 10) in vec3 to_bounced;
layout(location = 11) in vec2 to_open;
layout(location = 12) in vec4 to_first_box;
layout(location = 13) in vec4 to_second_box;
layout(location = 14) in vec3 facet_normal;
uniform mat4 view_projection;
uniform vec2 picture_size;
out vec3 world;
out vec4 surface;
out vec3 indirect;
out vec2 openness;
out vec4 near_first;
out vec4 near_second;
out vec4 outward;
flat out vec3 facet;
noperspective out float covered;
#ifdef SHADOWED
uniform mat4 world_to_map;
out vec3 in_map;
#endif

void main() {
  bool at_to = (gl_VertexID & 1) == 1;
  world = at_to ? to : from;
  surface = at_to ? to_material : from_material;
  indirect = at_to ? to_bounced : from_bounced;
  openness = at_to ? to_open : from_open;
  near_first = at_to ? to_first_box : from_first_box;
  near_second = at_to ? to_second_box : from_second_box;
  outward = at_to ? to_normal : from_normal;
  facet = facet_normal;
#ifdef SHADOWED
  in_map = (world_to_map * vec4(world, 1.0)).xyz;
#endif
  vec4 clip_from = view_projection * vec4(from, 1.0);
  vec4 clip_to = view_projection * vec4(to, 1.0);
  vec4 clip = at_to ? clip_to : clip_from;
  vec2 along = (clip_to.xy / clip_to.w - clip_from.xy / clip_from.w) * picture_size;
  along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  // What is seen of the surface lies on the left.
  vec2 right = vec2(along.y, -along.x);
  float away = (gl_VertexID & 2) == 2 ? 1.0 : -0.5;
  covered = 1.0 - away;
  gl_Position = clip + vec4(right * away * 2.0 / picture_size * clip.w, 0.0, 0.0);
}
)";

/// Unit.
Vec3f facet_normal(const DrawnSurface& surface, const Triangle& triangle) {
  const auto at = [&](std::size_t corner) -> const Vec3f& {
    return surface.vertices()[triangle[corner]].position;
  };
  return (at(1) - at(0)).cross(at(2) - at(0)).stableNormalized();
}

}  // namespace

Outlines::Variant::Variant(bool shadowed)
    : program("outlines",
              std::string("#define SMOOTH\n#define NEAR_BOXES\n#define OUTLINE\n") +
                  (shadowed ? "#define SHADOWED\n" : ""),
              vertex_source, look_source() + surface_shaders().fragment),
      uniforms(program, shadowed),
      picture_size(program.uniform("picture_size")) {}

std::vector<InstanceAttribute> Outlines::attributes() {
  std::vector<InstanceAttribute> result;
  for (const std::size_t end : {offsetof(Instance, from), offsetof(Instance, to)}) {
    result.push_back({3, end + offsetof(SurfaceVertex, position)});
    result.push_back({4, end + offsetof(SurfaceVertex, normal)});  // and flatness
    result.push_back({4, end + offsetof(SurfaceVertex, material)});
    result.push_back({3, end + offsetof(End, light) + offsetof(IndirectLight, bounced)});
    result.push_back({2, end + offsetof(End, light) + offsetof(IndirectLight, open_to)});
    const std::size_t boxes = end + offsetof(End, light) + offsetof(IndirectLight, near_boxes);
    result.push_back({4, boxes});
    result.push_back({4, boxes + sizeof(Eigen::Vector4f)});
  }
  result.push_back({3, offsetof(Instance, facet)});
  return result;
}

Outlines::Outlines() = default;

void Outlines::draw(const View& view, const DrawnSurface& surface,
                    const std::vector<IndirectLight>& light, const ShadowMap* shadow) {
  outline_.find(surface, view);
  instances_.clear();
  for (const OutlineEdge& edge : outline_.edges()) {
    instances_.push_back({{surface.vertices()[edge.from], light[edge.from]},
                          {surface.vertices()[edge.to], light[edge.to]},
                          facet_normal(surface, surface.triangles()[edge.triangle])});
  }
  if (instances_.empty()) return;
  const Variant& variant = shadow != nullptr ? shadowed_ : lit_;
  variant.program.use();
  variant.uniforms.set(view, shadow);
  set_uniform(variant.picture_size, picture_size(view));
  buffer_.draw(instances_, GL_LEQUAL);
}

const char* outline_vertex_source() { return vertex_source; }

}  // namespace pneuma::render
