// Draws frames into images, off screen.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render/context/backend.h"
#include "render/frame/frame.h"
#include "render/image/image.h"

namespace pneuma::render {

struct RenderOptions {
  int width = 1280;       // pixels, 16..16384
  int height = 720;       // pixels, 16..16384
  int samples = 1;        // per pixel: 1, 2 or 4. With one, outlines are smoothed by themselves
  int shadow_size = 768;  // texels on a side of the shadow map, 256..8192
  std::optional<Backend> backend = std::nullopt;  // none: OSMesa where it is installed, else EGL
};

/// Owns a GL context of its own, current on the thread that made it: make, use and destroy a
/// renderer on one thread. Throws GlError (render/context/context.h) when GL cannot be had.
/// The same frame gives the same bytes, whatever was drawn before.
class Renderer {
 public:
  explicit Renderer(const RenderOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Resizes `image` to the options' size and fills it.
  void draw(const Frame& frame, Image& image);

  /// What really runs: GL version, renderer and backend, as one line.
  const std::string& description() const;

 private:
  struct Resources;
  std::unique_ptr<Resources> resources_;
};

}  // namespace pneuma::render
