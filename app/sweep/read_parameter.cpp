#include "app/sweep/read_parameter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/sweep/read_sweep.h"

namespace pneuma::app {
namespace {

using scenes::Member;
using scenes::Table;
using scenes::Value;

constexpr std::array top_keys = {
    SweepKey{"scenes", "[\"one_sphere\"]", "names, or paths from this file's folder; required"},
    SweepKey{"set", "[\"duration=2\"]", "overrides of every run, as for --set"},
    SweepKey{"measure", "[\"energy\", \"penetration\"]", "the columns of the table; below"},
    SweepKey{"samples", "100", "how often random parameters are drawn"},
    SweepKey{"seed", "1", "of the random numbers"},
    SweepKey{"frames", "\"last\"", "pictures of each run: \"none\", \"last\" or \"all\""},
    SweepKey{"size", "\"320x240\"", "of the pictures"},
    SweepKey{"parameter", "", "what is varied, each in a table [[parameter]]"},
};

constexpr std::array parameter_keys = {
    SweepKey{"key", "\"body.k\"", "as for --set; required"},
    SweepKey{"values", "[10, 50, 200]", "a list, or one of:"},
    SweepKey{"range", "[0, 1]", "count values from one to the other, both among them"},
    SweepKey{"log_range", "[1, 1e4]", "the same, each larger than the last by the same factor"},
    SweepKey{"random", "[0, 1]", "a number between them for each sample"},
    SweepKey{"log_random", "[1, 1e4]", "the same, as likely between 1 and 2 as between 2 and 4"},
    SweepKey{"count", "11", "of range and log_range"},
    SweepKey{"whole", "true", "round to whole numbers"},
};

/// Of the keys that say which values, exactly one is to be there.
constexpr std::array<std::string_view, 5> value_keys = {"values", "range", "log_range", "random",
                                                        "log_random"};
constexpr double most_values = 1e6;

std::vector<std::string_view> names(std::span<const SweepKey> keys) {
  std::vector<std::string_view> all;
  for (const SweepKey& key : keys) all.push_back(key.name);
  return all;
}

class ParameterReader {
 public:
  ParameterReader(const Table& table, const scenes::Origin& at, SweepValues& values)
      : table_(table), at_(at), values_(values) {}

  std::optional<Parameter> read() {
    values_.refuse_unknown(table_, names(parameter_keys), "in [[parameter]]");
    if (!read_key()) return std::nullopt;
    const Member* given = the_value_key();
    if (given == nullptr) return std::nullopt;
    if (const Member* whole = scenes::find(table_, "whole")) {
      parameter_.whole = values_.flag(*whole).value_or(false);
    }
    const bool read = given->key == "values" ? read_values(*given) : read_range(*given);
    return read ? std::optional(parameter_) : std::nullopt;
  }

 private:
  bool read_key() {
    const Member* key = scenes::find(table_, "key");
    if (key == nullptr) {
      values_.add(at_, "key is missing: what is varied, as key = \"body.k\"");
      return false;
    }
    parameter_.key = values_.text(*key);
    if (!parameter_.key.empty() && parameter_.key.find('=') == std::string::npos) return true;
    values_.add(key->value.at, "key takes the path of a key of the scene, as \"body.k\"");
    return false;
  }

  const Member* the_value_key() {
    const Member* found = nullptr;
    for (const Member& member : table_) {
      if (std::ranges::find(value_keys, member.key) == value_keys.end()) continue;
      if (found != nullptr) {
        values_.add(member.at, fmt::format("{} stands beside {}; give one of {}", member.key,
                                           found->key, fmt::join(value_keys, ", ")));
        return nullptr;
      }
      found = &member;
    }
    if (found == nullptr) {
      values_.add(at_, fmt::format("no values: give one of {}", fmt::join(value_keys, ", ")));
    }
    return found;
  }

