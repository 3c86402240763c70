#include "scenes/loader/other_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace pneuma::scenes {
namespace {

constexpr std::string_view inverse_step = "the inverse of the time step";
constexpr std::array names_elsewhere = {
    OtherName{"fps", "picture.frames_per_second", ""},
    OtherName{"frame_rate", "picture.frames_per_second", ""},
    OtherName{"framerate", "picture.frames_per_second", ""},
    OtherName{"dt", "simulation.steps_per_second", inverse_step},
    OtherName{"timestep", "simulation.steps_per_second", inverse_step},
    OtherName{"time_step", "simulation.steps_per_second", inverse_step},
    OtherName{"fov", "camera.field_of_view", "vertical, in degrees"},
    OtherName{"look_at", "camera.target", ""},
    OtherName{"lookat", "camera.target", ""},
    OtherName{"gas", "body.n", "the amount of gas in mol"},
    OtherName{"drag", "body.rho_g", "a fraction per 1/60 s"},
    OtherName{"color", "body.colours", "an array of strings"},
    OtherName{"colour", "body.colours", "an array of strings"},
};

}  // namespace

std::span<const OtherName> other_names() { return names_elsewhere; }

std::string meant_key(std::string_view name) {
  const auto found = std::ranges::find(names_elsewhere, name, &OtherName::name);
  if (found == names_elsewhere.end()) return {};
  if (found->remark.empty()) return fmt::format("; write {}", found->key);
  return fmt::format("; write {} ({})", found->key, found->remark);
}

}  // namespace pneuma::scenes
