// SPDX-License-Identifier: MIT
#include "accuracy/chart.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

namespace sk_tool {

namespace {

/// As gnuplot quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

bool isPicture(const std::string& file) { return file.ends_with(".png"); }

/// An error of 0 has no logarithm: it is drawn a decade below the smallest of the others.
double floorOf(const Experiment& experiment) {
  double least = 0x1p-24;
  for (const Row& row : experiment.rows) {
    if (!row.isRefused() && row.grade.error() > 0) least = std::min(least, row.grade.error());
  }
  return least / 10;
}

/// The rows that are on the front, or those that are not: time, error, label.
std::string pointsOf(const Experiment& experiment, bool isPareto) {
  std::string points;
  for (const Row& row : experiment.rows) {
    if (row.isRefused() || row.isPareto != isPareto || !std::isfinite(row.grade.error())) continue;
    const double error = std::max(row.grade.error(), floorOf(experiment));
    fmt::format_to(std::back_inserter(points), "{} {} \"{}{}\"\n", row.time.median, std::log10(error),
                   row.mode, row.grade.error() == 0 ? " (error 0)" : "");
  }
  return points;
}

std::string panelOf(const Experiment& experiment, std::size_t number) {
  std::string script;
  std::string plots;
  const auto add = [&](const char* name, bool isPareto, const char* color) {
    const std::string points = pointsOf(experiment, isPareto);
    if (points.empty()) return;
    fmt::format_to(std::back_inserter(script), "${}{} << END\n{}END\n", name, number, points);
    fmt::format_to(
        std::back_inserter(plots),
        "{0} ${1}{2} using 1:2 with points pt 7 ps 0.8 lc rgb '{3}', ${1}{2} using 1:2:3 with labels left rotate by 25 "
        "offset 0.8,0.4 tc rgb '{3}'",
        plots.empty() ? "" : ",", name, number, color);
  };
  add("front", true, "#1b5e9b");
  add("dominated", false, "#999999");
  if (plots.empty()) plots = " NaN";
  return fmt::format("{}set title {}\nplot{}\n", script, quoted(experiment.program + ", " + experiment.data),
                     plots);
}

std::string scriptOf(const std::string& file, const std::string& device,
                     const std::vector<Experiment>& experiments) {
  const std::size_t columns = experiments.size() > 1 ? 2 : 1;
  const std::size_t rows = (experiments.size() + columns - 1) / columns;
  std::string script = fmt::format(
      "set terminal {} size {},{} font 'sans,12' background '#ffffff'\n"
      "set output {}\n"
      "set key off\nset grid lc rgb '#dddddd'\nset border 3\nset tics nomirror\n"
      "set xlabel 'time over that of the first mode'\nset ylabel 'log10 of the relative error'\n"
      "set xrange [*<0.9:1.1<*]\nset yrange [*<-8:-4<*]\n"
      "set offsets graph 0.1, graph 0.35, graph 0.15, graph 0.15\n"
      "set multiplot layout {},{} title {} noenhanced\n",
      isPicture(file) ? "pngcairo noenhanced" : "svg noenhanced", columns * 520, rows * 360 + 40,
      quoted(file), rows, columns, quoted("sk accuracy on " + device));
  for (std::size_t i = 0; i < experiments.size(); ++i) script += panelOf(experiments[i], i);
  return script + "unset multiplot\n";
}

/// A file that is gone at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : name_((std::filesystem::temp_directory_path() / "sk-chart-XXXXXX").string()) {
    const int descriptor = ::mkstemp(name_.data());
    if (descriptor < 0) throw std::runtime_error(fmt::format("cannot write a temporary file '{}'", name_));
    ::close(descriptor);
    std::ofstream(name_) << text;
  }
  ~TemporaryFile() { ::unlink(name_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::string& name() { return name_; }

 private:
  std::string name_;
};

void runGnuplot(std::string& script) {
  std::string program = "gnuplot";
  const std::array<char*, 3> arguments{program.data(), script.data(), nullptr};
  pid_t child = 0;
  if (::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) {
    throw std::runtime_error(
        "there is no gnuplot to draw the chart; install it (Debian: gnuplot-nox), or take --json FILE and "
        "draw from that");
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) throw std::runtime_error("gnuplot could not draw the chart");
}

}  // namespace

void checkChartName(const std::string& file) {
  if (!isPicture(file) && !file.ends_with(".svg")) {
    throw std::runtime_error(fmt::format("no chart can be '{}': its name must end in .svg or .png", file));
  }
}

void drawChart(const std::string& file, const std::string& device,
               const std::vector<Experiment>& experiments) {
  std::ofstream probe(file);
  if (!probe) throw std::runtime_error(fmt::format("cannot write '{}'", file));
  probe.close();
  TemporaryFile script(scriptOf(file, device, experiments));
  runGnuplot(script.name());
}

}  // namespace sk_tool
