// SPDX-License-Identifier: MIT
//
// Each write overwrites the closing brackets and appends them again. The head identifies the process that
// began the file.
#include "trace/trace_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>
#include <sstream>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>

#include "sk/error.hpp"
#include "support/process_name.hpp"

namespace sk {

namespace {

constexpr std::string_view tail = "\n]}\n";

/// The first track number: above all thread ids (PID_MAX_LIMIT of Linux).
constexpr std::int64_t firstTrack = 1 << 22;

/// The start time of this process, in ticks since boot: the 20th word after the process name in parentheses.
std::string startOfProcess() {
  std::ifstream in("/proc/self/stat");
  const std::string line(std::istreambuf_iterator<char>(in), {});
  std::istringstream words(line.substr(std::min(line.rfind(')') + 1, line.size())));
  std::string word;
  for (int i = 0; i < 20; ++i) words >> word;
  return word;
}

std::string headOfProcess() {
  return fmt::format(
      "{{\"displayTimeUnit\":\"ns\",\"otherData\":{{\"process\":\"{} {}\"}},\"traceEvents\":[\n"
      "{{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":{},\"args\":{{\"name\":{}}}}}",
      ::getpid(), startOfProcess(), ::getpid(), jsonString(program_invocation_short_name));
}

/// Locks the file against other threads and processes, if the file system supports it.
class Lock {
 public:
  explicit Lock(int file) : file_(file) { ::flock(file_, LOCK_EX); }
  ~Lock() { ::flock(file_, LOCK_UN); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int file_;
};

bool writeAt(int file, off_t place, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::pwrite(file, text.data(), text.size(), place);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    place += written;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// The bytes of the character in UTF-8 at the beginning of a text; 0 if there is none.
std::size_t characterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80   ? 1
                             : byte(0) < 0xC2 ? 0
                             : byte(0) < 0xE0 ? 2
                             : byte(0) < 0xF0 ? 3
                             : byte(0) < 0xF5 ? 4
                                              : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return length;
}

}  // namespace

std::string jsonString(std::string_view text) {
  std::string json = "\"";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (static_cast<unsigned char>(c) >= 0x80) {
      const std::size_t length = characterLength(text.substr(i));
      json += length == 0 ? std::string_view("\\ufffd") : text.substr(i, length);
      i += std::max<std::size_t>(length, 1) - 1;
      continue;
    }
    if (c == '"' || c == '\\') {
      json += {'\\', c};
    } else if (static_cast<unsigned char>(c) < ' ') {
      json += fmt::format("\\u{:04x}", c);
    } else {
      json += c;
    }
  }
  return json + '"';
}

TraceFile::TraceFile(const std::string& name)
    : name_(withProcess(name, std::to_string(::getpid()))),
      file_(::open(name_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (file_ >= 0) begin();
  if (file_ >= 0 && failure_.empty()) return;
  const std::string why = file_ < 0 ? std::strerror(errno) : failure_;
  if (file_ >= 0) ::close(file_);
  throw Error(
      fmt::format("SK_TRACE: '{}' cannot be written: {}; name a file in a folder where you may write, "
                  "or unset SK_TRACE",
                  name_, why),
      Error::Kind::File);
}

TraceFile::~TraceFile() { ::close(file_); }

void TraceFile::begin() {
  const std::string head = headOfProcess();
  const Lock lock(file_);
  std::string found(head.size(), '\0');
  const ssize_t size = ::pread(file_, found.data(), found.size(), 0);
  if (size == static_cast<ssize_t>(head.size()) && found == head) return;
  if (::ftruncate(file_, 0) != 0 || !writeAt(file_, 0, head + std::string(tail))) {
    failure_ = std::strerror(errno);
  }
}

std::int64_t TraceFile::openTrack(std::string_view name) {
  const Lock lock(file_);
  const std::int64_t number = firstTrack + ::lseek(file_, 0, SEEK_END);
  put(fmt::format(R"({{"name":"thread_name","ph":"M","pid":{},"tid":{},"args":{{"name":{}}}}})", ::getpid(),
                  number, jsonString(name)));
  return number;
}

void TraceFile::append(std::string_view events) noexcept {
  if (!failure_.empty() || events.empty()) return;
  const Lock lock(file_);
  try {
    put(events);
  } catch (const std::bad_alloc&) {
    return;  // these events are lost
  }
}

void TraceFile::put(std::string_view events) {
  const off_t end = ::lseek(file_, 0, SEEK_END) - static_cast<off_t>(tail.size());
  if (writeAt(file_, end, fmt::format(",\n{}{}", events, tail))) return;
  const int why = errno;
  if (::ftruncate(file_, end) == 0) writeAt(file_, end, tail);
  failure_ = fmt::format("SK_TRACE: '{}' cannot be written any more: {}; what was traced before is in it",
                         name_, std::strerror(why));
}

}  // namespace sk
