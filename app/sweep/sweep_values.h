// Values of a sweep file, each checked where it stands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/document.h"
#include "scenes/loader/report.h"

namespace pneuma::app {

/// Reads single values and reports what is wrong with them.
class SweepValues {
 public:
  explicit SweepValues(scenes::Report& report) : report_(report) {}

  void add(const scenes::Origin& at, std::string message) { report_.add(at, std::move(message)); }

  /// `where`: "in a sweep".
  void refuse_unknown(const scenes::Table& table, const std::vector<std::string_view>& keys,
                      std::string_view where);

  /// A string, or an array of strings of at least one; those that are strings.
  std::vector<const scenes::Value*> strings(const scenes::Member& member);
  /// Empty after an error.
  std::string text(const scenes::Member& member);
  /// One of a few words.
  std::string word(const scenes::Member& member, const std::vector<std::string_view>& words);
  std::optional<bool> flag(const scenes::Member& member);
  /// A finite number.
  std::optional<double> number(const scenes::Value& value, std::string_view what);
  std::optional<std::int64_t> whole(const scenes::Member& member, double low, double high);

 private:
  scenes::Report& report_;
};

/// A value as TOML, on one line.
std::string toml_text(const scenes::Value& value);

}  // namespace pneuma::app
