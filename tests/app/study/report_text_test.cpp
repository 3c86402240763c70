#include "app/study/report_text.h"

#include <gtest/gtest.h>

namespace pneuma::app {
namespace {

const std::string eight = "twelve bytes twelve bytes twelve bytes twelve bytes";
const std::string sixteen = eight + " " + eight;  // 103 bytes

TEST(ReportText, PutsAParagraphBesideItsLabel) {
  EXPECT_EQ(labelled("Motion", "free flight"), "Motion     free flight\n");
  // 107 columns are left beside the label.
  EXPECT_EQ(labelled("Motion", sixteen + " and more"),
            "Motion     " + sixteen + " and\n           more\n");
}

TEST(ReportText, WrapsItemsAndWarnings) {
  EXPECT_EQ(list_item("short"), "- short\n");
  EXPECT_EQ(warnings_text({"one", "two"}), "Warning: one.\nWarning: two.\n");
  EXPECT_EQ(warnings_text({}), "");
}

TEST(ReportText, WritesPowersOfTen) {
  EXPECT_EQ(power_of_ten(1e-2), "1e-2");
  EXPECT_EQ(power_of_ten(1e-12), "1e-12");
  EXPECT_EQ(power_of_ten(1.0), "1e0");
}

}  // namespace
}  // namespace pneuma::app
