#include "render/passes/full_screen.h"

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
)";

}  // namespace

FullScreen::FullScreen(std::string_view name, std::string_view preamble,
                       std::string_view fragment_source)
    : program_(name, preamble, vertex_source, fragment_source) {}

void FullScreen::draw() const {
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace pneuma::render
