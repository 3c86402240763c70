#include "app/terminal/grid_size.h"

#include <gtest/gtest.h>

#include "app/host/errors.h"

namespace pneuma::app {
namespace {

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

TEST(AppendSize, SetsWidthAndHeightOfTheScenesPictures) {
  std::vector<std::string> overrides = {"body.k=3"};
  append_size("640x480", overrides);
  EXPECT_EQ(overrides,
            (std::vector<std::string>{"body.k=3", "picture.width=640", "picture.height=480"}));
  for (const char* wrong : {"640", "10x10", "640x15", "99999x99999"}) {
    EXPECT_THROW(append_size(wrong, overrides), UsageError) << wrong;
  }
}

}  // namespace
}  // namespace pneuma::app
