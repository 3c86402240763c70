// One [[parameter]] of a sweep file.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "app/sweep/sweep.h"
#include "app/sweep/sweep_values.h"

namespace pneuma::app {

/// Reports what is wrong with it; none after an error. `at`: where the table begins.
std::optional<Parameter> read_parameter(const scenes::Table& table, const scenes::Origin& at,
                                        SweepValues& values);

/// A key of sweep files with its meaning.
struct SweepKey {
  std::string_view name;
  std::string_view example;
  std::string_view meaning;
};

/// The names of the keys at the top.
std::vector<std::string_view> sweep_keys();

}  // namespace pneuma::app
