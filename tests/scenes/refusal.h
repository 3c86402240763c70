// What the loader says of a scene that it refuses.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "scenes/loader/load_scene.h"

namespace pneuma::scenes {

/// Empty if it takes the text of `x.toml` with these overrides.
inline std::string refusal(const std::string& text,
                           const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "x.toml", overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

inline void expect_in(const std::string& text, std::initializer_list<const char*> parts) {
  EXPECT_NE(text, "");
  for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
}

}  // namespace pneuma::scenes
