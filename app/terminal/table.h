// Tables for people: text in aligned columns.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pneuma::app {

class Table {
 public:
  enum class Align { left, right };
  struct Column {
    std::string heading;  // newlines make it several lines
    Align align = Align::right;
    std::string group = {};  // stands above the columns that share it, side by side
  };

  explicit Table(std::vector<Column> columns);

  /// One cell per column, throws std::invalid_argument otherwise; newlines make several lines.
  void add_row(std::vector<std::string> cells);

  /// Headings, a rule, the rows; no line ends in blanks. Text is ASCII: a byte is a column.
  std::string text() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// For cells: with newlines in place of blanks, so that no line but one of a single longer word has
/// more than `width` characters.
std::string wrapped(const std::string& text, std::size_t width);

/// For cells: about three digits, or the whole number: "0.00046", "0.012", "4.56", "78.9",
/// "12,345".
/// "-" when not finite.
std::string readable(double value);

/// An indented name, and what there is to say of it: a line of a list.
std::string named_line(std::string_view name, const std::string& text);

/// "1,234,567".
std::string grouped(long long value);

/// "1 run", "1,234 runs".
std::string counted(long long count, std::string_view one);

}  // namespace pneuma::app
