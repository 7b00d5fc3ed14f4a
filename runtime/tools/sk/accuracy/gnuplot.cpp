// SPDX-License-Identifier: MIT
#include "accuracy/gnuplot.hpp"

#include <fstream>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"
#include "accuracy/temporary_folder.hpp"

namespace sk_tool {

namespace {

bool isPicture(const std::string& file) { return file.ends_with(".png"); }

}  // namespace

void checkChartName(const std::string& file) {
  if (!isPicture(file) && !file.ends_with(".svg")) {
    throw std::runtime_error(fmt::format("no chart can be '{}': its name must end in .svg or .png", file));
  }
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
  if (!status) {
    throw std::runtime_error(
        "there is no gnuplot to draw the chart; install it (Debian: gnuplot-nox), or take --json FILE and "
        "draw from that");
  }
  if (*status != 0) throw std::runtime_error("gnuplot could not draw the chart");
}

}  // namespace sk_tool
