#include "assets/sandbox.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "assets/model.h"

namespace pneuma::assets {
namespace {

std::string refusal(const std::function<std::string()>& work, const ApartLimits& limits = {}) {
  try {
    run_in_sandbox(work, limits);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RunApart, GivesTheAnswer) {
  EXPECT_EQ(run_in_sandbox([] { return std::string(); }), "");
  const std::string large(3'000'000, 'x');  // many times what a pipe holds
  EXPECT_EQ(run_in_sandbox([&] { return large; }), large);
}

TEST(RunApart, LeavesThisProcessAlone) {
  int value = 1;
  run_in_sandbox([&] {
    value = 2;
    std::fputs("must not be seen", stdout);
    std::fflush(stdout);
    return std::string();
  });
  EXPECT_EQ(value, 1);
}

TEST(RunApart, TurnsEveryEndIntoAnError) {
  EXPECT_EQ(refusal([]() -> std::string { throw std::runtime_error("vertex 7"); }), "vertex 7");
  EXPECT_NE(refusal([]() -> std::string { throw 7; }).find("without a name"), std::string::npos);
  EXPECT_NE(refusal([]() -> std::string { throw std::bad_alloc(); }).find("memory"),
            std::string::npos);
  for (const int signal : {SIGSEGV, SIGABRT, SIGKILL, SIGBUS}) {
    const std::string message = refusal([&]() -> std::string {
      ::signal(signal, SIG_DFL);  // a sanitizer has handlers of its own
      kill(getpid(), signal);
      for (;;) pause();
    });
    EXPECT_NE(message.find("broke down"), message.npos) << signal << ": " << message;
  }
  for (const int code : {1, 7}) {
    const std::string message = refusal([&]() -> std::string { _exit(code); });
    EXPECT_NE(message.find("broke down"), message.npos) << message;
  }
}

TEST(RunApart, EndsWorkWithoutEnd) {
  const std::string message = refusal(
      []() -> std::string {
        for (;;) static_cast<void>(getppid());  // works, and never waits
      },
      {.seconds = 1});
  EXPECT_NE(message.find("did not come to an end within 1 seconds"), message.npos) << message;
}

TEST(RunApart, LimitsMemory) {
  const std::string message = refusal(
      [] {
        std::vector<std::string> all;
        for (int i = 0; i < 4096; ++i) all.emplace_back(1 << 20, 'x');
        return std::to_string(all.size());
      },
      {.memory = std::size_t{256} << 20});
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer took all its address space before";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
  GTEST_SKIP() << "the sanitizer took all its address space before";
#endif
#endif
  EXPECT_NE(message.find("more than 256 MiB of memory"), message.npos) << message;
}

TEST(RunApart, LimitsTheAnswer) {
  EXPECT_NE(refusal([] { return std::string(1'000'000, 'x'); }, {.answer = 999'999}).find("large"),
            std::string::npos);
}

}  // namespace
}  // namespace pneuma::assets
