// The light and the colours that all passes share, as GLSL.
//
// Light is computed in linear colours; the framebuffer holds sRGB, which shaders convert to.
// Leaving that to GL_FRAMEBUFFER_SRGB costs a third more on llvmpipe, which then converts each
// sample at each write.
#pragma once

#include <array>
#include <string>

namespace pneuma::render {

/// Linear: what arrives from the light, from above and from below.
inline constexpr std::array<float, 3> sun = {0.80f, 0.775f, 0.73f};
inline constexpr std::array<float, 3> sky = {0.34f, 0.37f, 0.42f};
inline constexpr std::array<float, 3> bounce = {0.16f, 0.15f, 0.14f};

/// `sun`, `sky`, `bounce` as above;
/// `to_srgb(linear)`;
/// `backdrop(height)`: the background at a height in the picture, 0 at its foot and 1 at its top,
/// in sRGB.
std::string look_source();

}  // namespace pneuma::render
