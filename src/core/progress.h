// How long work reports to whoever asked for it, and how it is asked to stop.
#pragma once

#include <atomic>
#include <string>

namespace nephroid {

/// Receives progress; called from one thread at a time, a few times a second at most.
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  /// @param fraction  done, in [0, 1]
  /// @param status    what is being done and how far, short ("caustic 12.3 M photons")
  virtual void update(double fraction, const std::string& status) = 0;
};

/// Set from anywhere (a signal handler included) to ask work to stop at its next safe point.
class StopToken {
 public:
  void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
  bool requested() const noexcept { return requested_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> requested_{false};
};

}  // namespace nephroid
