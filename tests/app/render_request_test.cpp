#include "app/render_request.h"

#include <gtest/gtest.h>

#include "app/errors.h"

namespace pneuma::app {
namespace {

TEST(ParseFrames, TakesACountAPartOrAnEnd) {
  EXPECT_EQ(parse_frames("30").first, 0);
  EXPECT_EQ(parse_frames("30").last, 29);
  EXPECT_EQ(parse_frames("10-20").first, 10);
  EXPECT_EQ(parse_frames("10-20").last, 20);
  EXPECT_EQ(parse_frames("7-7").last, 7);
  EXPECT_EQ(parse_frames("10-").first, 10);
  EXPECT_EQ(parse_frames("10-").last, std::nullopt);
}

TEST(ParseFrames, RefusesEverythingElse) {
  for (const char* wrong : {"", "0", "-1", "-", "20-10", "1-2-3", "1..2", "a", "3 ", "1.5", "+3",
                            "99999999999999999999", "1--2", "0x10"}) {
    EXPECT_THROW(parse_frames(wrong), UsageError) << wrong;
  }
}

TEST(ParseGrid, TakesTwoNumbers) {
  const GridSize grid = parse_grid("--sheet", "4x3", 100);
  EXPECT_EQ(grid.columns, 4);
  EXPECT_EQ(grid.rows, 3);
}

TEST(ParseGrid, RefusesEverythingElseAndNamesTheOption) {
  for (const char* wrong : {"", "4", "x", "4x", "x3", "0x3", "4x0", "-1x3", "101x1", "1x101", "4X3",
                            "4x3x2", "4 x 3"}) {
    try {
      parse_grid("--sheet", wrong, 100);
      ADD_FAILURE() << wrong;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find("--sheet"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace pneuma::app
