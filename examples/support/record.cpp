// SPDX-License-Identifier: MIT
#include "support/record.hpp"

#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "support/progress.hpp"

namespace examples {

Record readRecord(const std::optional<SceneTable>& table, std::string_view name) {
  Record r;
  r.output = fmt::format("{}.png", name);
  if (!table) return r;
  if (const auto output = table->text("output")) r.output = *output;
  table->read("frames", r.frames, Range{1, 99999});
  table->read("frames_per_second", r.framesPerSecond, Range{1, 120});
  if (const auto csv = table->text("csv")) r.csv = *csv;
  if (const auto fields = table->text("fields")) r.fields = *fields;
  return r;
}

namespace {

/// FILE_0007.vti
std::filesystem::path numbered(std::filesystem::path file, int number) {
  return file.replace_filename(
      fmt::format("{}_{:04}{}", file.stem().string(), number, file.extension().string()));
}

}  // namespace

Frames::Frames(const Record& record, bool writes) : record_(record), writes_(writes) {
  if (!record.fields.empty()) checkGridName(record.fields);
  if (writes && !record.output.empty() && (record.frames > 1 || record.output.extension() != ".png"))
    film_ = std::make_unique<Film>(record.output, record.framesPerSecond);
}

Frames::~Frames() {
  try {
    finish();
  } catch (...) {  // the error that ended the run is the one to report
  }
}

std::int64_t Frames::nextStep(std::int64_t steps) const {
  if (record_.frames < 2 || count_ >= record_.frames) return steps;
  return steps * count_ / (record_.frames - 1);
}

bool Frames::isDue(std::int64_t step, std::int64_t steps) const {
  return isWanted() && count_ < record_.frames && nextStep(steps) <= step;
}

void Frames::add(const std::function<Image()>& picture, const std::function<GridFile()>& fields) {
  if (!record_.output.empty()) {
    const Image image = picture();
    if (film_)
      film_->add(image);
    else if (writes_)
      savePng(record_.output, image);
  }
  if (!record_.fields.empty()) {
    const GridFile grid = fields();
    if (writes_) saveGrid(record_.frames > 1 ? numbered(record_.fields, count_) : record_.fields, grid);
  }
  ++count_;
}

void Frames::finish() {
  if (const std::unique_ptr<Film> film = std::move(film_); film && count_ > 0) film->finish();
}

CsvFile::CsvFile(const std::filesystem::path& file, std::string_view heads, bool writes)
    : name_(file.string()), writes_(writes) {
  if (!isWanted() || !writes_) return;
  std::error_code ignored;  // a file that cannot be written is reported by `add`
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  file_.open(file);
  add(heads);
}

void CsvFile::add(std::string_view row) {
  if (!isWanted() || !writes_) return;
  if (!(file_ << row << '\n').flush()) throw std::runtime_error(fmt::format("cannot write '{}'", name_));
}

int runRecorded(const RecordedRun& run) {
  Frames frames(run.record, run.isFirst);
  CsvFile csv(run.record.csv, run.heads, run.isFirst);
  if (frames.wantsStart()) frames.add(run.picture, run.fields);
  Progress progress(std::string(run.name), run.steps);
  for (std::int64_t i = 1; i <= run.steps; ++i) {
    run.step(i);
    if (csv.isWanted()) csv.add(run.row());
    if (frames.isDue(i, run.steps)) {
      progress.clear();
      frames.add(run.picture, run.fields);
    }
    if (run.isFirst) progress.update(i);
  }
  frames.finish();
  return frames.count();
}

void printWritten(const Record& record, int frames) {
  if (frames > 0 && !record.output.empty()) fmt::print("wrote {}\n", record.output.string());
  if (frames > 0 && !record.fields.empty()) {
    const std::filesystem::path last =
        record.frames > 1 ? numbered(record.fields, frames - 1) : record.fields;
    fmt::print("wrote {}{}\n", record.frames > 1 ? numbered(record.fields, 0).string() + " to " : "",
               last.string());
    if (last.extension() != ".vti")
      fmt::print("  with a file for each field, as in {}_u{}\n", last.stem().string(),
                 last.extension().string());
  }
  if (!record.csv.empty()) fmt::print("wrote {}\n", record.csv.string());
}

}  // namespace examples
