#include "render/passes/ground_plane.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "render/passes/look.h"
#include "render/passes/shader_sources.h"

namespace pneuma::render {
namespace {

constexpr const char* colour_vertex_source = R"(
layout(location = 0) in vec2 position;
uniform mat4 view_projection;
uniform float spacing;
uniform vec2 centre;
uniform float radius;
out vec2 on_grid;      // in spacings
out vec2 from_centre;  // in radii

void main() {
  on_grid = position / spacing;
  from_centre = (position - centre) / radius;
  gl_Position = view_projection * vec4(position, 0.0, 1.0);
}
)";

constexpr const char* colour_fragment_source = R"(
in vec2 on_grid;
in vec2 from_centre;
uniform float picture_height;
uniform float line_width;  // pixels
out vec4 colour;

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
  float near = nearness(from_centre);
  vec2 pixel = fwidth(on_grid);
  float grid = max(0.05 * lines(on_grid, pixel), 0.11 * lines(on_grid * 0.2, pixel * 0.2));
  vec3 ground = mix(distant, vec3(0.800, 0.797, 0.788), near) * (1.0 - near * grid);
  colour = vec4(ground, 1.0);
}
)";

constexpr const char* shadow_vertex_source = R"(
layout(location = 0) in vec2 position;
uniform mat4 view_projection;
uniform mat4 world_to_map;
uniform vec2 centre;
uniform float radius;
out vec2 from_centre;  // in radii
out vec2 in_map;

void main() {
  vec4 world = vec4(position, 0.0, 1.0);
  from_centre = (position - centre) / radius;
  in_map = (world_to_map * world).xy;
  gl_Position = view_projection * world;
#ifdef FARTHEST
  gl_Position.z = gl_Position.w;
#endif
}
)";

constexpr const char* shadow_fragment_source = R"(
in vec2 from_centre;
in vec2 in_map;
uniform sampler2D shadow;
uniform float fading;
out vec4 fraction;  // of the ground's colour that is left

void main() {
  float near = max(1.0 - length(in_map - clamp(in_map, 0.0, 1.0)) / fading, 0.0);
  float seen = near * near * nearness(from_centre);
  fraction = vec4(mix(vec3(1.0), texture(shadow, in_map).rgb, seen), 1.0);
}
)";

constexpr const char* depth_vertex_source = R"(
layout(location = 0) in vec2 position;
uniform mat4 view_projection;
void main() { gl_Position = view_projection * vec4(position, 0.0, 1.0); }
)";

constexpr const char* depth_fragment_source = "void main() {}\n";

// How strongly the ground is seen, from 1 at the middle to 0 where it has faded into the distance.
constexpr const char* ground_nearness = R"(
float nearness(vec2 from_centre) {
  float near = max(1.0 - dot(from_centre, from_centre), 0.0);
  return near * near;
}
)";

using Vertices = std::vector<Eigen::Vector2f>;

Eigen::Vector2f centre_of(const View& view) { return view.target.head<2>(); }

/// Two triangles; neighbours that share corners share every edge, so that no pixel falls between
/// two or to both.
void add_quadrangle(Vertices& vertices, const Eigen::Vector2f& a, const Eigen::Vector2f& b,
                    const Eigen::Vector2f& c, const Eigen::Vector2f& d) {
  vertices.insert(vertices.end(), {a, b, c, c, b, d});
}

Vertices whole_ground(const View& view) {
  const Eigen::Vector2f centre = centre_of(view);
  const float radius = ground_radius(view);
  Vertices vertices;
  add_quadrangle(vertices, centre + Eigen::Vector2f(-radius, -radius),
                 centre + Eigen::Vector2f(radius, -radius),
                 centre + Eigen::Vector2f(-radius, radius),
                 centre + Eigen::Vector2f(radius, radius));
  return vertices;
}

/// Columns and rows, up to those before `right` and `high`.
struct CellRange {
  int left = 0, low = 0, right = 0, high = 0;

  std::size_t count() const {
    return static_cast<std::size_t>(right - left) * static_cast<std::size_t>(high - low);
  }
};

/// Around all of these, which are in rows from low to high.
CellRange range_of(const std::vector<std::array<int, 2>>& cells) {
  if (cells.empty()) return {};
  CellRange range = {cells[0][0], cells.front()[1], cells[0][0] + 1, cells.back()[1] + 1};
  for (const auto& [column, row] : cells) {
    range.left = std::min(range.left, column);
    range.right = std::max(range.right, column + 1);
  }
  return range;
}

