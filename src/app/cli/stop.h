// Ctrl-C: the first asks the work to stop and keep what it has, the second kills.
#pragma once

#include "core/progress.h"

namespace nephroid::cli {

/// Lets SIGINT and SIGTERM set `stopToken()`; SIGPIPE becomes an error of the write that met it.
void installSignalHandlers();

const StopToken& stopToken();

}  // namespace nephroid::cli
