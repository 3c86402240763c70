// Rectangles and letters over the picture, in pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "render/frame/view.h"
#include "render/passes/gl_objects.h"
#include "render/passes/program.h"
#include "render/text/layout.h"

namespace pneuma::render {

using Ink = Eigen::Vector4f;  // sRGB and opacity

/// Collects what is to be drawn, then draws it in one go. Coordinates are pixels from the picture's
/// upper left corner.
class FlatDrawing {
 public:
  FlatDrawing();

  void begin();
  void rectangle(const Eigen::Vector2f& min, const Eigen::Vector2f& max, const Ink& ink);
  /// `x` and `y`: the upper left corner of the layout.
  void text(const TextLayout& layout, int x, int y, const Ink& ink);
  void draw(const View& view);

  const Font& font() const { return font_; }

 private:
  struct Vertex {
    Eigen::Vector2f position;
    Ink ink;
    Eigen::Vector2f texel;  // of the letters; negative: none, all is covered
  };

  void quad(const Eigen::Vector2f& min, const Eigen::Vector2f& max, const Ink& ink,
            const Eigen::Vector2f& texel);
  void upload_letters();

  Font font_;
  std::vector<Vertex> vertex_list_;
  std::vector<TextCoverage> texts_;  // one below the other in the texture
  int texts_height_ = 0;
  std::vector<std::uint8_t> texels_;
  Vao vao_;
  Buffer vertices_;
  Texture letters_;
  Program program_;
  GLint picture_size_;
};

}  // namespace pneuma::render
