#include "render/passes/layer.h"

#include <fmt/format.h>

#include "render/passes/full_screen.h"

namespace pneuma::render {
namespace {

constexpr const char* fragment_source = R"(
uniform sampler2DMS layer;
out vec4 colour;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  colour = vec4(0.0);
  for (int i = 0; i < SAMPLES; ++i) colour += texelFetch(layer, at, i);
  colour *= 1.0 / float(SAMPLES);
}
)";

}  // namespace

struct Layer::Samples {
  Samples(int width, int height, int samples);

  /// Averages them and puts them over what the framebuffer bound by now holds.
  void compose() const;

  Texture colour;
  Renderbuffer depth;
  Framebuffer framebuffer;
  FullScreen average;
};

Layer::Samples::Samples(int width, int height, int samples)
    : average("layer", fmt::format("#define SAMPLES {}\n", samples), fragment_source) {
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, colour.name());
  glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, GL_RGBA8, width, height, GL_TRUE);
  glBindRenderbuffer(GL_RENDERBUFFER, depth.name());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH24_STENCIL8, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE,
                         colour.name(), 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                            depth.name());
  check_framebuffer();
  average.program().use();
  set_uniform(average.program().uniform("layer"), 0);
}

void Layer::Samples::compose() const {
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_DEPTH_TEST);
  average.program().use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, colour.name());
  glBindSampler(0, 0);
  average.draw();
}

Layer::Layer(Target& target, int samples) : target_(target) {
  if (samples > 1) {
    samples_ = std::make_unique<Samples>(target.width(), target.height(), samples);
  } else {
    target.add_depth();
  }
}

Layer::~Layer() = default;

void Layer::begin(const Frame& frame, const View& view, std::span<const SurfaceVertex> surface) {
  glDepthMask(GL_TRUE);
  if (!samples_) return glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  const Region region = region_of_bodies(frame, view, surface);
  glBindFramebuffer(GL_FRAMEBUFFER, samples_->framebuffer.name());
  glScissor(region.x, region.y, region.width, region.height);
  // llvmpipe clears all of a framebuffer as memory, but a part of it as if it were drawn, which
  // takes three times as long a pixel.
  const bool part = 3 * region.width * region.height < target_.width() * target_.height();
  if (part) glEnable(GL_SCISSOR_TEST);
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_SCISSOR_TEST);
}

void Layer::end() {
  if (!samples_) return;
  target_.begin();
  samples_->compose();
  glDisable(GL_SCISSOR_TEST);
}

void blend_over_layer() {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

}  // namespace pneuma::render
