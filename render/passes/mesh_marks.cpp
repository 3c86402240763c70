#include "render/passes/mesh_marks.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec3 position;
uniform mat4 view_projection;
void main() { gl_Position = view_projection * vec4(position, 1.0); }
)";

constexpr const char* fragment_source = "void main() {}\n";

}  // namespace

MeshMarks::MeshMarks()
    : program_("mesh marks", "", vertex_source, fragment_source),
      view_projection_(program_.uniform("view_projection")) {}

void MeshMarks::draw(const View& view, const DrawnSurface& surface,
                     const SurfaceBuffers& buffers) const {
  program_.use();
  set_uniform(view_projection_, view.view_projection);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_FALSE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  for (std::uint32_t mesh = 0; mesh < surface.mesh_count(); ++mesh) {
    glStencilFunc(GL_ALWAYS, of(mesh), 0xff);
    for (const TriangleRange& range : surface.triangles_of(mesh)) buffers.draw(range);
  }
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_CULL_FACE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace pneuma::render
