#include "render/passes/layer.h"

#include <fmt/format.h>

#include "render/passes/target.h"

namespace pneuma::render {
namespace {

constexpr const char* fragment_source = R"(
#if SAMPLES > 1
uniform sampler2DMS layer;
#else
uniform sampler2D layer;
#endif
out vec4 colour;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  colour = texelFetch(layer, at, 0);
#if SAMPLES > 1
  for (int i = 1; i < SAMPLES; ++i) colour += texelFetch(layer, at, i);
  colour *= 1.0 / float(SAMPLES);
#endif
}
)";

}  // namespace

Layer::Layer(int width, int height, int samples)
    : texture_target_(samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D),
      width_(width),
      height_(height),
      average_("layer", fmt::format("#define SAMPLES {}\n", samples), fragment_source) {
  glBindTexture(texture_target_, colour_.name());
  glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
  if (samples > 1) {
    glTexImage2DMultisample(texture_target_, samples, GL_RGBA8, width, height, GL_TRUE);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
  } else {
    glTexImage2D(texture_target_, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 nullptr);
    glTexParameteri(texture_target_, GL_TEXTURE_MAX_LEVEL, 0);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture_target_, colour_.name(), 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
  check_framebuffer();
  average_.program().use();
  set_uniform(average_.program().uniform("layer"), 0);
}

void Layer::begin(const Region& region) {
  region_ = region;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  glScissor(region.x, region.y, region.width, region.height);
  clear();
  glEnable(GL_SCISSOR_TEST);
}

void Layer::end() { glDisable(GL_SCISSOR_TEST); }

void Layer::clear() const {
  // llvmpipe clears all of a framebuffer as memory, but a part of it as if it were drawn, which
  // takes three times as long a pixel.
  const bool part = 3 * region_.width * region_.height < width_ * height_;
  if (part) glEnable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Layer::compose() {
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_DEPTH_TEST);
  average_.program().use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(texture_target_, colour_.name());
  glBindSampler(0, 0);
  glEnable(GL_SCISSOR_TEST);
  glScissor(region_.x, region_.y, region_.width, region_.height);
  average_.draw();
  glDisable(GL_SCISSOR_TEST);
}

void blend_over_layer() {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

}  // namespace pneuma::render
