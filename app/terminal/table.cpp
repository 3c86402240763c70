#include "app/terminal/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace pneuma::app {
namespace {

constexpr std::string_view gap = "  ";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines = {""};
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

void end_line(std::string& text) {
  text.erase(text.find_last_not_of(' ') + 1);
  text += '\n';
}

using Widths = std::vector<std::size_t>;
using Columns = std::vector<Table::Column>;

/// One past the last of the columns that share the group of column `begin`.
std::size_t end_of_group(const Columns& columns, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < columns.size() && columns[end].group == columns[begin].group) ++end;
  return end;
}

std::size_t width_of(const Widths& widths, std::size_t begin, std::size_t end) {
  std::size_t sum = gap.size() * (end - begin - 1);
  for (std::size_t c = begin; c < end; ++c) sum += widths[c];
  return sum;
}

/// A group's name wider than its columns widens the first of them.
void widen_for_groups(const Columns& columns, Widths& widths) {
  for (std::size_t begin = 0; begin < columns.size(); begin = end_of_group(columns, begin)) {
    const std::size_t width = width_of(widths, begin, end_of_group(columns, begin));
    const std::size_t wanted = columns[begin].group.size();
    if (wanted > width) widths[begin] += wanted - width;
  }
}

/// Empty when no column has a group.
std::string group_line(const Columns& columns, const Widths& widths) {
  if (std::ranges::all_of(columns, &std::string::empty, &Table::Column::group)) return "";
  std::string line;
  for (std::size_t begin = 0; begin < columns.size();) {
    const std::size_t end = end_of_group(columns, begin);
    const std::size_t width = width_of(widths, begin, end);
    const std::string& name = columns[begin].group;
    line += begin == 0 ? "" : gap;
    // Dashes show how far a name reaches, where there is room for them.
    line += name.size() + 4 > width || name.empty()
                ? fmt::format("{:^{}}", name, width)
                : fmt::format("{:-^{}}", ' ' + name + ' ', width);
    begin = end;
  }
  end_line(line);
  return line;
}

using Row = std::vector<std::string>;

/// Makes the columns as wide as the longest line of each cell.
void widen_for(const Row& row, Widths& widths) {
  for (std::size_t c = 0; c < row.size(); ++c) {
    for (const std::string& line : lines_of(row[c])) widths[c] = std::max(widths[c], line.size());
  }
}

/// Where a cell of fewer lines than its neighbours stands.
enum class VerticalAlign { top, bottom };

std::string row_text(const Row& row, const Columns& columns, const Widths& widths,
                     VerticalAlign vertical) {
  std::vector<std::vector<std::string>> cells;
  std::size_t height = 0;
  for (const std::string& cell : row) {
    cells.push_back(lines_of(cell));
    height = std::max(height, cells.back().size());
  }
  for (auto& cell : cells) {
    const auto where = vertical == VerticalAlign::top ? cell.end() : cell.begin();
    cell.insert(where, height - cell.size(), "");
  }
  std::string text;
  for (std::size_t i = 0; i < height; ++i) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      line += c == 0 ? "" : gap;
      line += columns[c].align == Table::Align::left
                  ? fmt::format("{:<{}}", cells[c][i], widths[c])
                  : fmt::format("{:>{}}", cells[c][i], widths[c]);
    }
    end_line(line);
    text += line;
  }
  return text;
}

}  // namespace

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

void Table::add_row(std::vector<std::string> cells) {
  if (cells.size() != columns_.size()) {
    throw std::invalid_argument(
        fmt::format("a row of {} cells in a table of {} columns", cells.size(), columns_.size()));
  }
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  Row headings;
  for (const Column& column : columns_) headings.push_back(column.heading);
  Widths widths(columns_.size(), 0);
  widen_for(headings, widths);
  for (const Row& row : rows_) widen_for(row, widths);
  widen_for_groups(columns_, widths);

  std::string text = group_line(columns_, widths);
  text += row_text(headings, columns_, widths, VerticalAlign::bottom);
  Row rule;
  for (const std::size_t width : widths) rule.emplace_back(width, '-');
  text += row_text(rule, columns_, widths, VerticalAlign::top);
  for (const Row& row : rows_) text += row_text(row, columns_, widths, VerticalAlign::top);
  return text;
}

std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string result, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      result += line + '\n';
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return result + line;
}

std::string named_line(std::string_view name, const std::string& text) {
  return fmt::format("  {:<18} {}\n", name, text);
}

std::string grouped(long long value) {
  std::string digits = std::to_string(value);
  const std::size_t first = value < 0 ? 1 : 0;
  for (std::size_t i = digits.size(); i > first + 3;) digits.insert(i -= 3, 1, ',');
  return digits;
}

std::string counted(long long count, std::string_view one) {
  return fmt::format("{} {}{}", grouped(count), one, count == 1 ? "" : "s");
}

std::string readable(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  // The bounds are where rounding to fewer decimals sets in: 99.96 is "100".
  // Beyond what a double has digits for, and in the end beyond what an integer holds.
  if (size >= 1e15) return fmt::format("{:.3g}", value);
  if (size >= 99.95) return grouped(std::llround(value));
  if (size >= 9.995) return fmt::format("{:.1f}", value);
  if (size >= 0.9995 || size == 0.0) return fmt::format("{:.2f}", value);
  if (size >= 0.001) return fmt::format("{:.3f}", value);
  return fmt::format("{:.2g}", value);
}

}  // namespace pneuma::app
