#include "render/passes/target.h"

#include <algorithm>

#include "render/context/context.h"

namespace pneuma::render {
namespace {

constexpr int band = 16;  // rows that are read at once, few enough to stay in a core's cache

void drop_alpha(const std::uint8_t* from, std::uint8_t* to, std::size_t pixels) {
  for (std::size_t i = 0; i < pixels; ++i, from += 4, to += 3) {
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
  }
}

}  // namespace

void check_framebuffer() {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw GlError(GlFailure::context_refused,
                  "GL made no framebuffer of this size; ask for a smaller picture");
  }
}

Target::Target(int width, int height)
    : width_(width), height_(height), rgba_(4 * static_cast<std::size_t>(width) * band) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindRenderbuffer(GL_RENDERBUFFER, colour_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.name());
  check_framebuffer();
}

void Target::add_depth() {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width_, height_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                            depth_.name());
  check_framebuffer();
}

void Target::begin() {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
}

void Target::read(Image& image) {
  const auto width = static_cast<std::size_t>(width_);
  image.width = width_;
  image.height = height_;
  image.pixels.resize(3 * width * static_cast<std::size_t>(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  for (int first = 0; first < height_; first += band) {
    const int rows = std::min(band, height_ - first);
    // Four bytes a pixel are copied as they stand; GL takes longer to drop the fourth than the
    // loop.
    glReadPixels(0, first, width_, rows, GL_RGBA, GL_UNSIGNED_BYTE, rgba_.data());
    // GL's rows go from bottom to top.
    for (int row = 0; row < rows; ++row) {
      const auto below = static_cast<std::size_t>(height_ - 1 - first - row);
      drop_alpha(rgba_.data() + 4 * width * static_cast<std::size_t>(row),
                 image.pixels.data() + 3 * width * below, width);
    }
  }
}

}  // namespace pneuma::render
