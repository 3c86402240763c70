// The light and the colours that all passes share, as GLSL.
//
// Light is computed in linear colours; the framebuffer holds sRGB, which shaders convert to.
// Leaving that to GL_FRAMEBUFFER_SRGB costs a third more on llvmpipe, which then converts each
// sample at each write.
#pragma once

#include <string>

namespace pneuma::render {

/// `sun`, `floor_light` and `sky_light(z)`: the environment's radiances;
/// `sky_irradiance(z)`: over pi, on a surface whose normal has that z component;
/// `fresnel(cosine, roughness)`, `entering` and `highlight(nl, nv, nh, vh, roughness)`: what a
/// surface of plastic or rubber reflects; what is not reflected lights its colour; `shown(linear)`:
/// the tone curve, then sRGB; `backdrop(height)`: the background at a height in the picture, 0 at
/// its foot and 1 at its top, in sRGB.
std::string look_source();

}  // namespace pneuma::render
