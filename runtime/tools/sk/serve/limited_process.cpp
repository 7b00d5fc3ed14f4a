// SPDX-License-Identifier: MIT
#include "serve/limited_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sk_tool {
namespace {

using Clock = std::chrono::steady_clock;

/// A pipe whose ends are closed with it, and by exec.
struct Pipe {
  Pipe() {
    std::array<int, 2> ends{-1, -1};
    if (::pipe2(ends.data(), O_CLOEXEC) == 0) reading = ends[0], writing = ends[1];
  }
  ~Pipe() {
    closeWriting();
    if (reading >= 0) ::close(reading);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void closeWriting() {
    if (writing >= 0) ::close(writing);
    writing = -1;
  }

  int reading = -1, writing = -1;
};

void limitTo(decltype(RLIMIT_CPU) resource, rlim_t most) {
  const rlimit limit{most, most};
  ::setrlimit(resource, &limit);
}

/// What the child does between fork and exec, where only functions are allowed that signal handlers may call.
[[noreturn]] void becomeProgram(char* const* words, const ProcessLimits& limits, int output, int messages) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  limitTo(RLIMIT_CPU, static_cast<rlim_t>(limits.cpuSeconds));
  limitTo(RLIMIT_FSIZE, limits.file);
  limitTo(RLIMIT_CORE, 0);
  if (limits.memory != 0) limitTo(RLIMIT_AS, limits.memory);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing < 0 || ::dup2(nothing, STDIN_FILENO) < 0 || ::dup2(output, STDOUT_FILENO) < 0 ||
      ::dup2(messages, STDERR_FILENO) < 0) {
    ::_exit(127);
  }
  ::execv(words[0], words);
  ::_exit(127);
}

/// Reads what is there; returns false at the end of the stream.
bool readSome(int descriptor, std::string& text) {
  std::array<char, 65536> buffer;
  const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && errno == EINTR);
}

/// Reads both streams to their ends. Returns the limit that it met, or Exit.
ProcessResult::End readAll(const Pipe& output, const Pipe& messages, const ProcessLimits& limits,
                           ProcessResult& result) {
  const Clock::time_point end = Clock::now() + limits.wallTime;
  std::array<pollfd, 2> streams{pollfd{output.reading, POLLIN, 0}, pollfd{messages.reading, POLLIN, 0}};
  const std::array<std::string*, 2> texts{&result.output, &result.messages};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return ProcessResult::End::Time;
    if (::poll(streams.data(), streams.size(), static_cast<int>(left)) < 0) continue;  // a signal
    for (std::size_t i = 0; i < streams.size(); ++i) {
      if (streams[i].fd < 0 || streams[i].revents == 0) continue;
      if (!readSome(streams[i].fd, *texts[i])) streams[i].fd = -1;
      if (texts[i]->size() > limits.output) return ProcessResult::End::Output;
    }
  }
  return ProcessResult::End::Exit;
}

}  // namespace

ProcessResult runLimited(const std::vector<std::string>& words, const ProcessLimits& limits) {
  ProcessResult result;
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Pipe output, messages;
  if (output.reading < 0 || messages.reading < 0 || ::access(arguments[0], X_OK) != 0) return result;
  const pid_t child = ::fork();
  if (child < 0) return result;
  if (child == 0) becomeProgram(arguments.data(), limits, output.writing, messages.writing);
  ::setpgid(child, child);  // by both, as either may be first
  output.closeWriting();
  messages.closeWriting();
  result.end = readAll(output, messages, limits, result);
  // A program that has closed its streams may still run, and may have started others.
  if (result.end != ProcessResult::End::Exit) ::kill(-child, SIGKILL);
  // Until it is reaped, no other process group gets its number.
  siginfo_t ended;
  while (::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  ::kill(-child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (result.end != ProcessResult::End::Exit) return result;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status);
  if (WIFEXITED(status)) return result;
  // Past RLIMIT_CPU, the kernel sends SIGXCPU, or SIGKILL where soft and hard limits are one.
  const bool isTime = result.status == SIGXCPU || result.status == SIGKILL;
  result.end = result.status == SIGXFSZ ? ProcessResult::End::Output
               : isTime                 ? ProcessResult::End::Time
                                        : ProcessResult::End::Signal;
  return result;
}

}  // namespace sk_tool
