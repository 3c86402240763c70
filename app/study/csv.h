// Tables for machines: comma-separated values as RFC 4180 has them.
#pragma once

#include <concepts>
#include <string>
#include <vector>

namespace pneuma::app {

class Csv {
 public:
  /// Names with their unit, as "error_end" or "run_time_s".
  explicit Csv(const std::vector<std::string>& columns);

  /// One cell per column, made by csv_cell; throws std::invalid_argument otherwise.
  void add_row(const std::vector<std::string>& cells);

  const std::string& text() const { return text_; }

 private:
  std::size_t columns_;
  std::string text_;
};

/// The shortest text that reads back to the same number; empty when it is not finite.
std::string csv_cell(double value);
/// Quoted where it must be.
std::string csv_cell(const std::string& text);
inline std::string csv_cell(const char* text) { return csv_cell(std::string(text)); }
inline std::string csv_cell(bool value) { return value ? "true" : "false"; }
template <std::integral Integer>
std::string csv_cell(Integer value) {
  return std::to_string(value);
}

}  // namespace pneuma::app
