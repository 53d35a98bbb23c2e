// Where words go: results to stdout, everything else to stderr.
#pragma once

#include <string>
#include <string_view>

namespace nephroid::cli {

bool isStderrTerminal();

/// Columns of the terminal behind stderr; 80 where there is none or it does not say.
int terminalWidth();

/// Writes a result. A reader that went away (`… | head`) ends this quietly.
/// @throws ResourceError if stdout cannot take it (a full disk)
void writeStdout(std::string_view text);

/// One line on stderr.
void writeStderr(std::string_view line);

/// "warning: TEXT" on stderr, each text once per run of the program.
void warnOnce(std::string_view text);

/// `text` on one line, so that a message never spreads over several.
std::string toOneLine(std::string_view text);

}  // namespace nephroid::cli
