// How exact a run is to be, in the words of --accuracy.
#pragma once

#include <array>
#include <string_view>

namespace pneuma::app {

/// The error is that of `pneuma study error`: root mean square distance of the vertices from where
/// they should be, over the rest radius, in the first second or so of a motion. Later a motion with
/// contacts cannot be followed by any method.
enum class Accuracy {
  picture,     // 5e-2, a few pixels of a body that fills half a picture
  hundredth,   // 1e-2
  thousandth,  // 1e-3
};

inline constexpr std::array<std::string_view, 3> accuracy_names = {"picture", "1e-2", "1e-3"};

inline std::string_view to_string(Accuracy accuracy) {
  return accuracy_names[static_cast<std::size_t>(accuracy)];
}

/// The error that it lets pass.
inline constexpr double max_error(Accuracy accuracy) {
  constexpr std::array errors = {5e-2, 1e-2, 1e-3};
  return errors[static_cast<std::size_t>(accuracy)];
}

}  // namespace pneuma::app
