#include "app/host/background.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace pneuma::app {
namespace {

TEST(Background, DoesJobsInTheirOrder) {
  std::vector<int> done;
  {
    Background background(2);
    for (int i = 0; i < 100; ++i) background.submit([&done, i] { done.push_back(i); });
  }
  std::vector<int> expected(100);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(done, expected);
}

TEST(Background, FinishWaitsForTheLast) {
  Background background(3);
  std::atomic<int> done = 0;
  for (int i = 0; i < 3; ++i) {
    background.submit([&done] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      ++done;
    });
  }
  background.finish();
  EXPECT_EQ(done, 3);
}

TEST(Background, NoMoreWaitThanAllowed) {
  std::atomic<int> submitted = 0, done = 0, most_ahead = 0;
  Background background(1);
  for (int i = 0; i < 20; ++i) {
    background.submit([&] {
      most_ahead = std::max<int>(most_ahead, submitted - done);
      ++done;
    });
    ++submitted;
  }
  background.finish();
  // One being done, one waiting, and one whose submission is just coming back.
  EXPECT_LE(most_ahead, 3);
}

TEST(Background, AnErrorComesBackAndEndsTheWork) {
  Background background(1);
  std::atomic<int> done = 0;
  background.submit([] { throw std::runtime_error("disk full"); });
  EXPECT_THROW(
      {
        for (int i = 0; i < 10; ++i) background.submit([&done] { ++done; });
      },
      std::runtime_error);
  EXPECT_THROW(background.finish(), std::runtime_error);
  EXPECT_EQ(done, 0);
}

}  // namespace
}  // namespace pneuma::app
