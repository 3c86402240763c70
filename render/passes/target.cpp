#include "render/passes/target.h"

#include "render/context/context.h"

namespace pneuma::render {

void check_framebuffer() {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw GlError(GlFailure::context_refused,
                  "GL made no framebuffer of this size; ask for a smaller picture");
  }
}

Target::Target(int width, int height)
    : width_(width),
      height_(height),
      rgba_(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindRenderbuffer(GL_RENDERBUFFER, colour_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.name());
  check_framebuffer();
}

void Target::add_depth() {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width_, height_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
  check_framebuffer();
}

void Target::begin() {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
}

void Target::read(Image& image) {
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  // Four bytes a pixel are copied as they stand; GL takes longer to drop the fourth than the loop.
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba_.data());
  image.width = width_;
  image.height = height_;
  image.pixels.resize(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  // GL's rows go from bottom to top.
  std::uint8_t* to = image.pixels.data();
  for (int row = height_ - 1; row >= 0; --row) {
    const std::uint8_t* from =
        rgba_.data() + 4 * static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
    for (int x = 0; x < width_; ++x, from += 4, to += 3) {
      to[0] = from[0];
      to[1] = from[1];
      to[2] = from[2];
    }
  }
}

}  // namespace pneuma::render
