#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "render/context/context.h"
#include "render/frame/check_frame.h"
#include "render/geometry/drawn_surface.h"
#include "render/light/box_contacts.h"
#include "render/light/indirect.h"
#include "render/passes/discs.h"
#include "render/passes/ground_plane.h"
#include "render/passes/ground_shadow.h"
#include "render/passes/layer.h"
#include "render/passes/lettering.h"
#include "render/passes/mesh_marks.h"
#include "render/passes/outlines.h"
#include "render/passes/scenery.h"
#include "render/passes/segments.h"
#include "render/passes/shadow_map.h"
#include "render/passes/surfaces.h"
#include "render/passes/target.h"

namespace pneuma::render {
namespace {

void require(bool fine, const char* what, int value, const char* allowed) {
  if (fine) return;
  throw std::invalid_argument(
      fmt::format("render options: {} is {}; allowed is {}", what, value, allowed));
}

const RenderOptions& check_options(const RenderOptions& options) {
  require(options.width >= 16 && options.width <= 16384, "width", options.width, "16..16384");
  require(options.height >= 16 && options.height <= 16384, "height", options.height, "16..16384");
  require(options.samples == 1 || options.samples == 2 || options.samples == 4, "samples",
          options.samples, "1, 2 or 4");
  require(options.shadow_size >= 256 && options.shadow_size <= 8192, "shadow_size",
          options.shadow_size, "256..8192");
  return options;
}

/// Whether the ground hides anything that would be seen without it, of surfaces drawn in a box.
/// What stands on the ground is drawn above it, or sinks in by far less than a pixel; but lines and
/// discs are wider than what they stand for.
bool ground_hides(const Frame& frame, const View& view, const Box& drawn) {
  if (!frame.ground) return false;
  if (frame.wireframe || !frame.points.empty() || !frame.lines.empty()) return true;
  if (drawn.empty()) return false;
  const float pixel =
      2.0f * view.nearest / (view.projection(1, 1) * static_cast<float>(view.height));
  return drawn.min.z() < -0.1f * pixel;
}

}  // namespace

struct Renderer::Resources {
  explicit Resources(const RenderOptions& chosen)
      : options(check_options(chosen)),
        context({.backend = chosen.backend}),
        description(fmt::format("OpenGL {} on {}, by {}", context.report().version,
                                context.report().renderer, to_string(context.backend()))),
        target(options.width, options.height),
        layer(target, options.samples),
        shadow_map(options.shadow_size),
        scenery(options.width, options.height) {}

  // The members are released after this, while their context is current.
  ~Resources() { context.make_current(); }
  Resources(const Resources&) = delete;
  Resources& operator=(const Resources&) = delete;

  void draw_shadows(const Frame& frame, const View& view, bool on_ground);
  /// After draw_shadows, if there are any.
  void light_surface(const Frame& frame, const View& view, bool between_bodies, bool on_ground);

  RenderOptions options;
  Context context;  // before all that lives in it
  std::string description;
  Target target;
  Layer layer;
  DrawnSurface surface;
  SurfaceBuffers surface_buffers;
  IndirectLighting indirect;
  BoxContacts box_contacts;
  std::vector<IndirectLight> lit;    // per lit vertex
  std::vector<IndirectLight> drawn;  // per drawn vertex
  bool has_near_boxes = false;       // any of it
  ShadowMap shadow_map;
  ShadowDepths shadow_depths;
  GroundShadow ground_shadow;
  Surfaces surfaces;
  Outlines outlines;
  GroundPlane ground_plane;
  Scenery scenery;
  MeshMarks mesh_marks;
  Segments segments;
  Discs discs;
  Lettering lettering;
};

void Renderer::Resources::draw_shadows(const Frame& frame, const View& view, bool on_ground) {
  shadow_map.draw(view, frame.light, surface_buffers);
  shadow_map.read(shadow_depths);
  indirect.take_bodies(
      frame.light.between_bodies ? frame.meshes : std::vector<Mesh>(), view.to_light,
      [this](const Vec3f& point) { return shadow_depths.lit(point); }, on_ground);
  if (on_ground) {
    ground_shadow.draw(shadow_map, shadow_depths, view.to_light, indirect.bodies(), surface);
  }
}

void Renderer::Resources::light_surface(const Frame& frame, const View& view, bool between_bodies,
                                        bool on_ground) {
  if (between_bodies) {
    indirect.light(surface,
                   on_ground ? FloorLeft([this](const Vec3f& position, const Vec3f& normal) {
                     return ground_shadow.left_below(position, normal);
                   })
                             : FloorLeft(),
                   lit);
    has_near_boxes = box_contacts.find(frame.meshes, surface, view.eye, lit);
  } else {
    has_near_boxes = false;
    lit.assign(surface.positions().size(), IndirectLight{});
  }
  surface.spread(lit, drawn);
  surface_buffers.upload_light(drawn);
}

Renderer::Renderer(const RenderOptions& options)
    : resources_(std::make_unique<Resources>(options)) {}

Renderer::~Renderer() = default;

void Renderer::draw(const Frame& frame, Image& image) {
  check_frame(frame);
  Resources& r = *resources_;
  r.context.make_current();
  glDisable(GL_SCISSOR_TEST);  // which a frame that failed half way may have left
  View view = make_view(frame, r.options.width, r.options.height);
  r.surface.build(frame, view);
  Box drawn;
  for (const SurfaceVertex& vertex : r.surface.vertices()) drawn.grow(vertex.position);
  if (!drawn.empty()) {
    view.casters.grow(drawn.min);
    view.casters.grow(drawn.max);
  }
  r.surface_buffers.upload(r.surface);

  const bool shadows = frame.light.shadows && !view.casters.empty();
  // Light along the ground or from below throws no shadow on it.
  const bool ground_shadow = shadows && frame.ground && view.to_light.z() > 0.05f;
  if (shadows) r.draw_shadows(frame, view, ground_shadow);
  r.light_surface(frame, view, shadows && frame.light.between_bodies, ground_shadow);

  r.target.begin();
  r.scenery.draw(view, frame.ground, r.ground_plane);
  const bool hides = ground_hides(frame, view, drawn);
  // Surfaces in one layer with the ground come first: it is not darkened where they hide it.
  const bool surfaces_first = r.options.samples == 1 && !hides;
  if (ground_shadow && !surfaces_first) r.ground_plane.darken(view, r.ground_shadow, false);

  r.layer.begin(frame, view, r.surface.vertices());
  if (hides) r.ground_plane.hide_below(view);
  const ShadowMap* shadow = shadows ? &r.shadow_map : nullptr;
  r.surfaces.draw(view, r.surface_buffers, shadow, r.has_near_boxes, frame.wireframe);
  if (ground_shadow && surfaces_first) r.ground_plane.darken(view, r.ground_shadow, true);
  // Several samples smooth outlines by themselves.
  if (r.options.samples == 1) r.outlines.draw(view, r.surface, r.drawn, shadow);
  if (frame.wireframe) r.segments.draw_wireframe(view, frame.meshes);
  const bool marks = std::ranges::any_of(
      frame.lines, [](const Line& line) { return line.always_visible && line.through; });
  if (marks) r.mesh_marks.draw(view, r.surface, r.surface_buffers);
  r.segments.draw_lines(view, frame.lines);
  r.discs.draw(view, frame.points);
  r.layer.end();

  r.lettering.draw(view, frame);
  r.target.read(image);
}

const std::string& Renderer::description() const { return resources_->description; }

}  // namespace pneuma::render
