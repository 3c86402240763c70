#include "sim/base/workers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace pneuma::base {
namespace {

TEST(Workers, EachPieceIsDoneOncePerCallInConsecutiveBlocks) {
  for (const int threads : {1, 2, 5}) {
    Workers workers(threads);
    for (const int count : {0, 1, 2, 7, 1000}) {
      for (int round = 0; round < 50; ++round) {
        std::vector<int> done(static_cast<std::size_t>(count), 0);
        std::vector<std::array<int, 2>> blocks(static_cast<std::size_t>(threads), {0, 0});
        workers.for_blocks(count, [&](int begin, int end, int thread) {
          for (int i = begin; i < end; ++i) ++done[static_cast<std::size_t>(i)];
          blocks[static_cast<std::size_t>(thread)] = {begin, end};
        });
        EXPECT_EQ(std::ranges::count(done, 1), count);
        std::erase_if(blocks, [](const auto& block) { return block[0] == block[1]; });
        std::ranges::sort(blocks);
        for (std::size_t b = 1; b < blocks.size(); ++b) EXPECT_EQ(blocks[b][0], blocks[b - 1][1]);
      }
    }
  }
}

}  // namespace
}  // namespace pneuma::base
