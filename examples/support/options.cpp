// SPDX-License-Identifier: MIT
#include "support/options.hpp"

#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

#include "support/named.hpp"
#include "support/stopwatch.hpp"

namespace examples {
namespace {

/// The value of at most five digits, else -1.
std::int64_t valueOf(std::string_view digits) {
  std::int64_t value = -1;
  if (digits.size() > 5 || digits.find_first_not_of("0123456789") != std::string_view::npos) return -1;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

}  // namespace

std::vector<std::int64_t> extentsOf(std::string_view option, std::string_view text,
                                    const ExtentLimits& limits) {
  std::vector<std::int64_t> extents;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('x', at), text.size());
    extents.push_back(valueOf(text.substr(at, end - at)));
    at = end + 1;
  }
  const auto isAllowed = [&](std::int64_t n) { return n >= limits.least && n <= limits.most; };
  if (extents.size() < 2 || std::ssize(extents) > limits.mostCount ||
      !std::ranges::all_of(extents, isAllowed))
    throw std::runtime_error(fmt::format("{}: '{}' is no size; write WxH{}, each from {} to {}", option, text,
                                         limits.mostCount > 2 ? " or WxHxD" : "", limits.least, limits.most));
  return extents;
}

SceneOptions::SceneOptions(CLI::App& cli, const std::string& scene, const std::string& size,
                           const ExtentLimits& limits, std::string_view example)
    : example_(example), limits_(limits) {
  cli.add_option("scene", file_, scene);
  cli.add_option("--size", size_, size);
  cli.add_option("--steps", steps_, "steps, in place of the scene's")->check(CLI::Range(1, 1'000'000'000));
}

const std::filesystem::path& SceneOptions::apply(SceneOverrides& overrides) const {
  if (file_.empty()) throw std::runtime_error(fmt::format("no scene is named; try {}", example_));
  if (!size_.empty()) overrides.size = extentsOf("--size", size_, limits_);
  overrides.steps = steps_;
  return file_;
}

RecordOptions::RecordOptions(CLI::App& cli, std::string_view columns) {
  cli.add_option("--output", output_, "a picture (.png), an animation (.apng) or a film (.gif, .mp4, .webm)");
  cli.add_option("--frames", frames_, "pictures, evenly spaced in steps")->check(CLI::Range(1, 99999));
  cli.add_option("--fields", fields_,
                 "fields of each frame for other programs: .vti (VTK), .npy (NumPy) or .raw (floats)");
  cli.add_option("--csv", csv_, fmt::format("a file for {}", columns));
}

void RecordOptions::apply(Record& record) const {
  if (output_) record.output = *output_;
  if (frames_) record.frames = *frames_;
  if (!csv_.empty()) record.csv = csv_;
  if (!fields_.empty()) record.fields = fields_;
}

StudyOptions::StudyOptions(Application& app, std::string_view purpose, std::span<const Study> studies)
    : app_(app), studies_(studies) {
  std::size_t width = 0;
  for (const Study& study : studies) width = std::max(width, study.name.size() + 1);
  app.options().add_option("--study", name_,
                           listed(fmt::format("{}, and print a table:", purpose), studies, width));
  app.options().add_flag("--small", small_, "a study in seconds, coarser");
}

void StudyOptions::run() const {
  app_.ranks().refuseSeveral("--study", "start it without mpirun");
  const Study& study = rowNamed(studies_, name_, "study");
  sk::Device device(app_.device());
  const Stopwatch watch;
  const Findings findings = study.run(device, small_);
  app_.report(fmt::format("{}: {}", study.name, study.does), device.name(), watch.milliseconds());
  fmt::print("\n{}\n", findings.table);
  app_.verified(findings.verifications);
}

}  // namespace examples
