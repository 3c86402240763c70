#include "app/study/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace pneuma::app {
namespace {

TEST(Csv, IsALinePerRow) {
  Csv csv({"scene", "steps", "stable"});
  csv.add_row({csv_cell("ball"), csv_cell(60), csv_cell(true)});
  csv.add_row({csv_cell("torus"), csv_cell(-1), csv_cell(false)});
  EXPECT_EQ(csv.text(), "scene,steps,stable\nball,60,true\ntorus,-1,false\n");
}

TEST(Csv, RefusesARowOfAnotherLength) {
  Csv csv({"a", "b"});
  EXPECT_THROW(csv.add_row({"1"}), std::invalid_argument);
  EXPECT_THROW(csv.add_row({"1", "2", "3"}), std::invalid_argument);
}

TEST(CsvCell, QuotesWhatWouldEndIt) {
  EXPECT_EQ(csv_cell("plain text"), "plain text");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_cell("say \"so\""), "\"say \"\"so\"\"\"");
  EXPECT_EQ(csv_cell("two\nlines"), "\"two\nlines\"");
}

TEST(CsvCell, ReadsBackToTheSameNumber) {
  for (const double value : {0.1, -1.0 / 3.0, 1e-300, 6.02214076e23, 0.0}) {
    EXPECT_EQ(std::stod(csv_cell(value)), value);
  }
}

TEST(CsvCell, IsEmptyWithoutANumber) {
  EXPECT_EQ(csv_cell(std::nan("")), "");
  EXPECT_EQ(csv_cell(std::numeric_limits<double>::infinity()), "");
}

}  // namespace
}  // namespace pneuma::app
