// What strings of a scene file may hold. Each check gives the reason for a refusal, or nothing.
#pragma once

#include <string>
#include <string_view>

namespace pneuma::scenes {

/// One line that fits a list and a caption: at most 200 characters of printable ASCII.
std::string check_line(std::string_view text);

/// A file's path: one line, longer than others.
std::string check_file(std::string_view text);

/// A body's name: a letter, then letters, digits, `_` and `-`; at most 64. Not a table's name,
/// because overrides address both in the same way.
std::string check_body_name(std::string_view text);

/// "#rrggbb".
std::string check_colour(std::string_view text);

/// Of what was meant as a number and is none in TOML, such as "10 s" or ".5": "; write 0.5". Empty
/// for anything else.
std::string number_hint(std::string_view text);

}  // namespace pneuma::scenes
