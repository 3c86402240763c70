// Looks at all of a JSON document.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace pneuma {

/// JSON has no way to write a number that is not finite: it would have become null. So every null
/// has to be among those that are meant.
inline void expect_nulls_only_at(const nlohmann::json& document,
                                 const std::vector<std::string>& expected) {
  const nlohmann::json flat = document.flatten();
  for (const auto& [path, value] : flat.items()) {
    if (value.is_number()) {
      EXPECT_TRUE(std::isfinite(value.get<double>())) << path;
    }
    if (!value.is_null()) continue;
    bool meant = false;
    for (const std::string& ending : expected) meant |= path.ends_with(ending);
    EXPECT_TRUE(meant) << path << " is null";
  }
}

}  // namespace pneuma
