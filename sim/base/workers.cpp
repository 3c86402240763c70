#include "sim/base/workers.h"

namespace pneuma::base {
namespace {

/// Sleeping and being woken takes as long as many a piece of a step (tests/benchmarks/README.md):
/// for about that long a thread only yields to others.
template <class Value>
void wait_while(const std::atomic<Value>& variable, Value old) {
  for (int i = 0; i < 100 && variable == old; ++i) std::this_thread::yield();
  variable.wait(old);
}

}  // namespace

Workers::Workers(int threads) {
  for (int thread = 1; thread < threads; ++thread) {
    helpers_.emplace_back([this, thread] { help(thread); });
  }
}

Workers::~Workers() {
  stopping_ = true;
  ++round_;
  round_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Workers::run_block(int thread) const {
  const auto boundary = [this](int i) {
    return static_cast<int>(static_cast<std::int64_t>(count_) * i / threads());
  };
  const int begin = boundary(thread), end = boundary(thread + 1);
  if (begin < end) work_.call(work_.work, begin, end, thread);
}

void Workers::run(const AnyWork& work, int count) {
  if (helpers_.empty() || count <= 1) {
    if (count > 0) work.call(work.work, 0, count, 0);
    return;
  }
  work_ = work;
  count_ = count;
  busy_ = static_cast<int>(helpers_.size());
  ++round_;
  round_.notify_all();
  run_block(0);
  for (int left = busy_; left > 0; left = busy_) wait_while(busy_, left);
}

void Workers::help(int thread) {
  for (std::uint32_t seen = 0;;) {
    wait_while(round_, seen);
    seen = round_;
    if (stopping_) return;
    run_block(thread);
    if (--busy_ == 0) busy_.notify_one();
  }
}

}  // namespace pneuma::base
