#include "render/passes/background.h"

#include <string>

#include "render/passes/look.h"

namespace pneuma::render {
namespace {

constexpr const char* fragment_source = R"(
uniform float picture_height;
out vec4 colour;
void main() { colour = vec4(backdrop(gl_FragCoord.y / picture_height), 1.0); }
)";

}  // namespace

Background::Background()
    : gradient_("background", "", look_source() + fragment_source),
      picture_height_(gradient_.program().uniform("picture_height")) {}

void Background::draw(const View& view) {
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  gradient_.program().use();
  set_uniform(picture_height_, static_cast<float>(view.height));
  gradient_.draw();
}

}  // namespace pneuma::render
