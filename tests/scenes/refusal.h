// Scenes of one body, and what the loader says of those that it refuses.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "scenes/loader/load_scene.h"

namespace pneuma::scenes {

/// A scene of one soft body with these keys.
inline Scene load_body(const std::string& keys, const std::vector<std::string>& overrides = {}) {
  return parse_scene("[[body]]\n" + keys, "x.toml", overrides);
}

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

inline std::string refusal_of_body(const std::string& keys,
                                   const std::vector<std::string>& overrides = {}) {
  return refusal("[[body]]\n" + keys, overrides);
}

inline void expect_in(const std::string& text, std::initializer_list<const char*> parts) {
  EXPECT_NE(text, "");
  for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
}

}  // namespace pneuma::scenes
