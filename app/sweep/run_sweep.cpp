#include "app/sweep/run_sweep.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"

namespace pneuma::app {
namespace {

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole >= 3600)
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

class Runner {
 public:
  Runner(const Sweep& sweep, const std::filesystem::path& folder, SweepJournal& journal,
         Progress& progress)
      : sweep_(sweep), folder_(folder), journal_(journal), progress_(progress) {}

  void run(const RunRange& range, int threads) {
    for (std::int64_t number = range.first; number <= range.last; ++number) {
      if (!journal_.rows().contains(number)) missing_.push_back(number);
    }
    all_ = range.last - range.first + 1;
    {
      std::vector<std::jthread> others;
      for (int i = 1; i < threads; ++i) others.emplace_back([this] { work(); });
      work();
    }
    if (error_) std::rethrow_exception(error_);
    throw_if_interrupted();
  }

 private:
  void work() {
    try {
      for (std::size_t i = next_++; i < missing_.size() && !stopped_; i = next_++) {
        if (interrupted()) return;
        SweepRow row = run_one(sweep_, run_of(sweep_, missing_[i]), folder_);
        const std::lock_guard lock(mutex_);
        take(std::move(row));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stopped_ = true;
    }
  }

  void take(SweepRow row) {
    if (row.code != ExitCode::done) ++failed_;
    journal_.add(std::move(row));
    ++done_;
    const auto left = static_cast<double>(missing_.size()) - static_cast<double>(done_);
    const double seconds = seconds_since(start_);
    progress_.show(fmt::format("run {}/{}{}   ETA {}",
                               all_ - static_cast<std::int64_t>(missing_.size()) + done_, all_,
                               failed_ > 0 ? fmt::format("   {} not done", failed_) : "",
                               duration_text(seconds / static_cast<double>(done_) * left)));
  }

  const Sweep& sweep_;
  const std::filesystem::path& folder_;
  SweepJournal& journal_;
  Progress& progress_;
  std::vector<std::int64_t> missing_;
  std::int64_t all_ = 0;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::exception_ptr error_;
  std::int64_t done_ = 0;
  std::int64_t failed_ = 0;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

void run_sweep(const Sweep& sweep, const RunRange& range, int threads,
               const std::filesystem::path& folder, SweepJournal& journal, Progress& progress) {
  Runner(sweep, folder, journal, progress).run(range, threads);
}

}  // namespace pneuma::app
