// Points as round discs with a dark rim.
#pragma once

#include <vector>

#include "render/frame/view.h"
#include "render/passes/instanced_quads.h"

namespace pneuma::render {

class Discs {
 public:
  Discs();
  void draw(const View& view, const std::vector<Point>& points);

 private:
  struct Instance {
    Vec3f position;
    Colour colour;
    float radius;  // pixels
  };

  InstancedQuads<Instance> quads_;
};

}  // namespace pneuma::render
