// SPDX-License-Identifier: MIT
#include "driver/crash_report.hpp"

#include <csignal>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>

#include <sys/resource.h>
#include <unistd.h>

#include "native/native.hpp"
#include "support/internal_error.hpp"

namespace skc::driver {
namespace {

#if defined(__has_feature)
#define SK_HAS_SANITIZER __has_feature(address_sanitizer)
#else
#define SK_HAS_SANITIZER 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || SK_HAS_SANITIZER
constexpr bool isSanitized = true;
#else
constexpr bool isSanitized = false;
#endif

constexpr int signals[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
constexpr std::size_t longestCommand = 2000;

// Read by the handler, which can neither allocate nor trust the stack.
std::string* advice = nullptr;
bool keepsSignal = false;

void print(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

const char* nameOf(int signal) {
  switch (signal) {
    case SIGSEGV: return "segmentation fault, or no stack left";
    case SIGBUS: return "bus error";
    case SIGILL: return "illegal instruction";
    case SIGFPE: return "arithmetic error";
    default: return "aborted";
  }
}

void onCrash(int signal) {
  if (!isInternalErrorPrinted()) {
    print("skc: internal error: ");
    print(nameOf(signal));
    print("\n");
  }
  if (*currentActivity() != '\0') {
    print("while doing: ");
    print(currentActivity());
    print("\n");
  }
  print(*advice);
  if (!keepsSignal) _exit(1);
  std::signal(signal, SIG_DFL);
  raise(signal);
}

[[noreturn]] void onNoMemory() {
  print("skc: this takes more memory than there is\n");
  _exit(1);
}

/// Memory that macros or templates explode in would otherwise be all that the machine has.
void limitMemory() {
  constexpr rlim_t most = rlim_t{8} << 30;
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur <= most) return;
  limit.rlim_cur = most;
  setrlimit(RLIMIT_AS, &limit);
}

std::string commandOf(int argc, const char* const* argv) {
  std::string command = "skc";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  if (command.size() > longestCommand) command.replace(longestCommand, std::string::npos, " ...");
  return command;
}

}  // namespace

void reportCrashes(int argc, const char* const* argv) {
  if (isSanitized) return;
  const char* const wanted = std::getenv("SKC_CRASH");
  keepsSignal = wanted != nullptr && std::string_view(wanted) == "signal";
  static std::string text =
      "This is a bug of skc " SKC_VERSION
      ", not of your program. Please report it with the .sk file and this command:\n  " +
      commandOf(argc, argv) + "\n'--print-after=all' adds the module as it was after each transform.\n";
  advice = &text;
  limitMemory();
  std::set_new_handler(onNoMemory);
  native::setNoMemoryHandler(onNoMemory);
  static char stack[1 << 16];   // a crash may be that the other one is full
  stack_t alternative{};
  alternative.ss_sp = stack;
  alternative.ss_size = sizeof stack;
  sigaltstack(&alternative, nullptr);
  struct sigaction action{};
  action.sa_handler = onCrash;
  action.sa_flags = SA_ONSTACK;
  for (const int signal : signals) sigaction(signal, &action, nullptr);
}

}  // namespace skc::driver
