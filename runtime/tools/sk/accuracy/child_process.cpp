// SPDX-License-Identifier: MIT
#include "accuracy/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <fstream>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace sk_tool {

std::optional<int> runProgram(std::vector<std::string> words, Messages messages, const std::string& output) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  if (messages == Messages::Hidden) {
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
      ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  }
  if (!output.empty()) {
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                       0600);
  }
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return std::nullopt;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

namespace {

bool isPicture(const std::string& file) { return file.ends_with(".png"); }

[[noreturn]] void failWithoutGnuplot() {
  throw std::runtime_error(
      "there is no gnuplot to draw the chart; install it (Debian: gnuplot-nox), or take --json FILE and "
      "draw from that");
}

}  // namespace

void checkWritable(const std::string& file) {
  const std::filesystem::path path(file), parent = path.parent_path();
  std::error_code error;
  const bool isThere = std::filesystem::exists(path, error);
  const std::filesystem::path written = isThere ? path : parent.empty() ? "." : parent;
  if (std::filesystem::is_directory(path, error) || ::access(written.c_str(), W_OK) != 0)
    throw std::runtime_error(fmt::format("cannot write '{}'", file));
}

void checkChart(const std::string& file) {
  if (!isPicture(file) && !file.ends_with(".svg")) {
    throw std::runtime_error(fmt::format("no chart can be '{}': its name must end in .svg or .png", file));
  }
  checkWritable(file);
  if (!runProgram({"gnuplot", "--version"}, Messages::Hidden)) failWithoutGnuplot();
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

std::string terminalOf(const std::string& file, double width, double height) {
  return fmt::format(
      "set terminal {} size {},{} font 'sans,{}' background '#ffffff'\n"
      "set output {}\n",
      isPicture(file) ? "pngcairo noenhanced" : "svg noenhanced", width, height,
      isPicture(file) ? 9 : 12,  // points or pixels: the same size
      quoted(file));
}

void runGnuplot(const std::string& file, const std::string& script) {
  std::ofstream probe(file);
  if (!probe) throw std::runtime_error(fmt::format("cannot write '{}'", file));
  probe.close();
  const TemporaryFolder folder;
  const std::string scriptFile = (folder.path() / "chart.gnuplot").string();
  std::ofstream(scriptFile) << script;
  const std::optional<int> status = runProgram({"gnuplot", scriptFile});
  if (!status) failWithoutGnuplot();
  if (*status != 0) throw std::runtime_error("gnuplot could not draw the chart");
}

}  // namespace sk_tool
