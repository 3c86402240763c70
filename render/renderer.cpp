#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "render/check_frame.h"
#include "render/context/context.h"
#include "render/passes/background.h"
#include "render/passes/discs.h"
#include "render/passes/ground_plane.h"
#include "render/passes/ground_shadow.h"
#include "render/passes/lettering.h"
#include "render/passes/mesh_buffers.h"
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

}  // namespace

struct Renderer::Resources {
  explicit Resources(const RenderOptions& chosen)
      : options(check_options(chosen)),
        description(
            fmt::format("OpenGL {} on {}", context.report().version, context.report().renderer)),
        target(options.width, options.height, options.samples),
        shadow_map(options.shadow_size) {}

  // The members are released after this, while their context is current.
  ~Resources() { context.make_current(); }
  Resources(const Resources&) = delete;
  Resources& operator=(const Resources&) = delete;

  RenderOptions options;
  Context context;  // before all that lives in it
  std::string description;
  Target target;
  MeshBuffers mesh_buffers;
  ShadowMap shadow_map;
  GroundShadow ground_shadow;
  Surfaces surfaces;
  GroundPlane ground_plane;
  Background background;
  Segments segments;
  Discs discs;
  Lettering lettering;
};

Renderer::Renderer(const RenderOptions& options)
    : resources_(std::make_unique<Resources>(options)) {}

Renderer::~Renderer() = default;

void Renderer::draw(const Frame& frame, Image& image) {
  check_frame(frame);
  Resources& r = *resources_;
  r.context.make_current();
  const View view = make_view(frame, r.options.width, r.options.height);
  r.mesh_buffers.upload(frame.meshes);
  const std::vector<DrawnMesh>& meshes = r.mesh_buffers.meshes();

  const bool shadows = frame.light.shadows && !view.casters.empty();
  // Light along the ground or from below throws no shadow on it.
  const bool ground_shadow = shadows && frame.ground && view.to_light.z() > 0.05f;
  if (shadows) r.shadow_map.draw(view, frame.light, meshes);
  if (ground_shadow) r.ground_shadow.draw(r.shadow_map);

  r.target.begin();
  r.surfaces.draw(view, meshes, shadows ? &r.shadow_map : nullptr);
  if (frame.ground) {
    r.ground_plane.draw(view, *frame.ground, ground_shadow ? &r.shadow_map : nullptr,
                        ground_shadow ? &r.ground_shadow : nullptr);
  }
  // One row is left to the rounding of the ground's edges.
  r.background.draw(view, frame.ground ? std::max(0, rows_filled_by_ground(view) - 1) : 0);
  if (frame.wireframe) r.segments.draw_wireframe(view, frame.meshes);
  r.segments.draw_lines(view, frame.lines);
  r.discs.draw(view, frame.points);

  r.target.resolve();
  if (frame.caption) r.lettering.draw(view, frame.caption->text);
  r.target.read(image);
}

const std::string& Renderer::description() const { return resources_->description; }

}  // namespace pneuma::render
