// SPDX-License-Identifier: MIT
#include "application/process.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"

namespace sk_tool {

namespace {

using Clock = std::chrono::steady_clock;

std::vector<std::string> environmentWith(const EnvironmentChanges& changes) {
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

}  // namespace

bool EndedProcess::isSignalled() const { return status && WIFSIGNALED(*status); }

int EndedProcess::exitStatus() const { return status && WIFEXITED(*status) ? WEXITSTATUS(*status) : 0; }

std::string EndedProcess::failure() const {
  if (!status) return fmt::format("has not ended after {:.0f} s", wall);
  if (isSignalled()) {
    const int signal = WTERMSIG(*status);
    return fmt::format("ends by signal {} ({}){}", signal, ::strsignal(signal), messages);
  }
  return exitStatus() == 0 ? "" : fmt::format("ends with status {}{}", exitStatus(), messages);
}

EndedProcess runLimited(std::vector<std::string> words, const EnvironmentChanges& changes,
                        std::chrono::duration<double> limit) {
  if (!isProgram(words.front()))
    throw std::runtime_error(
        fmt::format("there is no program '{}'; give the path of one after --", words.front()));
  const TemporaryFolder folder;
  const std::filesystem::path messages = folder.path() / "messages";
  std::vector<std::string> environment = environmentWith(changes);
  const std::vector<char*> wordPointers = pointersTo(words), environmentPointers = pointersTo(environment);
  const int file = ::open(messages.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) throw std::runtime_error(fmt::format("cannot write '{}'", messages.string()));
  const auto begin = Clock::now();
  const pid_t child = ::fork();
  if (child == 0) becomeApplication(wordPointers.data(), environmentPointers.data(), file);
  ::close(file);
  if (child < 0) throw std::runtime_error("cannot start another process: the system has no room for one");
  ::setpgid(child, child);  // by both, as either may be first
  EndedProcess ended;
  ended.status = waitFor(child, limit);
  ended.wall = std::chrono::duration<double>(Clock::now() - begin).count();
  ended.messages = lastLines(messages);
  return ended;
}

}  // namespace sk_tool
