#include "render/passes/flat_drawing.h"

#include <algorithm>

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec2 position;  // pixels from the upper left corner
layout(location = 1) in vec4 ink;
layout(location = 2) in vec2 texel;
uniform vec2 picture_size;
flat out vec4 shade;
noperspective out vec2 at;

void main() {
  shade = ink;
  at = texel;
  vec2 clip = position / picture_size * 2.0 - 1.0;
  gl_Position = vec4(clip.x, -clip.y, 0.0, 1.0);
}
)";

constexpr const char* fragment_source = R"(
flat in vec4 shade;
noperspective in vec2 at;
uniform sampler2D letters;
out vec4 colour;

void main() {
  float covered = at.x < 0.0 ? 1.0 : texelFetch(letters, ivec2(at), 0).r;
  colour = vec4(shade.rgb, shade.a * covered);
}
)";

const Eigen::Vector2f no_texel = {-1e6f, -1e6f};

}  // namespace

FlatDrawing::FlatDrawing()
    : program_("caption", "", vertex_source, fragment_source),
      picture_size_(program_.uniform("picture_size")) {
  program_.use();
  set_uniform(program_.uniform("letters"), 0);
  glBindVertexArray(vao_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  set_attribute(0, 2, sizeof(Vertex), offsetof(Vertex, position));
  set_attribute(1, 4, sizeof(Vertex), offsetof(Vertex, ink));
  set_attribute(2, 2, sizeof(Vertex), offsetof(Vertex, texel));
}

void FlatDrawing::begin() {
  vertex_list_.clear();
  texts_.clear();
  texts_height_ = 0;
}

void FlatDrawing::quad(const Eigen::Vector2f& min, const Eigen::Vector2f& max, const Ink& ink,
                       const Eigen::Vector2f& texel) {
  const Eigen::Vector2f size = max - min;
  for (const int corner : {0, 1, 3, 0, 3, 2}) {
    const Eigen::Vector2f step = {corner % 2 == 0 ? 0.0f : size.x(), corner < 2 ? 0.0f : size.y()};
    vertex_list_.push_back({min + step, ink, texel + step});
  }
}

void FlatDrawing::rectangle(const Eigen::Vector2f& min, const Eigen::Vector2f& max,
                            const Ink& ink) {
  quad(min, max, ink, no_texel);
}

void FlatDrawing::text(const TextLayout& layout, int x, int y, const Ink& ink) {
  texts_.push_back(cover(font_, layout));
  const TextCoverage& covered = texts_.back();
  const Eigen::Vector2f min = {static_cast<float>(x - 1), static_cast<float>(y - 1)};
  const Eigen::Vector2f size = {static_cast<float>(covered.width),
                                static_cast<float>(covered.height)};
  quad(min, min + size, ink, {0.0f, static_cast<float>(texts_height_)});
  texts_height_ += covered.height;
}

void FlatDrawing::upload_letters() {
  int width = 1;
  for (const TextCoverage& text : texts_) width = std::max(width, text.width);
  texels_.clear();
  for (const TextCoverage& text : texts_) {
    for (int row = 0; row < text.height; ++row) {
      const auto from = text.values.begin() + std::ptrdiff_t{row} * text.width;
      texels_.insert(texels_.end(), from, from + text.width);
      texels_.resize(texels_.size() + static_cast<std::size_t>(width - text.width));
    }
  }
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, letters_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, texts_height_, 0, GL_RED, GL_UNSIGNED_BYTE,
               texels_.data());
  // Without it a texture of one level is not complete.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void FlatDrawing::draw(const View& view) {
  if (vertex_list_.empty()) return;
  if (!texts_.empty()) upload_letters();
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_DEPTH_TEST);
  program_.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, letters_.name());
  set_uniform(picture_size_,
              Eigen::Vector2f(static_cast<float>(view.width), static_cast<float>(view.height)));
  glBindVertexArray(vao_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertex_list_.size() * sizeof(Vertex)),
               vertex_list_.data(), GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertex_list_.size()));
}

}  // namespace pneuma::render
