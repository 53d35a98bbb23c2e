#include "app/cli/stop.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>

namespace nephroid::cli {
namespace {

StopToken g_stop;

// Only what POSIX allows in a handler: a lock-free store and write(2). What it interrupts may be about to read errno.
extern "C" void onStopSignal(int) {
  const int interrupted_errno = errno;
  g_stop.request();
  constexpr std::string_view kHint = "\nstopping; once more to kill\n";
  const bool is_told = isatty(STDERR_FILENO) == 1 && write(STDERR_FILENO, kHint.data(), kHint.size()) > 0;
  static_cast<void>(is_told);
  errno = interrupted_errno;
}

}  // namespace

void installSignalHandlers() {
  struct sigaction action {};
  action.sa_handler = onStopSignal;
  // One shot: the second signal finds the default action and ends the program, whatever it hangs in.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

const StopToken& stopToken() { return g_stop; }

}  // namespace nephroid::cli
