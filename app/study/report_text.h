// How the studies' reports are laid out for people.
#pragma once

#include <string>
#include <vector>

namespace pneuma::app {

/// A label and a paragraph beside it, wrapped to the width of the tables.
std::string labelled(const std::string& label, const std::string& text);

/// "- text", wrapped likewise.
std::string list_item(const std::string& text);

/// "Warning: text." for each, wrapped likewise.
std::string warnings_text(const std::vector<std::string>& warnings);

/// A power of ten, as "1e-2".
std::string power_of_ten(double value);

}  // namespace pneuma::app
