#include "app/cli/progress_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "app/cli/terminal.h"

namespace nephroid::cli {
namespace {

std::string formatDuration(double seconds) {
  if (seconds < 60) return fmt::format("{:.0f} s", seconds);
  const auto whole = static_cast<long>(seconds);
  if (seconds < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

std::string formatProgress(const std::string& title, double fraction, const std::string& status, double elapsed_s,
                           int width) {
  constexpr int kBarWidth = 24;
  // Before this share is done, the estimate of what is left jumps about more than it tells.
  constexpr double kFirstEstimate = 0.01;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(fraction * kBarWidth);
  std::string line = title.empty() ? "" : title + " ";
  line += fmt::format("[{}{}] {:3.0f} %  elapsed {}", std::string(filled, '#'), std::string(kBarWidth - filled, ' '),
                      fraction * 100, formatDuration(elapsed_s));
  if (fraction >= kFirstEstimate && fraction < 1)
    line += fmt::format(", left {}", formatDuration(elapsed_s * (1 - fraction) / fraction));
  if (!status.empty()) line += "  " + status;
  if (static_cast<int>(line.size()) >= width) line.resize(std::max(width - 1, 0));
  return line;
}

ProgressBar::ProgressBar(std::string title) : title_(std::move(title)), enabled_(isStderrTerminal()) {}

ProgressBar::~ProgressBar() {
  if (enabled_ && last_drawn_ != Clock::time_point{}) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::update(double fraction, const std::string& status) {
  constexpr auto kInterval = std::chrono::milliseconds(100);
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_drawn_ < kInterval) return;
  last_drawn_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r%s\x1b[K", formatProgress(title_, fraction, status, elapsed_s, terminalWidth()).c_str());
  std::fflush(stderr);
}

}  // namespace nephroid::cli
