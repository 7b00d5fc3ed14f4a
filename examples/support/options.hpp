// SPDX-License-Identifier: MIT
//
// Options that several examples have: a scene and what stands in place of its keys, what a run records, and studies. Objects that add options
// must outlive the parsing.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>

#include "support/application.hpp"
#include "support/record.hpp"
#include "support/scene_file.hpp"
#include "support/study.hpp"

namespace examples {

/// The extents of grids and pictures that an option accepts: "256x128" and "64x64x64".
struct ExtentLimits {
  std::int64_t least, most;  ///< of each extent, both included; most: at most 99999
  int mostCount = 2;  ///< 2: WxH; 3: WxH or WxHxD
};

/// The extents in `text`. Throws std::runtime_error, "OPTION: 'TEXT' is no size; write WxH, each from 2 to 16384".
std::vector<std::int64_t> extentsOf(std::string_view option, std::string_view text,
                                    const ExtentLimits& limits);

/// Adds an option that takes one of `names`: of precisionNames, or of all enumerators in their order.
template <class Enum>
void addChoice(CLI::App& cli, const std::string& option, std::optional<Enum>& value,
               std::span<const std::string_view> names, const std::string& help) {
  const auto take = [&value, names](const std::string& name) {
    if constexpr (std::is_same_v<Enum, sk::Precision>)
      value = precisionNamed(name);
    else
      value = static_cast<Enum>(std::ranges::find(names, name) - names.begin());
  };
  cli.add_option_function<std::string>(option, take, help)
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
}

/// The scene, and the options --size and --steps, which take precedence over it.
class SceneOptions {
 public:
  /// `scene` and `size` are the help of two of them; `example` is a scene to try.
  SceneOptions(CLI::App& cli, const std::string& scene, const std::string& size, const ExtentLimits& limits,
               std::string_view example);
  /// Sets what was given, and returns the file. Throws std::runtime_error if no scene is named, or as extentsOf() does.
  const std::filesystem::path& apply(SceneOverrides& overrides) const;

 private:
  std::filesystem::path file_;
  std::string size_, example_;
  ExtentLimits limits_;
  std::optional<std::int64_t> steps_;
};

/// The options --output, --frames, --fields and --csv, which take precedence over the scene.
class RecordOptions {
 public:
  /// `columns` describes the file of --csv.
  RecordOptions(CLI::App& cli, std::string_view columns);
  void apply(Record& record) const;

 private:
  std::optional<std::filesystem::path> output_;
  std::optional<int> frames_;
  std::filesystem::path csv_;
  std::filesystem::path fields_;
};

/// The options --study and --small of a program, and the study that they select.
class StudyOptions {
 public:
  /// `purpose` precedes the list of studies in --help. The application and the studies must outlive this object.
  StudyOptions(Application& app, std::string_view purpose, std::span<const Study> studies);

  /// Whether the command line names a study.
  bool isGiven() const { return !name_.empty(); }
  /// Runs the named study on the application's device, prints its tables, and passes its verifications to the application.
  /// Throws std::runtime_error if there are several ranks, or, listing the names, if no study has the name.
  void run() const;

 private:
  Application& app_;
  std::span<const Study> studies_;
  std::string name_;
  bool small_ = false;
};

}  // namespace examples
