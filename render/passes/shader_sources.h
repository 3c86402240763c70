// The passes' shaders as text, for a renderer elsewhere that is to draw the same: GLSL without a
// version line, in the part of the language that OpenGL 3.3 and WebGL 2 share, once `noperspective`
// is defined away.
#pragma once

namespace pneuma::render {

struct ShaderSources {
  const char* vertex;
  const char* fragment;
};

/// Each needs the text of look_source() before its fragment shader.
ShaderSources
surface_shaders();  // variants by SMOOTH, NEAR_BOXES, SHADOWED and, of light only, OUTLINE
ShaderSources ground_shaders();  // also needs nearness_source()

/// Goes before the fragment shader of surfaces with SMOOTH, NEAR_BOXES and OUTLINE.
const char* outline_vertex_source();

/// The ground's shadow from a picture of it; needs nearness_source().
ShaderSources ground_shadow_shaders();

/// `nearness(from_centre)`: how strongly the ground is seen.
const char* nearness_source();

ShaderSources disc_shaders();
ShaderSources line_shaders();

}  // namespace pneuma::render
