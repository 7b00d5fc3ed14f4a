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
  return r;
}

Pictures::Pictures(const Record& record, bool writes) : record_(record), writes_(writes) {
  if (writes && isWanted() && (record.frames > 1 || record.output.extension() != ".png"))
    film_ = std::make_unique<Film>(record.output, record.framesPerSecond);
}

Pictures::~Pictures() {
  try {
    finish();
  } catch (...) {  // the error that ended the run is the one to report
  }
}

std::int64_t Pictures::nextStep(std::int64_t steps) const {
  if (record_.frames < 2 || count_ >= record_.frames) return steps;
  return steps * count_ / (record_.frames - 1);
}

bool Pictures::isDue(std::int64_t step, std::int64_t steps) const {
  return isWanted() && count_ < record_.frames && nextStep(steps) <= step;
}

void Pictures::add(const Image& image) {
  if (film_)
    film_->add(image);
  else if (writes_)
    savePng(record_.output, image);
  ++count_;
}

void Pictures::finish() {
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
  Pictures pictures(run.record, run.isFirst);
  CsvFile csv(run.record.csv, run.heads, run.isFirst);
  if (pictures.wantsStart()) pictures.add(run.picture());
  Progress progress(std::string(run.name), run.steps);
  for (std::int64_t i = 1; i <= run.steps; ++i) {
    run.step(i);
    if (csv.isWanted()) csv.add(run.row());
    if (pictures.isDue(i, run.steps)) {
      progress.clear();
      pictures.add(run.picture());
    }
    if (run.isFirst) progress.update(i);
  }
  pictures.finish();
  return pictures.count();
}

void printWritten(const Record& record, int pictures) {
  if (pictures > 0) fmt::print("wrote {}\n", record.output.string());
  if (!record.csv.empty()) fmt::print("wrote {}\n", record.csv.string());
}

}  // namespace examples
