#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <random>
#include <system_error>
#include <utility>

#include "nephroid/error.h"

namespace nephroid {
namespace {

namespace fs = std::filesystem;

std::string describe(int error_number) { return std::generic_category().message(error_number); }

/// Owns a file descriptor. `close` reports what the destructor must swallow: on a network disk a full quota may show
/// only there.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  bool valid() const { return fd_ >= 0; }
  /// @return 0 or an errno
  int close() {
    const int fd = std::exchange(fd_, -1);
    return ::close(fd) == 0 || errno == EINTR ? 0 : errno;
  }

 private:
  int fd_;
};

int openRetrying(const fs::path& path, int flags, mode_t mode = 0) {
  int fd = -1;
  do fd = ::open(path.c_str(), flags | O_CLOEXEC, mode);
  while (fd < 0 && errno == EINTR);
  return fd;
}

const char* adviseOnWriting(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "free some space or name a path on another disk";
    case EACCES:
    case EPERM:
      return "name a path that you may write, or change its permissions";
    case EROFS:
      return "the file system is read-only: name a path on another";
    case ENOENT:
      return "create the folder first";
    case ENOTDIR:
      return "a part of the path is a file, not a folder: name another path";
    case EISDIR:
      return "it is a folder: add a file name";
    case ENAMETOOLONG:
      return "choose a shorter name";
    case EIO:
      return "the disk reports a fault: name a path on another";
    default:
      return "name another path";
  }
}

[[noreturn]] void failWriting(const fs::path& path, int error_number, std::uint64_t byte_count = 0) {
  const std::string needed = byte_count > 0 ? fmt::format(" ({} bytes needed)", byte_count) : "";
  throw ResourceError(fmt::format("{}: cannot write: {}{}; {}", path.string(), describe(error_number), needed,
                                  adviseOnWriting(error_number)));
}

/// What a path that is to be written stands for.
struct WriteTarget {
  fs::path path;         ///< with symbolic links followed, so that a link stays a link
  bool exists = false;   ///< a regular file is there
  bool special = false;  ///< a device, FIFO or socket: written directly, for it cannot be replaced by renaming
  mode_t mode = 0;       ///< permission bits of the existing file
};

fs::path followLinks(fs::path path) {
  constexpr int kMaxLinks = 40;  // as Linux; more is a cycle, which stat() reports below
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return path;
}

/// @throws ResourceError for folders and for files without write permission (renaming would replace them all the same)
WriteTarget inspectTarget(const fs::path& path) {
  if (path.empty()) throw ResourceError("cannot write: the file name is empty; name a file");
  if (!path.has_filename()) failWriting(path, EISDIR);
  WriteTarget target{.path = followLinks(path)};
  struct stat info {};
  if (::stat(target.path.c_str(), &info) != 0) {
    if (errno == ENOENT) return target;
    failWriting(path, errno);
  }
  if (S_ISDIR(info.st_mode)) failWriting(path, EISDIR);
  if (::faccessat(AT_FDCWD, target.path.c_str(), W_OK, AT_EACCESS) != 0) failWriting(path, errno);
  target.special = !S_ISREG(info.st_mode);
  target.exists = !target.special;
  target.mode = info.st_mode & 0777;
  return target;
}

std::string makeTemporaryName(const fs::path& path, std::random_device& random) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  constexpr std::size_t kMaxStem = 240;  // NAME_MAX is 255 almost everywhere; we add eight characters
  std::string name = fmt::format(".{}.", path.filename().string().substr(0, kMaxStem));
  for (int i = 0; i < 6; ++i) name += kLetters[random() % kLetters.size()];
  return name;
}

/// A new, empty file beside the target that disappears unless `commit` renames it.
class TemporaryFile {
 public:
  /// Opened with O_EXCL and mode 0666 rather than by mkstemp: so the kernel applies the umask, which a program cannot
  /// read without changing it under other threads.
  explicit TemporaryFile(const WriteTarget& target, const fs::path& named) : target_(target), named_(named) {
    constexpr int kAttempts = 64;  // 36^6 names: a second attempt is already unlikely
    std::random_device random;
    int fd = -1;
    for (int i = 0; i < kAttempts; ++i) {
      path_ = target.path.parent_path() / makeTemporaryName(target.path, random);
      fd = openRetrying(path_, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0666);
      if (fd >= 0 || errno != EEXIST) break;
    }
    if (fd < 0) failWriting(named_, errno);
    const Descriptor descriptor(fd);
    if (target.exists && ::fchmod(fd, target.mode) != 0) {
      const int error_number = errno;
      ::unlink(path_.c_str());
      failWriting(named_, error_number);
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!committed_) ::unlink(path_.c_str());
  }

  const fs::path& path() const { return path_; }

