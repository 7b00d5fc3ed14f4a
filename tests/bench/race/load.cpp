// SPDX-License-Identifier: MIT
#include "load.hpp"

#include <cerrno>
#include <csignal>
#include <system_error>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace race {

Load::Load(int processes) {
  const pid_t parent = getpid();
  for (int i = 0; i < processes; ++i) {
    const pid_t child = fork();
    if (child < 0) {
      const int error = errno;
      stop();
      throw std::system_error(error, std::generic_category(), "no busy process can be started");
    }
    if (child == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends with sk_race, however that ends
      if (getppid() != parent) _exit(0);
      for (volatile unsigned n = 0;;) n = n + 1;
    }
    processes_.push_back(child);
  }
}

Load::~Load() { stop(); }

void Load::stop() {
  for (const pid_t process : processes_) kill(process, SIGKILL);
  for (const pid_t process : processes_) waitpid(process, nullptr, 0);
  processes_.clear();
}

}  // namespace race
