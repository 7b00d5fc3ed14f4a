// SPDX-License-Identifier: MIT
#include "isolation.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fuzz {
namespace {

constexpr std::size_t longestLog = 6000;

/// Sends messages from a child to its parent, one per line: a letter, the input's number, a text without line breaks.
class Reporter {
 public:
  explicit Reporter(int pipe) : out_(fdopen(pipe, "w")) {}
  void tell(char what, std::uint64_t number, std::string text = {}) {
    for (char& c : text) c = c == '\n' ? '\1' : c;
    std::fprintf(out_, "%c %llu %s\n", what, static_cast<unsigned long long>(number), text.c_str());
    std::fflush(out_);
  }

 private:
  std::FILE* out_;
};

/// Ends this process by a signal after `seconds` of processor time, which does not depend on the machine's load, or after
/// ten times as long by the clock, in case it waits forever. 0 removes the limits.
void limitTime(unsigned seconds) {
  const itimerval timer{.it_interval = {}, .it_value = {.tv_sec = seconds, .tv_usec = 0}};
  setitimer(ITIMER_PROF, &timer, nullptr);
  alarm(10 * seconds);
}

#if defined(__has_feature)
#define SK_FUZZ_HAS(feature) __has_feature(feature)
#else
#define SK_FUZZ_HAS(feature) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || SK_FUZZ_HAS(address_sanitizer)
constexpr bool isSanitized = true;
#else
constexpr bool isSanitized = false;
#endif

void limitMemory(std::uint64_t megabytes) {
  if (megabytes == 0 || isSanitized) return;
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t most = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + (megabytes << 20);
  const rlimit limit{.rlim_cur = most, .rlim_max = most};
  setrlimit(RLIMIT_AS, &limit);
}

[[noreturn]] void beChild(const Campaign& campaign, std::uint64_t first, std::uint64_t end, int pipe,
                          int log) {
  dup2(log, STDERR_FILENO);
  Reporter reporter(pipe);
  limitMemory(campaign.memory);
  campaign.begin();
  for (std::uint64_t number = first; number < end; ++number) {
    reporter.tell('b', number);
    limitTime(campaign.seconds);
    const Verdict verdict = campaign.check(number);
    limitTime(0);
    if (!verdict.finding.empty()) reporter.tell('f', number, verdict.finding);
    reporter.tell('t', number, verdict.tally);
    if (verdict.endsProcess)
      std::quick_exit(0);  // without a search for leaks, which sanitizers make in _exit, too
  }
  std::exit(0);  // runs the sanitizer's leak check, unlike _exit
}

/// The last longestLog bytes of a file.
std::string tailOf(int file) {
  const off_t size = lseek(file, 0, SEEK_END);
  const auto length = std::min<std::size_t>(static_cast<std::size_t>(size), longestLog);
  std::string text(length, '\0');
  const ssize_t got = pread(file, text.data(), length, size - static_cast<off_t>(length));
  text.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return text;
}

/// How a process died; empty if it succeeded.
std::string deathOf(int status, unsigned seconds) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGPROF || signal == SIGALRM)
      return "took more than " + std::to_string(seconds) + " seconds";
    return "died by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
  }
  const int code = WEXITSTATUS(status);
  return code == 0 ? "" : "ended its process with status " + std::to_string(code);
}

class Runner {
 public:
  explicit Runner(const Campaign& campaign) : campaign_(campaign) {}

  Summary run() {
    const std::uint64_t end = campaign_.first + campaign_.count;
    for (std::uint64_t next = campaign_.first; next < end;) {
      next = batch(next, std::min(next + campaign_.batch, end));
    }
    return std::move(summary_);
  }

 private:
  /// Runs the inputs [first, end) until the child ends. Returns the first input that is still to do.
  std::uint64_t batch(std::uint64_t first, std::uint64_t end) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
    std::FILE* log = std::tmpfile();
    if (log == nullptr) throw std::runtime_error(std::string("tmpfile: ") + std::strerror(errno));
    std::cout.flush();
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
    if (child == 0) {
      close(ends[0]);
      beChild(campaign_, first, end, ends[1], fileno(log));
    }
    close(ends[1]);
    std::uint64_t current = first;
    bool isDone = false;
    listen(ends[0], current, isDone);
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    summary_.largestProcess = std::max<std::int64_t>(summary_.largestProcess, usage.ru_maxrss);
    const std::string death = deathOf(status, campaign_.seconds);
    if (!death.empty()) {
      const bool isAfterLast = isDone && current + 1 == end;
      if (!isDone) ++summary_.inputs;
      find({current, death + (isAfterLast ? ", after the last input of its process" : ""),
            tailOf(fileno(log))});
    }
    std::fclose(log);
    return current + 1;
  }

  /// Reads the child's messages until it closes the pipe.
  void listen(int pipe, std::uint64_t& current, bool& isDone) {
    std::FILE* in = fdopen(pipe, "r");
    char* line = nullptr;
    std::size_t capacity = 0;
    for (ssize_t length = 0; (length = getline(&line, &capacity, in)) > 0;) {
      std::istringstream words(std::string(line, static_cast<std::size_t>(length) - 1));
      char what = 0;
      std::string text;
      words >> what >> current;
      words.get();
      std::getline(words, text);
      for (char& c : text) c = c == '\1' ? '\n' : c;
      isDone = what == 't';
      if (what == 'f') find({current, text, {}});
      if (what != 't') continue;
      ++summary_.inputs;
      if (!text.empty()) ++summary_.tallies[text];
    }
    std::free(line);
    std::fclose(in);
  }

  void find(const Finding& finding) {
    ++summary_.findings;
    campaign_.onFinding(finding);
  }

  const Campaign& campaign_;
  Summary summary_;
};

}  // namespace

Summary run(const Campaign& campaign) { return Runner(campaign).run(); }

}  // namespace fuzz
