// SPDX-License-Identifier: MIT
#include "tune/application.hpp"

#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"
#include "application/process.hpp"
#include "support/process_name.hpp"

namespace sk_tool::tune {

namespace {

std::string readAll(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads what the processes in a folder have recorded. Returns why it is of no use, or "".
std::string collect(const std::filesystem::path& folder, sk::results::Process& process) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".results") files.push_back(entry.path());
  }
  if (files.empty()) {
    return "has recorded no results: it opens no device of StreamKernel, was built with an older version of "
           "it, or ends by "
           "_exit()";
  }
  if (files.size() > 1) {
    return fmt::format("starts {} processes with devices of StreamKernel; tune one of them", files.size());
  }
  process = sk::results::fromBytes(readAll(files.front()), files.front().string());
  return {};
}

using FileTime = std::filesystem::file_time_type;

std::optional<FileTime> timeOf(const std::string& file) {
  std::error_code error;
  const FileTime time = std::filesystem::last_write_time(file, error);
  return error ? std::nullopt : std::optional(time);
}

}  // namespace

double RunResult::seconds() const {
  if (!process.hasTimes) return process.span;
  double sum = 0;
  for (const sk::results::Kernel& kernel : process.kernels) sum += kernel.seconds;
  return sum;
}

RunResult Application::run(const RunOptions& options) const {
  const TemporaryFolder folder;
  auto changes = options.environment;
  changes["SK_SHADOW"] = std::nullopt;  // records what the program reads, so that nothing is left for this
  changes["SK_RESULTS"] =
      sk::withoutProcess(folder.path().string()) + "/%p.results" + (options.measures ? ",times" : "");
  std::vector<std::optional<FileTime>> before;
  for (const ResultFile& each : files_) before.push_back(timeOf(each.file));
  const EndedProcess ended = runLimited(words_, changes, options.limit);
  RunResult result;
  result.wall = ended.wall;
  result.isTooSlow = !ended.status;
  const bool isStatusAllowed = anyStatus_ && ended.status && !ended.isSignalled();
  if (!isStatusAllowed) result.failure = ended.failure();
  if (result.failure.empty()) result.failure = collect(folder.path(), result.process);
  for (std::size_t i = 0; i < files_.size() && result.failure.empty(); ++i) {
    if (timeOf(files_[i].file) == before[i]) {
      result.failure = fmt::format("does not write '{}'", files_[i].file);
    } else {
      result.process.series.push_back(seriesOf(files_[i]));
    }
  }
  return result;
}

}  // namespace sk_tool::tune