  bool read_values(const Member& member) {
    const auto* array = std::get_if<scenes::Array>(&member.value.data);
    if (array == nullptr || array->empty() || scenes::holds_tables(member.value)) {
      values_.add(member.value.at, fmt::format("values is {}; it takes an array of values",
                                               scenes::describe(member.value)));
      return false;
    }
    for (const char* idle : {"count", "whole"}) {
      if (const Member* other = scenes::find(table_, idle)) {
        values_.add(other->at, fmt::format("{} has no effect beside values", idle));
      }
    }
    for (const Value& value : *array) parameter_.values.push_back(toml_text(value));
    return true;
  }

  bool read_range(const Member& member) {
    const auto ends = read_ends(member);
    if (!ends) return false;
    const bool random = member.key.ends_with("random");
    parameter_.random = *ends;
    const Member* count = scenes::find(table_, "count");
    if (random) {
      if (count != nullptr) {
        values_.add(count->at,
                    fmt::format("count has no effect beside {}; samples at the top says how many",
                                member.key));
      }
      return count == nullptr;
    }
    if (count == nullptr) {
      values_.add(member.at, fmt::format("{} needs count: how many values", member.key));
      return false;
    }
    const auto number = values_.whole(*count, 2.0, most_values);
    if (!number) return false;
    spread(*number);
    return true;
  }

  std::optional<RandomRange> read_ends(const Member& member) {
    parameter_.logarithmic = member.key.starts_with("log_");
    const auto* array = std::get_if<scenes::Array>(&member.value.data);
    if (array == nullptr || array->size() != 2) {
      values_.add(member.value.at, fmt::format("{} is {}; it takes two numbers, [low, high]",
                                               member.key, scenes::describe(member.value)));
      return std::nullopt;
    }
    const auto low = values_.number((*array)[0], member.key);
    const auto high = values_.number((*array)[1], member.key);
    if (!low || !high) return std::nullopt;
    if (*low < *high && (!parameter_.logarithmic || *low > 0.0)) return RandomRange{*low, *high};
    values_.add(member.value.at, fmt::format("{} = [{}, {}]: {}", member.key, *low, *high,
                                             *low < *high ? "logarithms need numbers above 0"
                                                          : "low must be below high"));
    return std::nullopt;
  }

  void spread(std::int64_t count) {
    const auto [low, high] = parameter_.random;
    for (std::int64_t i = 0; i < count; ++i) {
      const double fraction = static_cast<double>(i) / static_cast<double>(count - 1);
      double value = parameter_.logarithmic ? low * std::pow(high / low, fraction)
                                            : low + (high - low) * fraction;
      if (i + 1 == count) value = high;
      std::string text =
          parameter_.whole ? fmt::format("{}", std::llround(value)) : fmt::format("{}", value);
      // Rounded values may come twice.
      if (parameter_.values.empty() || parameter_.values.back() != text) {
        parameter_.values.push_back(std::move(text));
      }
    }
  }

  const Table& table_;
  scenes::Origin at_;
  SweepValues& values_;
  Parameter parameter_;
};

std::string reference_of(std::span<const SweepKey> keys) {
  std::string text;
  for (const SweepKey& key : keys) {
    text += fmt::format(
        "{:<40}# {}\n",
        key.example.empty() ? std::string(key.name) : fmt::format("{} = {}", key.name, key.example),
        key.meaning);
  }
  return text;
}

}  // namespace

std::vector<std::string_view> sweep_keys() { return names(top_keys); }

std::optional<Parameter> read_parameter(const Table& table, const scenes::Origin& at,
                                        SweepValues& values) {
  return ParameterReader(table, at, values).read();
}

std::string sweep_reference() {
  return fmt::format(
      "# A sweep file is TOML. At the top:\n{}\n# [[parameter]], as many as wanted; the last "
      "changes fastest:\n{}\n# What can be measured, as `pneuma check --run --json` has it; of a "
      "run that diverged only seconds and steps:\n{}\n",
      reference_of(top_keys), reference_of(parameter_keys), fmt::join(measure_names(), "\n"));
}

}  // namespace pneuma::app
