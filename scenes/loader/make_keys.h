// What the tables of keys are written with: ranges, words, and marks on keys.
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/loader/keys.h"

namespace pneuma::scenes {

// Positions and lengths end here: beyond, the pictures' single precision resolves no better than
// 6 cm.
inline constexpr double farthest = 1e6;

inline constexpr double longest_duration = 1e6;  // s, of a run

// m^2, of an opening through which gas flows.
inline constexpr double max_hole = 1e3;

inline Range any() { return {}; }
inline Range at_least(double low) { return {.low = low}; }
inline Range above(double low) { return {.low = low, .low_open = true}; }
inline Range between(double low, double high) { return {.low = low, .high = high}; }
inline Range above_to(double low, double high) {
  return {.low = low, .high = high, .low_open = true};
}
inline Range from_below(double low, double high) {
  return {.low = low, .high = high, .high_open = true};
}
inline Range one_of(std::vector<int> values) { return {.only = std::move(values)}; }
inline Range length() { return above_to(0, farthest); }
inline Range place() { return between(-farthest, farthest); }

template <class Enum>
using Named = std::pair<Enum, std::string_view>;

/// `names` must outlive the word.
template <class Enum, std::size_t Count>
Word word(Enum& member, const std::array<Named<Enum>, Count>& names) {
  Word result;
  result.member = &member;
  for (const auto& [value, name] : names) result.words.push_back(name);
  result.get = [&member, &names] {
    std::size_t i = 0;
    while (i + 1 < Count && names[i].first != member) ++i;
    return i;
  };
  result.set = [&member, &names](std::size_t i) { member = names[i].first; };
  return result;
}

/// The structs for which a key is meant, and whether the one at hand is such.
struct Applicability {
  std::string_view only_for;
  bool applies;
  bool by_shape = false;             // whether the body's shape decides
  const void* decided_by = nullptr;  // Key::decided_by
  std::string_view made_one_by = {};
  std::vector<const void*> rivals = {};  // Key::rivals
};

/// Marks a key as one for such structs only.
inline Key only(const Applicability& applicability, Key key) {
  key.only_for = applicability.only_for;
  key.made_one_by = applicability.made_one_by;
  key.applies = applicability.applies;
  key.of_shape = applicability.by_shape;
  key.decided_by = applicability.decided_by;
  key.rivals = applicability.rivals;
  return key;
}

inline Key of_shape(Key key) {
  key.of_shape = true;
  return key;
}

inline Key of_method(Key key) {
  key.of_method = true;
  return key;
}

inline Key selector(Key key) {
  key.selects = true;
  return key;
}

inline Key or_number(Key key) {
  key.or_number = true;
  return key;
}

}  // namespace pneuma::scenes