Vertices dark_ground(const GroundShadow& shadow) {
  const auto corner = [&](int column, int row) {
    constexpr float cells = GroundShadow::cells;
    return shadow.on_ground(static_cast<float>(column) / cells, static_cast<float>(row) / cells);
  };
  Vertices vertices;
  const auto add = [&](int left, int low, int right, int high) {
    add_quadrangle(vertices, corner(left, low), corner(right, low), corner(left, high),
                   corner(right, high));
  };
  // Two large triangles take less than many small ones with few light cells among them.
  const CellRange range = range_of(shadow.dark_cells());
  if (4 * shadow.dark_cells().size() > 3 * range.count()) {
    add(range.left, range.low, range.right, range.high);
    return vertices;
  }
  for (const auto& [column, row] : shadow.dark_cells()) add(column, row, column + 1, row + 1);
  return vertices;
}

}  // namespace

GroundPlane::GroundPlane()
    : colour_("ground", "", colour_vertex_source,
              look_source() + ground_nearness + colour_fragment_source),
      colour_view_projection_(colour_.uniform("view_projection")),
      colour_picture_height_(colour_.uniform("picture_height")),
      colour_spacing_(colour_.uniform("spacing")),
      colour_centre_(colour_.uniform("centre")),
      colour_radius_(colour_.uniform("radius")),
      colour_line_width_(colour_.uniform("line_width")),
      shadow_("shadow on the ground", "#define FARTHEST\n", shadow_vertex_source,
              std::string(ground_nearness) + shadow_fragment_source),
      shadow_view_projection_(shadow_.uniform("view_projection")),
      shadow_world_to_map_(shadow_.uniform("world_to_map")),
      shadow_centre_(shadow_.uniform("centre")),
      shadow_radius_(shadow_.uniform("radius")),
      depth_("depth of the ground", "", depth_vertex_source, depth_fragment_source),
      depth_view_projection_(depth_.uniform("view_projection")) {
  glBindVertexArray(vao_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  set_attribute(0, 2, sizeof(Eigen::Vector2f), 0);
  shadow_.use();
  set_uniform(shadow_.uniform("shadow"), 0);
  set_uniform(shadow_.uniform("fading"), GroundShadow::fading);
}

void GroundPlane::draw_triangles(const std::vector<Eigen::Vector2f>& vertices) {
  glBindVertexArray(vao_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Eigen::Vector2f)),
               vertices.data(), GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
}

void GroundPlane::draw(const View& view, const Ground& ground) {
  if (view.eye.z() <= 0.0f) return;
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  colour_.use();
  set_uniform(colour_view_projection_, view.view_projection);
  set_uniform(colour_picture_height_, static_cast<float>(view.height));
  set_uniform(colour_spacing_, ground.grid_spacing);
  set_uniform(colour_centre_, centre_of(view));
  set_uniform(colour_radius_, ground_radius(view));
  set_uniform(colour_line_width_, view.pixel_scale);
  draw_triangles(whole_ground(view));
}

void GroundPlane::darken(const View& view, const GroundShadow& shadow, bool surfaces_drawn) {
  if (view.eye.z() <= 0.0f) return;
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  if (surfaces_drawn) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
  } else {
    glDisable(GL_DEPTH_TEST);
  }
  shadow_.use();
  set_uniform(shadow_view_projection_, view.view_projection);
  set_uniform(shadow_world_to_map_, shadow.world_to_picture());
  set_uniform(shadow_centre_, centre_of(view));
  set_uniform(shadow_radius_, ground_radius(view));
  shadow.bind(0);
  draw_triangles(dark_ground(shadow));
}

void GroundPlane::hide_below(const View& view) {
  if (view.eye.z() <= 0.0f) return;
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  depth_.use();
  set_uniform(depth_view_projection_, view.view_projection);
  draw_triangles(whole_ground(view));
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

ShaderSources ground_shaders() { return {colour_vertex_source, colour_fragment_source}; }

ShaderSources ground_shadow_shaders() { return {shadow_vertex_source, shadow_fragment_source}; }

const char* nearness_source() { return ground_nearness; }

}  // namespace pneuma::render
