// Edges of a body, drawn as bars in place of its surface.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/frame/frame.h"

namespace pneuma::app {

class EdgeBars {
 public:
  using Edges = std::vector<std::array<std::uint32_t, 2>>;

  /// `colours`: of the vertices that edges join. `radius`: of a bar, m.
  EdgeBars(Edges edges, const std::vector<render::Colour>& colours, float radius);

  /// The bars between vertices at these positions (m).
  render::Mesh mesh(const std::vector<render::Vec3f>& positions) const;

 private:
  Edges edges_;
  std::shared_ptr<const render::MeshShape> shape_;
  float radius_;
};

}  // namespace pneuma::app
