// A thread that does one job after the other while its owner goes on.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace pneuma::app {

class Background {
 public:
  using Job = std::function<void()>;

  /// At most so many jobs (>= 1) wait beside the one that is being done: memory stays bounded.
  explicit Background(std::size_t most_waiting);
  /// Finishes what is waiting. An error that nobody has asked for by then is lost.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Jobs are done in the order in which they came. Waits until there is room. Throws what an
  /// earlier job has thrown, after which no further job is done.
  void submit(Job job);

  /// Waits until all is done. Throws what a job has thrown.
  void finish();

 private:
  void work();
  void rethrow();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> waiting_;
  std::size_t most_waiting_;
  bool busy_ = false;
  bool stopping_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace pneuma::app
