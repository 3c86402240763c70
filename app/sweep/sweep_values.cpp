#include "app/sweep/sweep_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sim/base/nearest.h"

namespace pneuma::app {

using scenes::Member;
using scenes::Value;

void SweepValues::refuse_unknown(const scenes::Table& table,
                                 const std::vector<std::string_view>& keys,
                                 std::string_view where) {
  for (const Member& member : table) {
    if (std::ranges::find(keys, member.key) != keys.end()) continue;
    report_.add(member.at, fmt::format("no key {} {}{}", base::in_quotes(member.key), where,
                                       base::suggestion_and_all(member.key, keys)));
  }
}

std::vector<const Value*> SweepValues::strings(const Member& member) {
  if (std::holds_alternative<std::string>(member.value.data)) return {&member.value};
  const auto* array = std::get_if<scenes::Array>(&member.value.data);
  if (array == nullptr || array->empty()) {
    report_.add(member.value.at, fmt::format("{} is {}; it takes a string, or an array of strings",
                                             member.key, scenes::describe(member.value)));
    return {};
  }
  std::vector<const Value*> found;
  for (const Value& element : *array) {
    if (std::holds_alternative<std::string>(element.data)) {
      found.push_back(&element);
    } else {
      report_.add(element.at, fmt::format("{} takes strings; this is {}", member.key,
                                          scenes::describe(element)));
    }
  }
  return found;
}

std::string SweepValues::text(const Member& member) {
  if (const auto* text = std::get_if<std::string>(&member.value.data)) return *text;
  report_.add(member.value.at, fmt::format("{} is {}; it takes a string", member.key,
                                           scenes::describe(member.value)));
  return {};
}

std::string SweepValues::word(const Member& member, const std::vector<std::string_view>& words) {
  const auto* text = std::get_if<std::string>(&member.value.data);
  if (text != nullptr && std::ranges::find(words, *text) != words.end()) return *text;
  report_.add(member.value.at, fmt::format("{} is {}; it takes one of {}", member.key,
                                           scenes::describe(member.value), fmt::join(words, ", ")));
  return {};
}

std::optional<bool> SweepValues::flag(const Member& member) {
  if (const auto* flag = std::get_if<bool>(&member.value.data)) return *flag;
  report_.add(member.value.at, fmt::format("{} is {}; it takes true or false", member.key,
                                           scenes::describe(member.value)));
  return std::nullopt;
}

std::optional<double> SweepValues::number(const Value& value, std::string_view what) {
  std::optional<double> found;
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) {
    found = static_cast<double>(*integer);
  } else if (const auto* number = std::get_if<double>(&value.data)) {
    found = *number;
  }
  if (found && std::isfinite(*found)) return found;
  report_.add(value.at,
              fmt::format("{} takes finite numbers; this is {}", what, scenes::describe(value)));
  return std::nullopt;
}

std::optional<std::int64_t> SweepValues::whole(const Member& member, double low, double high) {
  const auto* integer = std::get_if<std::int64_t>(&member.value.data);
  if (integer != nullptr && static_cast<double>(*integer) >= low &&
      static_cast<double>(*integer) <= high) {
    return *integer;
  }
  report_.add(member.value.at, fmt::format("{} is {}; it takes a whole number from {:g} to {:g}",
                                           member.key, scenes::describe(member.value), low, high));
  return std::nullopt;
}

namespace {

struct TomlText {
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(std::int64_t integer) const { return fmt::format("{}", integer); }
  std::string operator()(double number) const {
    const std::string text = fmt::format("{}", number);
    // TOML takes a number with neither for an integer.
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  std::string operator()(const std::string& text) const {
    std::string quoted = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
    return quoted + '"';
  }
  std::string operator()(scenes::Moment) const { return "a date or time"; }
  std::string operator()(const scenes::Array& array) const {
    std::string text = "[";
    for (std::size_t i = 0; i < array.size(); ++i)
      text += (i > 0 ? ", " : "") + toml_text(array[i]);
    return text + "]";
  }
  std::string operator()(const scenes::Table&) const { return "a table"; }
};

}  // namespace

std::string toml_text(const Value& value) { return std::visit(TomlText{}, value.data); }

}  // namespace pneuma::app
