#include "render/passes/ground_plane.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "render/passes/look.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec2 position;
uniform mat4 view_projection;
uniform float spacing;
uniform vec2 centre;
uniform float radius;
out vec2 on_grid;      // in spacings
out vec2 from_centre;  // in radii
#ifdef SHADOWED
uniform mat4 world_to_map;
out vec2 in_map;
#endif

void main() {
  vec4 world = vec4(position, 0.0, 1.0);
  on_grid = position / spacing;
  from_centre = (position - centre) / radius;
#ifdef SHADOWED
  in_map = (world_to_map * world).xy;
#endif
  gl_Position = view_projection * world;
}
)";

constexpr const char* fragment_source = R"(
in vec2 on_grid;
in vec2 from_centre;
uniform float picture_height;
uniform float line_width;  // pixels
uniform vec3 to_light;
out vec4 colour;
#ifdef SHADOWED
in vec2 in_map;
uniform sampler2D narrow;
uniform sampler2D wide;
#endif

// How much of the pixel a line covers: one across each whole number.
float lines(vec2 at, vec2 pixel) {
  vec2 away = abs(fract(at - 0.5) - 0.5) / pixel;
  vec2 covered = clamp(0.5 * line_width + 0.5 - away, 0.0, 1.0);
  // Lines closer than a few pixels would flicker: fade them out before.
  covered *= clamp(1.5 - 6.0 * pixel, 0.0, 1.0);
  return max(covered.x, covered.y);
}

void main() {
  vec3 distant = backdrop(gl_FragCoord.y / picture_height);
  float near = max(1.0 - dot(from_centre, from_centre), 0.0);
  near *= near;
  vec2 pixel = fwidth(on_grid);
  float grid = max(0.07 * lines(on_grid, pixel), 0.16 * lines(on_grid * 0.2, pixel * 0.2));
  vec3 ground = mix(distant, vec3(0.925, 0.925, 0.922), 0.6 * near) * (1.0 - near * grid);
#ifdef SHADOWED
  vec2 crisp = texture(narrow, in_map).rg;
  vec2 soft = texture(wide, in_map).rg;
  float softness = soft.g / max(soft.r, 0.004);
  float blocked = mix(crisp.r, soft.r, softness);
  vec3 arriving = sky + sun * to_light.z;
  // sRGB is close to linear to the power of 1 / 2.2, and so are products.
  ground *= pow(1.0 - blocked * near * sun * to_light.z / arriving, vec3(1.0 / 2.2));
#endif
  colour = vec4(ground, 1.0);
}
)";

struct Rectangle {
  Eigen::Vector2f min;
  Eigen::Vector2f max;
};

using Vertices = std::vector<Eigen::Vector2f>;

void add_rectangle(Vertices& vertices, const Rectangle& r) {
  if ((r.min.array() >= r.max.array()).any()) return;
  const Eigen::Vector2f a = r.min;
  const Eigen::Vector2f b = {r.max.x(), r.min.y()};
  const Eigen::Vector2f c = r.max;
  const Eigen::Vector2f d = {r.min.x(), r.max.y()};
  vertices.insert(vertices.end(), {a, b, c, a, c, d});
}

/// `whole` without `hole`, which lies within it, as the outer eight of three by three rectangles:
/// they share all their corners with their neighbours, so that no pixel falls between two.
void add_frame(Vertices& vertices, const Rectangle& whole, const Rectangle& hole) {
  const std::array<float, 4> x = {whole.min.x(), hole.min.x(), hole.max.x(), whole.max.x()};
  const std::array<float, 4> y = {whole.min.y(), hole.min.y(), hole.max.y(), whole.max.y()};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (i == 1 && j == 1) continue;
      add_rectangle(vertices, {{x[i], y[j]}, {x[i + 1], y[j + 1]}});
    }
  }
}

/// Around where the map's four edges meet the ground.
Rectangle shadow_on_ground(const ShadowMap& map, const Vec3f& to_light, const Rectangle& whole) {
  const Mat4f to_world = map.world_to_map().inverse();
  Box box;
  for (int i = 0; i < 4; ++i) {
    const Vec3f corner =
        (to_world * Eigen::Vector4f(static_cast<float>(i & 1), static_cast<float>(i >> 1), 0, 1))
            .head<3>();
    box.grow(corner - to_light * (corner.z() / to_light.z()));
  }
  return {box.min.head<2>().cwiseMax(whole.min).cwiseMin(whole.max),
          box.max.head<2>().cwiseMin(whole.max).cwiseMax(whole.min)};
}

}  // namespace

GroundPlane::Variant::Variant(bool shadowed)
    : program("ground", shadowed ? "#define SHADOWED\n" : "", vertex_source,
              std::string(look_source) + fragment_source),
      view_projection(program.uniform("view_projection")),
      picture_height(program.uniform("picture_height")),
      spacing(program.uniform("spacing")),
      centre(program.uniform("centre")),
      radius(program.uniform("radius")),
      line_width(program.uniform("line_width")) {
  if (!shadowed) return;
  to_light = program.uniform("to_light");
  world_to_map = program.uniform("world_to_map");
  program.use();
  set_uniform(program.uniform("narrow"), 0);
  set_uniform(program.uniform("wide"), 1);
}

GroundPlane::GroundPlane() {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  set_attribute(0, 2, sizeof(Eigen::Vector2f), 0);
}

void GroundPlane::set_up(const Variant& variant, const View& view, const Ground& ground) {
  variant.program.use();
  set_uniform(variant.view_projection, view.view_projection);
  set_uniform(variant.picture_height, static_cast<float>(view.height));
  set_uniform(variant.spacing, ground.grid_spacing);
  set_uniform(variant.centre, Eigen::Vector2f(view.target.head<2>()));
  set_uniform(variant.radius, ground_radius(view));
  set_uniform(variant.line_width, view.pixel_scale);
}

void GroundPlane::draw(const View& view, const Ground& ground, const ShadowMap* map,
                       const GroundShadow* shadow) {
  if (view.eye.z() <= 0.0f) return;
  const Eigen::Vector2f centre = view.target.head<2>();
  const Eigen::Vector2f radius = Eigen::Vector2f::Constant(ground_radius(view));
  const Rectangle whole = {centre - radius, centre + radius};
  Vertices vertices;
  GLsizei dark_count = 0;
  if (map != nullptr) {
    const Rectangle dark = shadow_on_ground(*map, view.to_light, whole);
    add_rectangle(vertices, dark);
    dark_count = static_cast<GLsizei>(vertices.size());
    add_frame(vertices, whole, dark);
  } else {
    add_rectangle(vertices, whole);
  }

  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Eigen::Vector2f)),
               vertices.data(), GL_STREAM_DRAW);
  const auto count = static_cast<GLsizei>(vertices.size());
  if (map != nullptr) {
    set_up(shadowed_, view, ground);
    set_uniform(shadowed_.to_light, view.to_light);
    set_uniform(shadowed_.world_to_map, map->world_to_map());
    shadow->bind(0, 1);
    glDrawArrays(GL_TRIANGLES, 0, dark_count);
  }
  set_up(plain_, view, ground);
  glDrawArrays(GL_TRIANGLES, dark_count, count - dark_count);
}

}  // namespace pneuma::render
