#include "app/terminal/table.h"

#include <gtest/gtest.h>

#include <limits>

namespace pneuma::app {
namespace {

using Align = Table::Align;

TEST(Table, AlignsColumnsUnderTheirHeadings) {
  Table table({{"scene", Align::left}, {"paper\nfps"}, {"title", Align::left}});
  table.add_row({"a", "7", "first"});
  table.add_row({"longer name", "123456", "second"});
  EXPECT_EQ(table.text(),
            "              paper\n"
            "scene           fps  title\n"
            "-----------  ------  ------\n"
            "a                 7  first\n"
            "longer name  123456  second\n");
}

TEST(Table, WritesAGroupAboveItsColumns) {
  Table table({{"scene", Align::left},
               {"median", Align::right, "fps"},
               {"5th", Align::right, "fps"},
               {"all"}});
  table.add_row({"a", "1", "2", "3"});
  EXPECT_EQ(table.text(),
            "       --- fps ---\n"
            "scene  median  5th  all\n"
            "-----  ------  ---  ---\n"
            "a           1    2    3\n");
}

TEST(Table, AWideGroupWidensItsColumns) {
  Table table(
      {{"a", Align::right, "very wide group"}, {"b", Align::right, "very wide group"}, {"c"}});
  table.add_row({"1", "2", "3"});
  EXPECT_EQ(table.text(),
            "very wide group\n"
            "           a  b  c\n"
            "------------  -  -\n"
            "           1  2  3\n");
}

TEST(Table, CellsOfSeveralLinesHangAndHeadingsStand) {
  Table table({{"a", Align::left}, {"b\nc"}});
  table.add_row({"first\nsecond", "1"});
  table.add_row({"third", "2"});
  EXPECT_EQ(table.text(),
            "        b\n"
            "a       c\n"
            "------  -\n"
            "first   1\n"
            "second\n"
            "third   2\n");
}

TEST(Counted, KnowsOne) {
  EXPECT_EQ(counted(0, "run"), "0 runs");
  EXPECT_EQ(counted(1, "run"), "1 run");
  EXPECT_EQ(counted(12345, "run"), "12,345 runs");
}

TEST(Wrapped, BreaksAtBlanksOnly) {
  EXPECT_EQ(wrapped("", 5), "");
  EXPECT_EQ(wrapped("ab cd", 5), "ab cd");
  EXPECT_EQ(wrapped("ab cd", 4), "ab\ncd");
  EXPECT_EQ(wrapped("ab cd ef gh", 5), "ab cd\nef gh");
  EXPECT_EQ(wrapped("a longest b", 3), "a\nlongest\nb");
}

TEST(Table, RefusesARowOfAnotherLength) {
  Table table({{"a"}, {"b"}});
  EXPECT_THROW(table.add_row({"1"}), std::invalid_argument);
}

TEST(Table, WithoutRowsHasItsHeadings) { EXPECT_EQ(Table({{"ab"}}).text(), "ab\n--\n"); }

TEST(Readable, KeepsAboutThreeDigitsOrTheWholeNumber) {
  EXPECT_EQ(readable(0.0), "0.00");
  EXPECT_EQ(readable(0.00045678), "0.00046");
  EXPECT_EQ(readable(0.012345), "0.012");
  EXPECT_EQ(readable(0.9996), "1.00");
  EXPECT_EQ(readable(4.5678), "4.57");
  EXPECT_EQ(readable(9.999), "10.0");
  EXPECT_EQ(readable(78.94), "78.9");
  EXPECT_EQ(readable(99.96), "100");
  EXPECT_EQ(readable(1234.4), "1,234");
  EXPECT_EQ(readable(-1234567.0), "-1,234,567");
  EXPECT_EQ(readable(9e18), "9e+18");
  EXPECT_EQ(readable(-1.234e200), "-1.23e+200");
  EXPECT_EQ(readable(std::numeric_limits<double>::infinity()), "-");
}

TEST(Grouped, SeparatesThousands) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(-999), "-999");
  EXPECT_EQ(grouped(-1000), "-1,000");
  EXPECT_EQ(grouped(12345678), "12,345,678");
}

}  // namespace
}  // namespace pneuma::app
