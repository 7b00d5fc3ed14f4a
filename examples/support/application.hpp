// SPDX-License-Identifier: MIT
//
// What the main function of every example shares: options, the report of what was verified, and one line
// on standard error with exit status 1 for every error. It starts no device and knows no kernel.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "support/ranks.hpp"
#include "support/verification.hpp"

namespace examples {

class Application {
 public:
  /// An example that computes on the ranks of MPI passes joinRanks(); others run in one process.
  Application(std::string name, std::string purpose,
              std::unique_ptr<Ranks> ranks = std::make_unique<Ranks>());

  /// For options of the example's own; --help, --device and --summary are there already.
  CLI::App& options() { return cli_; }
  /// What --device was given, to make a sk::Device from; empty for the best one.
  const std::string& device() const { return device_; }
  Ranks& ranks() { return *ranks_; }

  /// Says what the run did, where, and how long it took there, for the report and the table of demo.sh.
  void report(std::string did, std::string where, double milliseconds);
  /// Prints verifications and keeps them for the exit status.
  void verified(const Verification& verification) { verified(std::span(&verification, 1)); }
  void verified(std::span<const Verification> verifications);

  /// Parses the command line, calls `body`, turns whatever it throws into a message. Returns main's exit
  /// status: 1 after an error or where a verification missed its bound. All ranks must call it.
  int run(int argc, char** argv, const std::function<void()>& body);

 private:
  void parse(int argc, char** argv);
  void refuseCopies() const;
  void writeSummary() const;

  std::string name_;
  std::unique_ptr<Ranks> ranks_;
  CLI::App cli_;
  std::string device_;
  std::filesystem::path summary_;
  std::string did_;
  std::string where_;
  double milliseconds_ = 0.0;
  std::vector<Verification> verifications_;
};

}  // namespace examples
