#include "app/study/csv.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace pneuma::app {
namespace {

void append_line(std::string& text, const std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) text += ',';
    text += cells[i];
  }
  text += '\n';
}

}  // namespace

Csv::Csv(const std::vector<std::string>& columns) : columns_(columns.size()) {
  append_line(text_, columns);
}

void Csv::add_row(const std::vector<std::string>& cells) {
  if (cells.size() != columns_) {
    throw std::invalid_argument(
        fmt::format("{} cells for {} columns of a CSV file", cells.size(), columns_));
  }
  append_line(text_, cells);
}

std::string csv_cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace pneuma::app
