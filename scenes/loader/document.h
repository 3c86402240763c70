// A TOML document as a plain tree in which every key and value knows where it was written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenes/loader/report.h"

namespace pneuma::scenes {

struct Member;
struct Value;

/// TOML's dates and times: no key of a scene takes one.
struct Moment {};

using Array = std::vector<Value>;
using Table = std::vector<Member>;  // in the order of the file

struct Value {
  Origin at;
  std::variant<bool, std::int64_t, double, std::string, Moment, Array, Table> data;
};

struct Member {
  std::string key;
  Origin at;  // of the key
  Value value;
  bool where_it_applies = false;  // from an override of every body to which the key applies
};

Member* find(Table& table, std::string_view key);
const Member* find(const Table& table, std::string_view key);

/// Written under a header of its own, [NAME] or [[NAME]], or as such.
bool holds_tables(const Value& value);

/// For messages: `string "x"`, `integer 5`, `an array of 3`.
std::string describe(const Value& value);

/// Parses a document. `override_index` marks the text of an override, -1 the file.
/// Throws SyntaxError.
Table parse_document(std::string_view text, int override_index);

}  // namespace pneuma::scenes
