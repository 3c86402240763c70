// "PATH=VALUE" into a document.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/loader/document.h"

namespace pneuma::scenes {

/// Puts the overrides' values into the document, in their order. A path that leads nowhere is
/// reported here; an unknown key or a bad value is left for the reader to find.
void apply_overrides(std::span<const std::string> overrides, Table& document, Report& report);

/// Whether one of them sets this very path.
bool is_overridden(std::span<const std::string> overrides, std::string_view path);

/// The number that the last override of this very path sets; none when there is none, or it is not
/// a number.
std::optional<double> number_override(std::span<const std::string> overrides,
                                      std::string_view path);

}  // namespace pneuma::scenes
