// SPDX-License-Identifier: MIT
#include "tune/application.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"

namespace sk_tool::tune {

namespace {

using Clock = std::chrono::steady_clock;

std::vector<std::string> environmentWith(const std::map<std::string, std::optional<std::string>>& changes) {
  std::vector<std::string> all;
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string_view text = *each;
    if (!changes.contains(std::string(text.substr(0, text.find('='))))) all.emplace_back(text);
  }
  for (const auto& [name, value] : changes) {
    if (value) all.push_back(name + "=" + *value);
  }
  return all;
}

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// What the child does between fork and exec, where only functions are allowed that signal handlers may call. Ends with the
/// status of a shell that finds no program.
[[noreturn]] void becomeApplication(char* const* words, char* const* environment, int messages) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int input = ::open("/dev/null", O_RDONLY);
  const int output = ::open("/dev/null", O_WRONLY);
  if (input >= 0 && output >= 0 && ::dup2(input, STDIN_FILENO) >= 0 && ::dup2(output, STDOUT_FILENO) >= 0 &&
      ::dup2(messages, STDERR_FILENO) >= 0) {
    ::execvpe(words[0], words, environment);
  }
  ::_exit(127);
}

/// Waits for a child until the limit, and ends it and what it has started there. Returns its status; nullopt at the limit.
std::optional<int> waitFor(pid_t child, std::chrono::duration<double> limit) {
  const auto end = Clock::now() + limit;
  int status = 0;
  for (auto pause = std::chrono::microseconds(500);;) {
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return std::nullopt;
    if (Clock::now() > end) break;
    std::this_thread::sleep_for(pause);
    pause = std::min(pause * 2, std::chrono::microseconds(10'000));
  }
  ::kill(-child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return std::nullopt;
}

/// The end of the file of messages, as lines to be printed below a message; "" if there are none.
std::string lastLines(const std::filesystem::path& file) {
  constexpr std::streamoff most = 4096;
  constexpr std::size_t lines = 5;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(size - most, 0));
  std::string text(std::istreambuf_iterator<char>(in), {});
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::size_t first = text.size();
  for (std::size_t i = 0; i < lines && first != std::string::npos && first > 0; ++i)
    first = text.rfind('\n', first - 1);
  if (first != std::string::npos && first < text.size())
    text.erase(0, text[first] == '\n' ? first + 1 : first);
  std::string result = text.empty() ? "" : "\n  ";
  for (const char c : text) result += c == '\n' ? std::string("\n  ") : std::string(1, c);
  return result;
}

std::string failureOf(int status, bool anyStatus, const std::filesystem::path& messages) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return fmt::format("ends by signal {} ({}){}", signal, ::strsignal(signal), lastLines(messages));
  }
  if (WEXITSTATUS(status) == 0 || anyStatus) return {};
  return fmt::format("ends with status {}{}", WEXITSTATUS(status), lastLines(messages));
}

/// Whether a program is found as execvp finds it.
bool isProgram(const std::string& name) {
  if (name.find('/') != std::string::npos) return ::access(name.c_str(), X_OK) == 0;
  const char* const path = std::getenv("PATH");
  std::string folder;
  for (const char c : std::string(path == nullptr ? "/usr/bin:/bin" : path) + ":") {
    if (c != ':') {
      folder += c;
      continue;
    }
    if (::access((folder + "/" + name).c_str(), X_OK) == 0) return true;
    folder.clear();
  }
  return false;
}

std::string readAll(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads what the processes in a folder have recorded. Returns why it is of no use, or "".
std::string collect(const std::filesystem::path& folder, sk::results::Process& process) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".results") files.push_back(entry.path());
  }
  if (files.empty()) {
    return "has recorded no results: it opens no device of StreamKernel, was built with an older version of "
           "it, or ends by "
           "_exit()";
  }
  if (files.size() > 1) {
    return fmt::format("starts {} processes with devices of StreamKernel; tune one of them", files.size());
  }
  process = sk::results::fromBytes(readAll(files.front()), files.front().string());
  return {};
}

using FileTime = std::filesystem::file_time_type;

std::optional<FileTime> timeOf(const std::string& file) {
  std::error_code error;
  const FileTime time = std::filesystem::last_write_time(file, error);
  return error ? std::nullopt : std::optional(time);
}

}  // namespace

double RunResult::seconds() const {
  if (!process.hasTimes) return process.span;
  double sum = 0;
  for (const sk::results::Kernel& kernel : process.kernels) sum += kernel.seconds;
  return sum;
}

RunResult Application::run(const RunOptions& options) const {
  if (!isProgram(words_.front()))
    throw std::runtime_error(fmt::format("there is no program {}; give the path of one after --", name()));
  const TemporaryFolder folder;
  const std::filesystem::path messages = folder.path() / "messages";
  auto changes = options.environment;
  changes["SK_RESULTS"] = (folder.path() / "%p.results").string() + (options.measures ? ",times" : "");
  std::vector<std::string> environment = environmentWith(changes), words = words_;
  const std::vector<char*> wordPointers = pointersTo(words), environmentPointers = pointersTo(environment);
  const int file = ::open(messages.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) throw std::runtime_error(fmt::format("cannot write '{}'", messages.string()));
  std::vector<std::optional<FileTime>> before;
  for (const ResultFile& each : files_) before.push_back(timeOf(each.file));
  const auto begin = Clock::now();
  const pid_t child = ::fork();
  if (child == 0) becomeApplication(wordPointers.data(), environmentPointers.data(), file);
  ::close(file);
  if (child < 0) throw std::runtime_error("cannot start another process: the system has no room for one");
  ::setpgid(child, child);  // by both, as either may be first
  const std::optional<int> status = waitFor(child, options.limit);
  RunResult result;
  result.wall = std::chrono::duration<double>(Clock::now() - begin).count();
  result.isTooSlow = !status;
  result.failure = status ? failureOf(*status, anyStatus_, messages)
                          : fmt::format("has not ended after {:.0f} s", options.limit.count());
  if (result.failure.empty()) result.failure = collect(folder.path(), result.process);
  for (std::size_t i = 0; i < files_.size() && result.failure.empty(); ++i) {
    if (timeOf(files_[i].file) == before[i]) {
      result.failure = fmt::format("does not write '{}'", files_[i].file);
    } else {
      result.process.series.push_back(seriesOf(files_[i]));
    }
  }
  return result;
}

}  // namespace sk_tool::tune
