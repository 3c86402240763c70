// "Did you mean ...?"
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pneuma::base {

/// How many letters must be inserted, deleted, replaced or swapped with their neighbour to turn one
/// name into the other (optimal string alignment distance). Upper and lower case count as equal.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `name`, the first of several; none when the nearest is further than a
/// slip of the pen: about one letter in three.
std::optional<std::string_view> nearest(std::string_view name,
                                        const std::vector<std::string_view>& candidates);

/// "; did you mean 'radius'?", or nothing.
std::string suggestion(std::string_view name, const std::vector<std::string_view>& candidates);

/// The same with all that is allowed: "; did you mean 'radius'? allowed: name, radius".
std::string suggestion_and_all(std::string_view name,
                               const std::vector<std::string_view>& candidates);

/// Bytes of the letter that the text begins with, in UTF-8. 0 where a terminal would not show a
/// letter: a control character, a mark that hides or turns what follows it, or no UTF-8.
std::size_t letter_size(std::string_view text);

/// `text` fit for a terminal: bytes that are of no letter are escaped.
std::string printable(std::string_view text);

/// The same in single quotes, long text cut.
std::string in_quotes(std::string_view text);

}  // namespace pneuma::base
