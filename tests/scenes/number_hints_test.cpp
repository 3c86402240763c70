// Numbers as people write them and TOML does not: what to write in their place.
#include "scenes/loader/text_checks.h"
#include "tests/scenes/refusal.h"

namespace pneuma::scenes {
namespace {

TEST(NumberHint, KnowsUnitsAndBarePoints) {
  EXPECT_EQ(number_hint("10 s"), "; a number stands without its unit: write 10");
  EXPECT_EQ(number_hint("-9.81m/s^2"), "; a number stands without its unit: write -9.81");
  EXPECT_EQ(number_hint("2.5e-3 mol"), "; a number stands without its unit: write 2.5e-3");
  EXPECT_EQ(number_hint(".5"), "; write 0.5");
  EXPECT_EQ(number_hint("-.5e3"), "; write -0.5e3");
  EXPECT_EQ(number_hint("3."), "; write 3.0");
  EXPECT_EQ(number_hint(".5 kg"), "; a number stands without its unit: write 0.5");
  for (const char* other :
       {"", ".", "-", "s", "10", "1.5", "1e5", "1,5", "2026-11-27", "(0, 0)", "10 s and more"}) {
    EXPECT_EQ(number_hint(other), "") << other;
  }
  std::string endless(1'000'000, '1');
  endless += " s";
  EXPECT_EQ(number_hint(endless), "");
}

TEST(NumberHint, FollowsTheParsersWords) {
  const auto body = [](const std::string& line) { return refusal("[[body]]\n" + line + "\n"); };
  expect_in(refusal("duration = 10 s\n[[body]]\n"),
            {"x.toml:1:15: Error while parsing", "its unit: write 10"});
  expect_in(refusal("duration = 10s # long\r\n[[body]]\n"), {"its unit: write 10"});
  expect_in(body("n = .5"), {"x.toml:2:5: Error while parsing", "; write 0.5\n"});
  expect_in(body("n = 1."), {"x.toml:2:", "; write 1.0\n"});
  expect_in(body("position = [0, -.5, 1]"), {"; write -0.5\n"});
  expect_in(body("position = [0, 1 m, 1]"), {"its unit: write 1\n"});
  expect_in(body("n = \"10 mol\""), {"got string \"10 mol\"; a number stands without"});
  expect_in(refusal("[[body]]\n", {"body.n=.5"}), {"got string \".5\"; write 0.5"});
  const std::string none = body("position = (0, 0, 1)");
  EXPECT_EQ(none.find("; write"), std::string::npos) << none;
}

TEST(Colours, AreAnArrayOfHexadecimalNumbers) {
  const auto body = [](const std::string& line) { return refusal("[[body]]\n" + line + "\n"); };
  expect_in(body("colours = \"red\""), {"x.toml:2:11", "'red' is not a colour; write #rrggbb"});
  expect_in(body("colours = \"#ff0000\""), {"expected an array", "write [\"#ff0000\"]"});
  expect_in(body("colours = 5"), {"expected an array of 1 to 3 strings, got integer 5"});
}

}  // namespace
}  // namespace pneuma::scenes
