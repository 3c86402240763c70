#include "render/passes/background.h"

#include <string>

#include "render/passes/look.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;  // one triangle over everything
  gl_Position = vec4(corner * 2.0 - 1.0, 1.0, 1.0);
}
)";

constexpr const char* fragment_source = R"(
uniform float picture_height;
out vec4 colour;
void main() { colour = vec4(backdrop(gl_FragCoord.y / picture_height), 1.0); }
)";

}  // namespace

Background::Background()
    : program_("background", "", vertex_source, look_source() + fragment_source),
      picture_height_(program_.uniform("picture_height")) {}

void Background::draw(const View& view) {
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  program_.use();
  set_uniform(picture_height_, static_cast<float>(view.height));
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace pneuma::render
