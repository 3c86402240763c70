// Checks a scene's text before toml++ 3.3 reads it, which runs into undefined behaviour on some
// texts that are no TOML, and on some that are.
#pragma once

#include <string>
#include <string_view>

#include "scenes/loader/report.h"

namespace pneuma::scenes {

/// The text, fit for toml++: without a byte order mark, and with question marks for all that is
/// beyond ASCII in comments. Throws SyntaxError at the first of these, which no scene needs:
/// - Several bytes 0, which say that the file is no text of single bytes.
/// - Bytes beyond ASCII outside of comments, on which toml++ can fail wherever it looks for blanks
///   (https://github.com/marzer/tomlplusplus/issues/190 and 295).
/// - A table's header that starts with anything but a name, such as `[&`
///   (https://github.com/marzer/tomlplusplus/issues/294).
/// - More than a hundred dots in the keys of one line. toml++ limits how deep values nest, but not
///   how deep dotted keys do: a line of 100,000 `a.` makes as many nested tables, whose destructors
///   exhaust the stack.
/// - Strings of several lines, which no key takes, and control characters, which TOML forbids:
///   without them, every line can be looked at by itself.
std::string guarded(std::string_view text, int override_index);

}  // namespace pneuma::scenes