  /// Flushes the file to the disk, so that after a power cut the name cannot stand for an empty file, and renames it.
  void commit(std::uint64_t byte_count) {
    Descriptor file(openRetrying(path_, O_RDONLY));
    if (!file.valid()) failWriting(named_, errno, byte_count);
    // EINVAL: the file system knows no flushing; nothing is lost by not having it.
    if (::fsync(file.get()) != 0 && errno != EINVAL) failWriting(named_, errno, byte_count);
    if (const int error_number = file.close()) failWriting(named_, error_number, byte_count);
    if (::rename(path_.c_str(), target_.path.c_str()) != 0) failWriting(named_, errno, byte_count);
    committed_ = true;
    flushFolder();
  }

 private:
  /// The new name itself; best effort, as the content is safe already.
  void flushFolder() const {
    const fs::path parent = target_.path.parent_path();
    const Descriptor folder(openRetrying(parent.empty() ? fs::path(".") : parent, O_RDONLY | O_DIRECTORY));
    if (folder.valid()) static_cast<void>(::fsync(folder.get()));
  }

  WriteTarget target_;
  fs::path named_;
  fs::path path_;
  bool committed_ = false;
};

/// @param named  what messages call the file
void writeBytes(const fs::path& path, const fs::path& named, std::span<const std::byte> bytes) {
  Descriptor file(openRetrying(path, O_WRONLY));
  if (!file.valid()) failWriting(named, errno, bytes.size());
  for (std::size_t done = 0; done < bytes.size();) {
    constexpr std::size_t kMaxChunk = std::size_t{1} << 30;  // Linux writes at most 2 GiB at a time
    const ssize_t written = ::write(file.get(), bytes.data() + done, std::min(bytes.size() - done, kMaxChunk));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) failWriting(named, errno, bytes.size());
    done += static_cast<std::size_t>(written);
  }
  if (const int error_number = file.close()) failWriting(named, error_number, bytes.size());
}

[[noreturn]] void failReading(const fs::path& path, int error_number) {
  const char* advice = "check the path";
  if (error_number == EACCES) advice = "you may not read it: change its permissions";
  if (error_number == EISDIR) advice = "it is a folder: name a file in it";
  throw InputError(fmt::format("{}: cannot read: {}; {}", path.string(), describe(error_number), advice));
}

[[noreturn]] void failTooLarge(const fs::path& path, std::uint64_t found, std::uint64_t max_bytes) {
  throw InputError(fmt::format("{}: cannot read: {} bytes or more, at most {} are accepted; use a smaller file",
                               path.string(), found, max_bytes));
}

/// Reads to the end, whatever size stat() promised: files may grow, and those of /proc say 0.
std::vector<std::byte> readToEnd(int fd, const fs::path& path, std::uint64_t size, std::uint64_t max_bytes) {
  constexpr std::size_t kStep = 4096;
  std::vector<std::byte> bytes(size);
  std::size_t done = 0;
  for (;;) {
    if (done == bytes.size()) bytes.resize(done + kStep);
    const ssize_t got = ::read(fd, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) failReading(path, errno);
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
    if (done > max_bytes) failTooLarge(path, done, max_bytes);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace

std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t max_bytes) {
  // Without O_NONBLOCK, opening a FIFO would wait for a writer before we can refuse it.
  const Descriptor file(openRetrying(path, O_RDONLY | O_NONBLOCK));
  if (!file.valid()) failReading(path, errno);
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) failReading(path, errno);
  if (S_ISDIR(info.st_mode)) failReading(path, EISDIR);
  if (!S_ISREG(info.st_mode))
    throw InputError(path.string() + ": cannot read: not a regular file; copy its content to one and name that");
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size > max_bytes) failTooLarge(path, size, max_bytes);
  try {
    return readToEnd(file.get(), path, size, max_bytes);
  } catch (const std::bad_alloc&) {
    throw ResourceError(
        fmt::format("{}: cannot read: not enough memory for {} bytes; close other programs or use a "
                    "smaller file",
                    path.string(), size));
  }
}

void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const WriteTarget target = inspectTarget(path);
  if (target.special) return writeBytes(target.path, path, bytes);
  TemporaryFile temporary(target, path);
  writeBytes(temporary.path(), path, bytes);
  temporary.commit(bytes.size());
}

void writeFileAtomically(const std::filesystem::path& path,
                         const std::function<void(const std::filesystem::path&)>& write) {
  const WriteTarget target = inspectTarget(path);
  if (target.special) return write(target.path);
  TemporaryFile temporary(target, path);
  write(temporary.path());
  temporary.commit(0);
}

void checkWritable(const std::filesystem::path& path) {
  const WriteTarget target = inspectTarget(path);
  // Only making a file tells for sure: permissions say nothing of read-only mounts, quotas or virtual folders.
  if (!target.special) const TemporaryFile probe(target, path);
}

}  // namespace nephroid
