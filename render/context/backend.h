// Which library makes the OpenGL contexts.
#pragma once

#include <array>
#include <string_view>

namespace pneuma::render {

enum class Backend {
  osmesa,  // libOSMesa: the CPU draws
  egl,     // libEGL without a surface, on Mesa's software device: the same code draws
};

inline constexpr std::array<std::string_view, 2> backend_names = {"osmesa", "egl"};
std::string_view to_string(Backend backend);

}  // namespace pneuma::render
