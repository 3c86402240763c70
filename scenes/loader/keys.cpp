#include "scenes/loader/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace pneuma::scenes {
namespace {

/// The shortest digits that read back to the same number. TOML integers are numbers to the loader,
/// but they have no negative zero.
std::string number_text(double value) {
  return value == 0.0 && std::signbit(value) ? "-0.0" : fmt::format("{}", value);
}

std::string string_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (byte < 0x20 || byte == 0x7f)
      result += fmt::format("\\u{:04X}", byte);
    else
      result += c;
  }
  return result + '"';
}

std::string vector_text(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", number_text(v.x()), number_text(v.y()), number_text(v.z()));
}

template <class Row>
std::string rows_text(const std::vector<Row>& rows) {
  std::vector<std::string> texts;
  for (const Row& row : rows) {
    std::vector<std::string> numbers;
    std::ranges::transform(row, std::back_inserter(numbers), number_text);
    texts.push_back(fmt::format("[{}]", fmt::join(numbers, ", ")));
  }
  return rows.empty() ? std::string() : fmt::format("[{}]", fmt::join(texts, ", "));
}

struct ValueText {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(const double* value) const { return number_text(*value); }
  std::string operator()(const int* value) const { return fmt::format("{}", *value); }
  std::string operator()(const std::uint64_t* value) const { return fmt::format("{}", *value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const { return string_text(*value); }
  std::string operator()(const Vec3* value) const { return vector_text(*value); }
  std::string operator()(const std::optional<int>* value) const {
    return *value ? fmt::format("{}", **value) : std::string();
  }
  std::string operator()(const std::optional<double>* value) const {
    return *value ? number_text(**value) : std::string();
  }
  std::string operator()(const std::optional<Vec3>* value) const {
    return *value ? vector_text(**value) : std::string();
  }
  std::string operator()(const std::array<int, 3>* value) const {
    return fmt::format("[{}]", fmt::join(*value, ", "));
  }
  std::string operator()(const std::vector<std::string>* value) const {
    std::vector<std::string> texts;
    std::transform(value->begin(), value->end(), std::back_inserter(texts), string_text);
    return fmt::format("[{}]", fmt::join(texts, ", "));
  }
  std::string operator()(const std::vector<sim::KeyFrame>* value) const {
    return rows_text(*value);
  }
  std::string operator()(const std::vector<Region>* value) const { return rows_text(*value); }
  std::string operator()(const std::vector<TimedValue>* value) const { return rows_text(*value); }
  std::string operator()(const std::vector<CameraKey>* value) const { return rows_text(*value); }
  std::string operator()(const std::optional<sim::ContactMaterial>* value) const {
    return value->has_value() ? "true" : "false";
  }
  std::string operator()(const Word& word) const { return string_text(word.words[word.get()]); }
};

struct TypeText {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(const double*) const { return "number"; }
  std::string operator()(const int*) const { return "whole number"; }
  std::string operator()(const std::uint64_t*) const { return "whole number"; }
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const std::string*) const { return "string"; }
  std::string operator()(const Vec3*) const { return "3 numbers"; }
  std::string operator()(const std::optional<int>*) const { return "whole number"; }
  std::string operator()(const std::optional<double>*) const { return "number"; }
  std::string operator()(const std::optional<Vec3>*) const { return "3 numbers"; }
  std::string operator()(const std::array<int, 3>*) const { return "3 whole numbers"; }
  std::string operator()(const std::vector<std::string>*) const { return "1 to 3 strings"; }
  std::string operator()(const std::vector<sim::KeyFrame>*) const {
    return "rows [time in s, x, y, z]";
  }
  std::string operator()(const std::vector<CameraKey>*) const {
    return "rows [time in s, eye x, y, z, target x, y, z]";
  }
  std::string operator()(const std::vector<Region>*) const {
    return "rows [xmin, ymin, zmin, xmax, ymax, zmax]";
  }
  std::string operator()(const std::vector<TimedValue>*) const { return "rows [time in s, value]"; }
  std::string operator()(const std::optional<sim::ContactMaterial>*) const {
    return "true or false";
  }
  std::string operator()(const Word& word) const {
    return fmt::format("\"{}\"", fmt::join(word.words, "\", \""));
  }
};

bool is_timed(const Slot& slot) {
  return std::holds_alternative<std::vector<sim::KeyFrame>*>(slot) ||
         std::holds_alternative<std::vector<TimedValue>*>(slot) ||
         std::holds_alternative<std::vector<CameraKey>*>(slot);
}

struct MemberOf {
  const void* operator()(std::monostate) const { return nullptr; }
  template <class T>
  const void* operator()(T* member) const {
    return member;
  }
  const void* operator()(const Word& word) const { return word.member; }
};

}  // namespace

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  if (!only.empty()) {
    return std::any_of(only.begin(), only.end(), [&](int allowed) { return value == allowed; });
  }
  const bool high_enough = low_open ? value > low : value >= low;
  const bool low_enough = high_open ? value < high : value <= high;
  return high_enough && low_enough;
}

std::string Range::text(std::string_view name) const {
  if (!only.empty()) {
    const std::size_t last = only.size() - 1;
    return fmt::format(
        "{} = {} or {}", name,
        fmt::join(only.begin(), only.begin() + static_cast<std::ptrdiff_t>(last), ", "),
        only[last]);
  }
  const bool bounded_below = std::isfinite(low);
  const bool bounded_above = std::isfinite(high);
  if (bounded_below && bounded_above) {
    return fmt::format("{} {} {} {} {}", low, low_open ? "<" : "<=", name,
                       high_open ? "<" : "<=", high);
  }
  if (bounded_below) return fmt::format("{} {} {}", name, low_open ? ">" : ">=", low);
  if (bounded_above) return fmt::format("{} {} {}", name, high_open ? "<" : "<=", high);
  return {};
}

const void* member_of(const Slot& slot) { return std::visit(MemberOf{}, slot); }

std::string type_text(const Slot& slot) { return std::visit(TypeText{}, slot); }

std::string value_text(const Slot& slot) { return std::visit(ValueText{}, slot); }

std::string units_text(const Key& key) {
  return is_timed(key.slot) ? fmt::format("{}, {}", time_unit, key.unit) : std::string(key.unit);
}

bool is_listed(std::string_view table) {
  return table == "body" || table == "valve" || table == "spring";
}

std::string header_of(std::string_view table) {
  return is_listed(table) ? fmt::format("[[{}]]", table) : fmt::format("[{}]", table);
}

std::string place_of(std::string_view table) {
  if (table.empty()) return "at the top, above the first [table]";
  return "in " + header_of(table);
}

}  // namespace pneuma::scenes
