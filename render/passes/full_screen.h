// A program that draws one triangle over everything: a fragment for each pixel.
#pragma once

#include <string_view>

#include "render/passes/gl_objects.h"
#include "render/passes/program.h"

namespace pneuma::render {

class FullScreen {
 public:
  FullScreen(std::string_view name, std::string_view preamble, std::string_view fragment_source);

  const Program& program() const { return program_; }

  /// With the program in use.
  void draw() const;

 private:
  Vao no_attributes_;
  Program program_;
};

}  // namespace pneuma::render
