// What can go wrong in the world, one class per exit code of the command line.
//
// Programming errors are assertions (core/assert.h); expected events (a ray that misses) are return values.
#pragma once

#include <stdexcept>
#include <string>

namespace nephroid {

/// Exit codes of the `nephroid` program; a library user sees them through `Error::exitCode`.
enum class ExitCode : int {
  kDone = 0,
  kInternal = 1,
  kUsage = 2,
  kBadInput = 3,
  kNoDevice = 4,
  kNoResource = 5,
  kInterrupted = 130,
};

/// Base of all exceptions that Nephroid throws on purpose.
/// The message is one line that names the file, the place in it, what was found, what was expected and what to do.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode exitCode() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// A broken promise inside Nephroid: please report it.
class InternalError : public Error {
 public:
  explicit InternalError(const std::string& message) : Error(ExitCode::kInternal, message) {}
};

/// Wrong call: unknown option, value out of range, contradictory options.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(ExitCode::kUsage, message) {}
};

/// A file that is missing, broken or asks for something that Nephroid does not do.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(ExitCode::kBadInput, message) {}
};

/// No device can do what was asked for.
class DeviceError : public Error {
 public:
  explicit DeviceError(const std::string& message) : Error(ExitCode::kNoDevice, message) {}
};

/// Out of memory or disk, or a path that cannot be written.
class ResourceError : public Error {
 public:
  explicit ResourceError(const std::string& message) : Error(ExitCode::kNoResource, message) {}
};

/// Stopped by the user before there was any result to keep.
class InterruptedError : public Error {
 public:
  explicit InterruptedError(const std::string& message) : Error(ExitCode::kInterrupted, message) {}
};

}  // namespace nephroid
