// SPDX-License-Identifier: MIT
//
// What a run writes while it proceeds: pictures at even intervals and rows of numbers, as a scene's [record] or the command line asks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "support/field_file.hpp"
#include "support/film.hpp"
#include "support/image.hpp"
#include "support/scene_file.hpp"

namespace examples {

struct Record {
  std::filesystem::path output;  ///< a picture, or a film if there are several frames; empty: neither
  int frames = 1;  ///< 1: the end of the run; more: evenly spaced from its start to its end
  int framesPerSecond = 25;  ///< of a film
  std::filesystem::path csv{};  ///< empty: no numbers
  std::filesystem::path
      fields{};  ///< for saveGrid(), of each frame; FILE_0000.vti and so on if there are several; empty: none
};

/// Reads output, frames, frames_per_second, csv and fields of the table [record]. `name` is the scene's; its picture is NAME.png by default.
Record readRecord(const std::optional<SceneTable>& table, std::string_view name);

/// The frames of a run: pictures in one PNG file or a film, and files of fields. A run that throws keeps the frames that were added, in
/// complete files.
class Frames {
 public:
  /// Creates the film. Throws std::runtime_error if a file cannot be written or has a wrong name. If `writes` is false, frames are counted and
  /// dropped, because another process writes them.
  explicit Frames(const Record& record, bool writes = true);
  ~Frames();
  Frames(const Frames&) = delete;
  Frames& operator=(const Frames&) = delete;

  /// False if the record has neither an output nor fields; nothing may be added then.
  bool isWanted() const { return !record_.output.empty() || !record_.fields.empty(); }
  /// Whether the start of the run is the first frame.
  bool wantsStart() const { return isWanted() && record_.frames > 1; }
  /// The step that the next frame shows, in a run of `steps` steps; `steps` after the last frame.
  std::int64_t nextStep(std::int64_t steps) const;
  /// Whether a frame is due after `step` of `steps` steps.
  bool isDue(std::int64_t step, std::int64_t steps) const;
  /// Whether all pictures go to one film.
  bool isFilm() const { return film_ != nullptr; }
  /// Adds what the record wants: a picture, fields, or both. The functions are called for these alone.
  void add(const std::function<Image()>& picture, const std::function<GridFile()>& fields);
  /// Completes the film. Throws std::runtime_error if that fails.
  void finish();
  int count() const { return count_; }

 private:
  Record record_;
  bool writes_;
  std::unique_ptr<Film> film_;
  int count_ = 0;
};

/// Lines of comma-separated values, each of which is on file when `add` returns.
class CsvFile {
 public:
  /// Creates the file, and its folder if there is none. An empty path: no file, and `add` does nothing. If `writes` is false,
  /// `add` does nothing either, because another process writes the file.
  CsvFile(const std::filesystem::path& file, std::string_view heads, bool writes = true);
  bool isWanted() const { return !name_.empty(); }
  /// Throws std::runtime_error if the file cannot be written.
  void add(std::string_view row);

 private:
  std::string name_;
  bool writes_;
  std::ofstream file_;
};

/// A run that takes its steps one by one, with what it records. On ranks other than the first, nothing is written, but all ranks
/// make rows and pictures.
struct RecordedRun {
  std::string_view name;  ///< of the bar of progress
  std::int64_t steps;
  const Record& record;
  bool isFirst;  ///< of the ranks
  std::string_view heads;  ///< of the columns of numbers
  std::function<void(std::int64_t)> step;  ///< takes the number of the step, from 1 on
  std::function<std::string()> row;  ///< numbers after a step
  std::function<Image()> picture;
  std::function<GridFile()> fields;
};

/// Runs all steps. Returns the number of frames. Throws what the functions throw; the files are complete then.
int runRecorded(const RecordedRun& run);

/// Prints which files a run wrote.
void printWritten(const Record& record, int frames);

}  // namespace examples
