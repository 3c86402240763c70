#include "render/passes/scenery.h"

#include "render/passes/target.h"

namespace pneuma::render {

Scenery::Scenery(int width, int height) : width_(width), height_(height) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindRenderbuffer(GL_RENDERBUFFER, colour_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.name());
  check_framebuffer();
}

void Scenery::draw(const View& view, const std::optional<Ground>& ground,
                   GroundPlane& ground_plane) {
  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  const Key key = {view.view_projection, view.eye, view.target, ground_radius(view),
                   ground ? std::optional(ground->grid_spacing) : std::nullopt};
  if (drawn_ != key) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    background_.draw(view);
    if (ground) ground_plane.draw(view, *ground);
    drawn_ = key;
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(target));
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(target));
}

}  // namespace pneuma::render
