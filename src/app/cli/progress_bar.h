// A line on the terminal that tells how far a render is.
#pragma once

#include <chrono>
#include <string>

#include "core/progress.h"

namespace nephroid::cli {

/// Draws "[#####     ]  42 %  status  elapsed 12 s, left 17 s" on stderr; silent where stderr is no terminal.
class ProgressBar : public ProgressSink {
 public:
  /// @param title  stands before the bar ("frame 3/48"); may be empty
  explicit ProgressBar(std::string title);
  ~ProgressBar() override;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(double fraction, const std::string& status) override;

 private:
  using Clock = std::chrono::steady_clock;

  std::string title_;
  bool enabled_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_drawn_{};
};

/// The line that `ProgressBar` draws, cut to `width` columns.
/// @param fraction   in [0, 1]
/// @param elapsed_s  since the start; what is left follows from it once 1 % is done
std::string formatProgress(const std::string& title, double fraction, const std::string& status, double elapsed_s,
                           int width);

}  // namespace nephroid::cli
