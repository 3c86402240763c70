#include "sim/base/nearest.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace pneuma::base {
namespace {

/// The definition, without a table: the least of the three or four ways to end.
int defined_distance(const std::string& a, const std::string& b) {
  if (a.empty()) return static_cast<int>(b.size());
  if (b.empty()) return static_cast<int>(a.size());
  const std::string a1 = a.substr(0, a.size() - 1);
  const std::string b1 = b.substr(0, b.size() - 1);
  int least = defined_distance(a1, b1) + (a.back() == b.back() ? 0 : 1);
  least = std::min({least, defined_distance(a1, b) + 1, defined_distance(a, b1) + 1});
  if (a1.size() > 0 && b1.size() > 0 && a.back() == b1.back() && a1.back() == b.back()) {
    const int swapped =
        defined_distance(a1.substr(0, a1.size() - 1), b1.substr(0, b1.size() - 1)) + 1;
    least = std::min(least, swapped);
  }
  return least;
}

RC_GTEST_PROP(Nearest, DistanceIsTheDefinition, ()) {
  // Three letters and at most five of them: repeats, swaps and shifts are common, and the
  // recursion, which grows fourfold with each letter, stays short.
  const auto text =
      rc::gen::resize(5, rc::gen::container<std::string>(rc::gen::element('a', 'b', 'c')));
  const std::string a = *text;
  const std::string b = *text;
  RC_ASSERT(edit_distance(a, b) == defined_distance(a, b));
}

TEST(Printable, LeavesLettersAndEscapesWhatTerminalsObey) {
  EXPECT_EQ(printable("k\xc3\xa4se \xe2\x82\xac \xf0\x9f\x90\x88"),
            "k\xc3\xa4se \xe2\x82\xac \xf0\x9f\x90\x88");
  EXPECT_EQ(printable("\x1b[2J\x7f\n"), "\\x1b[2J\\x7f\\x0a");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\xc2\\x9b31m");                                 // control characters of two bytes
  EXPECT_EQ(printable("a\x9b\xff\xc3"), "a\\x9b\\xff\\xc3");  // no UTF-8
  EXPECT_EQ(printable("\xc1\x81\xe0\x81\x81"), "\\xc1\\x81\\xe0\\x81\\x81");  // overlong
  EXPECT_EQ(printable("\xe2\x80\xae"), "\\xe2\\x80\\xae");                    // turns the direction
  EXPECT_EQ(printable("\xed\xa0\x80\xf4\x90\x80\x80"), "\\xed\\xa0\\x80\\xf4\\x90\\x80\\x80");
}

TEST(Nearest, CountsEachKindOfSlipOnce) {
  EXPECT_EQ(edit_distance("radius", "radius"), 0);
  EXPECT_EQ(edit_distance("raduis", "radius"), 1);   // swapped
  EXPECT_EQ(edit_distance("radis", "radius"), 1);    // left out
  EXPECT_EQ(edit_distance("radiuss", "radius"), 1);  // too many
  EXPECT_EQ(edit_distance("rodius", "radius"), 1);   // wrong
  EXPECT_EQ(edit_distance("Radius", "radius"), 0);   // case
  EXPECT_EQ(edit_distance("", "abc"), 3);
}

TEST(Nearest, PicksTheLeastDistance) {
  const std::vector<std::string_view> names = {"stacks", "slices", "size"};
  EXPECT_EQ(nearest("slice", names), "slices");
  EXPECT_EQ(nearest("sizes", names), "size");
  EXPECT_EQ(nearest("stack", names), "stacks");
}

TEST(Nearest, IsSilentWhenNothingIsNear) {
  EXPECT_FALSE(nearest("wavelength", {"stacks", "slices", "size"}));
  EXPECT_FALSE(nearest("", {"k"}));
  EXPECT_FALSE(nearest("k", {}));
  EXPECT_FALSE(nearest(std::string(100'000, 'k'), {"k"}));
}

TEST(Nearest, QuotesAreFitForATerminal) {
  EXPECT_EQ(in_quotes("k"), "'k'");
  EXPECT_EQ(in_quotes("a\x1b[31m\nb"), "'a\\x1b[31m\\x0ab'");
  EXPECT_LT(in_quotes(std::string(1000, 'x')).size(), 70u);
  // Two bytes a letter: an odd cut would leave half a letter.
  std::string umlauts = "x";
  for (int i = 0; i < 100; ++i) umlauts += "\xc3\xa4";
  const std::string cut = in_quotes(umlauts);
  ASSERT_GT(cut.size(), 4u);
  EXPECT_EQ(cut.substr(cut.size() - 5), "\xa4...'");
}

}  // namespace
}  // namespace pneuma::base
