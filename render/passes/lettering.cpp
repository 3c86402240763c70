#include "render/passes/lettering.h"

#include <algorithm>
#include <cmath>

// Written without care for warnings; it is used as it is.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec2 position;  // pixels from the upper left corner
layout(location = 1) in vec4 ink;
uniform vec2 picture_size;
flat out vec4 shade;

void main() {
  shade = ink;
  vec2 clip = position / picture_size * 2.0 - 1.0;
  gl_Position = vec4(clip.x, -clip.y, 0.0, 1.0);
}
)";

constexpr const char* fragment_source = R"(
flat in vec4 shade;
out vec4 colour;
void main() { colour = shade; }
)";

using Ink = Eigen::Vector4f;  // sRGB and opacity
const Ink letter_ink = {0.97f, 0.97f, 0.96f, 1.0f};
const Ink panel_ink = {0.10f, 0.12f, 0.15f, 0.68f};

/// As stb_easy_font writes them.
struct FontVertex {
  float x;
  float y;
  float z;
  unsigned char colour[4];
};

struct Vertex {
  Eigen::Vector2f position;
  Ink ink;
};

std::string printable(std::string text) {
  for (char& c : text) {
    if (c != '\n' && (c < ' ' || c > '~')) c = '?';
  }
  return text;
}

float width_of(std::string line) { return static_cast<float>(stb_easy_font_width(line.data())); }

/// How many characters of `line` fit: up to the last space where there is one, else as many as go,
/// at least one.
std::size_t fitting(const std::string& line, float width) {
  std::size_t count = line.size();
  while (count > 1 && width_of(line.substr(0, count)) > width) --count;
  if (count == line.size()) return count;
  const std::size_t space = line.rfind(' ', count);
  return space == line.npos || space == 0 ? count : space;
}

/// The text with a new line wherever one would be wider than `width`, in the font's units.
std::string wrapped(const std::string& text, float width) {
  std::string result;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    do {
      const std::size_t count = fitting(line, width);
      if (!result.empty()) result += '\n';
      result += line.substr(0, count);
      line.erase(0, std::max(count, std::min(line.find_first_not_of(' ', count), line.size())));
    } while (!line.empty());
    begin = end + 1;
  }
  return result;
}

/// Rectangles of four corners each: upper left, upper right, lower right, lower left.
std::vector<FontVertex> font_rectangles(std::string& text) {
  constexpr std::size_t bytes_per_character = 30 * 4 * sizeof(FontVertex);  // none has more strokes
  std::vector<FontVertex> corners(text.size() * bytes_per_character / sizeof(FontVertex));
  const int count = stb_easy_font_print(0.0f, 0.0f, text.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(FontVertex)));
  corners.resize(4 * static_cast<std::size_t>(count));
  return corners;
}

void add_rectangle(std::vector<Vertex>& vertices, const Eigen::Vector2f& min,
                   const Eigen::Vector2f& max, const Ink& ink) {
  const Eigen::Vector2f upper_right = {max.x(), min.y()};
  const Eigen::Vector2f lower_left = {min.x(), max.y()};
  for (const Eigen::Vector2f& corner : {min, upper_right, max, min, max, lower_left}) {
    vertices.push_back({corner, ink});
  }
}

}  // namespace

Lettering::Lettering()
    : program_("caption", "", vertex_source, fragment_source),
      picture_size_(program_.uniform("picture_size")) {
  glBindVertexArray(vao_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  set_attribute(0, 2, sizeof(Vertex), offsetof(Vertex, position));
  set_attribute(1, 4, sizeof(Vertex), offsetof(Vertex, ink));
}

void Lettering::draw(const View& view, const std::string& caption) {
  // Whole pixels for each of the font's, so that every stroke is equally wide.
  const float scale = std::max(1.0f, std::round(view.pixel_scale * 1.5f));
  const float margin = 5.0f * scale;
  const float padding = 4.0f * scale;
  const float room = static_cast<float>(view.width) - 2.0f * (margin + padding);
  std::string text = caption.empty() ? "" : wrapped(printable(caption), room / scale);
  const std::vector<FontVertex> corners = font_rectangles(text);
  if (corners.empty()) return;
  const Eigen::Vector2f text_size =
      scale * Eigen::Vector2f(static_cast<float>(stb_easy_font_width(text.data())),
                              static_cast<float>(stb_easy_font_height(text.data())));
  const Eigen::Vector2f origin = {
      margin + padding, static_cast<float>(view.height) - margin - padding - text_size.y()};

  std::vector<Vertex> vertices;
  const Eigen::Vector2f border = Eigen::Vector2f::Constant(padding);
  add_rectangle(vertices, origin - border, origin + text_size + border, panel_ink);
  for (std::size_t i = 0; i < corners.size(); i += 4) {
    add_rectangle(vertices, origin + scale * Eigen::Vector2f(corners[i].x, corners[i].y),
                  origin + scale * Eigen::Vector2f(corners[i + 2].x, corners[i + 2].y), letter_ink);
  }

  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDisable(GL_DEPTH_TEST);
  program_.use();
  set_uniform(picture_size_,
              Eigen::Vector2f(static_cast<float>(view.width), static_cast<float>(view.height)));
  glBindVertexArray(vao_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
               vertices.data(), GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
}

}  // namespace pneuma::render
