// Caption, labels, scale bar and legend: light letters on dark, translucent panels, readable on any
// ground.
#pragma once

#include <string>

#include "render/frame/view.h"
#include "render/passes/flat_drawing.h"

namespace pneuma::render {

/// A length of 1, 2 or 5 times a power of ten: the longest that is not above `length`, which is
/// positive.
float round_length(float length);

class Lettering {
 public:
  /// The caption in the lower left corner, growing upwards with the number of lines; the scale bar
  /// in the lower right one; the legend at the right side; labels over their points, within the
  /// picture. Letters that do not fit into a line go on in the next.
  void draw(const View& view, const Frame& frame);

 private:
  /// A text on a panel, whose upper left corner is at (x, y).
  void panel(const TextLayout& layout, float x, float y);
  TextLayout laid_out(const std::string& text, float most_width) const;
  /// Returns the left side of what is drawn.
  float draw_scale_bar(const View& view);
  void draw_caption(const View& view, const std::string& text, float right);
  void draw_labels(const View& view, const std::vector<Label>& labels);
  void draw_legend(const View& view, const Legend& legend);

  FlatDrawing drawing_;
  float em_ = 0.0f;       // pixels
  float padding_ = 0.0f;  // pixels between a panel's side and its letters
  float margin_ = 0.0f;   // pixels between the picture's side and a panel
};

}  // namespace pneuma::render
