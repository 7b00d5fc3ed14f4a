// SPDX-License-Identifier: MIT
#include "support/application.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace examples {
namespace {

/// Messages are one line of printable text, whatever was read from a file.
std::string oneLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i))
    text.replace(i, 1, "; ");
  const auto isControl = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), isControl, '?');
  return text;
}

std::string duration(double milliseconds) {
  if (milliseconds >= 1000.0) return fmt::format("{:.1f} s", milliseconds / 1000.0);
  return fmt::format("{:.{}f} ms", milliseconds, milliseconds >= 100.0 ? 0 : milliseconds >= 10.0 ? 1 : 2);
}

/// No option means NaN. Ranges let it pass, since it is neither below nor above their bounds.
void refuseNan(const CLI::App& cli) {
  for (const CLI::Option* option : cli.get_options()) {
    if (!option->get_type_name().starts_with("FLOAT")) continue;
    for (const std::string& text : option->results()) {
      if (std::isnan(std::strtod(text.c_str(), nullptr)))
        throw CLI::ValidationError(option->get_name(), fmt::format("'{}' is no number", text));
    }
  }
}

/// Nearer to its bound, or further past it.
bool closer(const Verification& a, const Verification& b) {
  const auto used = [](const Verification& v) {
    return v.passed() ? v.largest() / std::max(v.bound(), 1e-300) : 1e300;
  };
  return used(a) < used(b);
}

}  // namespace

Application::Application(std::string name, std::string purpose, std::unique_ptr<Ranks> ranks)
    : name_(std::move(name)), ranks_(std::move(ranks)), cli_(std::move(purpose), name_) {
  cli_.add_option(
      "--device", device_,
      "where to run: native, gpu, gpu:1, software, gl, or part of a renderer's name (default: the best)");
  cli_.add_option("--summary", summary_,
                  "append what was done and verified to this file, as one line with tabs");
}

void Application::report(std::string did, std::string where, double milliseconds) {
  did_ = std::move(did);
  where_ = std::move(where);
  milliseconds_ = milliseconds;
  fmt::print("{}: {} on {} in {}\n", name_, did_, where_, duration(milliseconds_));
}

void Application::verified(std::span<const Verification> verifications) {
  for (const Verification& verification : verifications) fmt::print("verified {}\n", verification.text());
  verifications_.insert(verifications_.end(), verifications.begin(), verifications.end());
}

void Application::parse(int argc, char** argv) {
  try {
    cli_.parse(argc, argv);
    refuseNan(cli_);
  } catch (const CLI::CallForHelp&) {
    throw;
  } catch (const CLI::ParseError& error) {
    throw std::runtime_error(fmt::format("{}; see {} --help", oneLine(error.what()), name_));
  }
}

/// Processes that do not know each other would all compute the whole, and write the same files.
void Application::refuseCopies() const {
  const int started = startedProcesses();
  if (started <= 1 || ranks_->count() > 1) return;
  throw std::runtime_error(fmt::format("{} processes were started, but each would compute everything: {}",
                                       started, ranks_->whyAlone()));
}

int Application::run(int argc, char** argv, const std::function<void()>& body) {
  std::string error;
  try {
    parse(argc, argv);
    refuseCopies();
    body();
    if (!summary_.empty() && ranks_->isFirst()) writeSummary();
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", cli_.help());
  } catch (const std::exception& thrown) {
    error = fmt::format("{}: {}", name_, oneLine(thrown.what()));
  }
  std::fflush(stdout);
  ranks_->end(error);
  const bool passed =
      std::all_of(verifications_.begin(), verifications_.end(), [](const auto& v) { return v.passed(); });
  return error.empty() && passed ? 0 : 1;
}

void Application::writeSummary() const {
  if (verifications_.empty()) throw std::runtime_error("nothing was verified, so there is nothing to sum up");
  const Verification& worst = *std::max_element(verifications_.begin(), verifications_.end(), closer);
  std::ofstream file(summary_, std::ios::app);
  file << fmt::format("{}\t{}\t{:.2g}\t{:.2g}\t{}\t{}\t{}\n", name_, did_, worst.largest(), worst.bound(),
                      duration(milliseconds_), worst.passed() ? "ok" : "FAILED", where_);
  if (!file.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", summary_.string()));
}

}  // namespace examples
