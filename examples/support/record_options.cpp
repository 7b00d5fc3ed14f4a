// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "support/record.hpp"

namespace examples {

RecordOptions::RecordOptions(CLI::App& cli, std::string_view columns) {
  cli.add_option("--output", output_, "a picture (.png), an animation (.apng) or a film (.gif, .mp4, .webm)");
  cli.add_option("--frames", frames_, "pictures, evenly spaced in steps")->check(CLI::Range(1, 99999));
  cli.add_option("--csv", csv_, fmt::format("a file for {}", columns));
}

void RecordOptions::apply(Record& record) const {
  if (output_) record.output = *output_;
  if (frames_) record.frames = *frames_;
  if (!csv_.empty()) record.csv = csv_;
}

}  // namespace examples
