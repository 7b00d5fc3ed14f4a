// SPDX-License-Identifier: MIT
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "results/recorder.hpp"
#include "results/results_file.hpp"
#include "sk/call.hpp"
#include "sk/device.hpp"
#include "sk/types.hpp"

namespace {

using sk::results::fromBytes;
using sk::results::Process;
using sk::results::Recorder;
using sk::results::Series;
using sk::results::toBytes;
using sk::results::Values;

struct ResultsFile {
  ResultsFile() {
    std::string name = (std::filesystem::temp_directory_path() / "sk-results-XXXXXX").string();
    ::close(::mkstemp(name.data()));
    path = name;
    std::filesystem::remove(path);
  }
  ~ResultsFile() { std::filesystem::remove(path); }

  Process read() const {
    std::ifstream in(path, std::ios::binary);
    return fromBytes(std::string(std::istreambuf_iterator<char>(in), {}), path);
  }

  std::string path;
};

template <class T>
void addTo(Recorder& recorder, const std::string& name, T value) {
  recorder.addValue(name, sk::ElementTraits<T>::element(), reinterpret_cast<const std::byte*>(&value));
}

/// Records calls of a kernel that take these seconds, and returns the seconds that the file has for the kernel.
double secondsOf(const std::string& setting, const ResultsFile& file, std::initializer_list<int> calls) {
  Recorder recorder(file.path + setting);
  const sk::Device device = sk::Device::native();
  sk::program::Kernel kernel{};
  kernel.name = "warm";
  recorder.addCall(sk::detail::deviceStateOf(device), kernel, nullptr, {}, {});
  for (const int seconds : calls) recorder.addTime("warm", 0, seconds * Recorder::Time{1'000'000'000}, true);
  recorder.write();
  return file.read().kernels.at(0).seconds;
}

std::string whyUnreadable(std::string_view bytes) {
  try {
    fromBytes(bytes, "file");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("recorded results are read as they were written") {
  Process process;
  process.devices = {{"native", false, true}};
  process.series = {
      {.name = "u", .reads = 1, .hash = 7, .first = {{Values::Kind::Double, std::string(16, '\1')}}}};
  process.kernels = {{.name = "heat::diffuse",
                      .calls = 3,
                      .seconds = 0.5,
                      .whyNotHalf = "it shifts bits",
                      .used = {"precision double"}}};
  process.streams = {{"u", "half", 1, 64}};
  process.notes = {"a note"};
  process.span = 2;
  const std::string bytes = toBytes(process);
  const Process read = fromBytes(bytes, "file");
  CHECK(toBytes(read) == bytes);
  CHECK(read.kernels.at(0).used == std::vector<std::string>{"precision double"});
  CHECK(read.series.at(0).first.at(0).count() == 2);
}

TEST_CASE("damaged results are refused") {
  Process process;
  process.notes = {"some text"};
  const std::string bytes = toBytes(process);
  CHECK(whyUnreadable("GIF89a") ==
        "'file' holds no results of this version of StreamKernel; build the program with it");
  for (std::size_t size = 30; size < bytes.size(); ++size) {
    CHECK(whyUnreadable(bytes.substr(0, size)) == "'file' is incomplete or damaged");
  }
  for (std::size_t at = 23; at < bytes.size(); at += 3) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x55);
    CHECK(whyUnreadable(changed) == "'file' is incomplete or damaged");
  }
}

TEST_CASE("the first and the last reads of each name are kept, and all are counted") {
  const ResultsFile file;
  Recorder recorder(file.path);
  for (int i = 0; i < 20; ++i) addTo(recorder, "sum", static_cast<float>(i));
  addTo(recorder, "count", std::int32_t{-5});
  addTo(recorder, "large", std::uint64_t{1} << 40);
  addTo(recorder, "at", sk::double2{0.5, -2});
  addTo(recorder, "level", sk::unorm8(1.0f));
  recorder.write();
  const Process process = file.read();
  REQUIRE(process.series.size() == 5);
  const Series& sum = process.series[0];
  CHECK(sum.name == "sum");
  CHECK(sum.reads == 20);
  REQUIRE(sum.first.size() == 4);
  REQUIRE(sum.last.size() == 4);
  CHECK(sum.first[3].at(0) == 3);
  CHECK(sum.last[0].at(0) == 16);
  CHECK(sum.last[3].at(0) == 19);
  CHECK(process.series[1].first[0].kind == Values::Kind::Integer);
  CHECK(process.series[1].first[0].integerAt(0) == -5);
  CHECK(process.series[2].first[0].integerAt(0) == std::int64_t{1} << 40);
  CHECK(process.series[3].first[0].at(1) == -2);
  CHECK(process.series[4].first[0].at(0) == 1);
}

TEST_CASE("a read in the middle changes the hash of its name") {
  const auto hashWith = [](float fifth) {
    const ResultsFile file;
    Recorder recorder(file.path);
    for (int i = 0; i < 20; ++i) addTo(recorder, "sum", i == 5 ? fifth : 1.0f);
    recorder.write();
    return file.read().series.at(0).hash;
  };
  CHECK(hashWith(1) == hashWith(1));
  CHECK(hashWith(1) != hashWith(2));
}

TEST_CASE("reads beyond the limit are left out, and the file says so") {
  const ResultsFile file;
  constexpr std::uint64_t limit = 6 * sizeof(double);
  Recorder recorder(file.path, limit);
  for (int i = 0; i < 7; ++i) addTo(recorder, "sum", static_cast<float>(i));
  addTo(recorder, "late", 1.0f);
  recorder.write();
  const Process process = file.read();
  CHECK(process.series.at(0).first.size() + process.series.at(0).last.size() == 6);
  CHECK(process.series.at(0).last.back().at(0) == 6);  // the last ones are more telling
  CHECK(process.series.at(1).droppedBytes == sizeof(float));
  REQUIRE(process.notes.size() == 2);
  CHECK(process.notes[1] == "4 byte(s) of 'late' are left out, because results end at 0 MiB");
}

TEST_CASE("the limit leaves out the same reads of floats as of doubles") {
  const auto keptOf = [](auto value) {
    const ResultsFile file;
    Recorder recorder(file.path, 3 * sizeof(double));
    for (const char* name : {"u", "v", "u", "v"}) addTo(recorder, name, value);
    recorder.write();
    std::vector<std::size_t> kept;
    for (const Series& series : file.read().series) kept.push_back(series.first.size() + series.last.size());
    return kept;
  };
  CHECK(keptOf(1.0f) == std::vector<std::size_t>{2, 1});
  CHECK(keptOf(1.0) == keptOf(1.0f));
}

TEST_CASE(
    "the first call of a kernel, which builds programs, counts as the mean of the others where calls are "
    "queued") {
  const ResultsFile file;
  CHECK(secondsOf(",times", file, {9, 1, 3}) == Approx(6));
  CHECK(secondsOf(",times", file, {9}) == Approx(9));
  CHECK(secondsOf("", file, {9, 1, 3}) == Approx(13));
}

TEST_CASE("the child of a fork writes no file") {
  const ResultsFile file;
  Recorder recorder(file.path);
  addTo(recorder, "sum", 1.0f);
  const pid_t child = ::fork();
  if (child == 0) {
    addTo(recorder, "sum", 2.0f);
    recorder.write();
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  CHECK_FALSE(std::filesystem::exists(file.path));
  recorder.write();
  CHECK(file.read().series.at(0).reads == 1);
}

TEST_CASE("results that cannot be written are lost without an error") {
  Recorder recorder("/nowhere/results");
  addTo(recorder, "sum", 1.0f);
  recorder.write();
  CHECK_FALSE(std::filesystem::exists("/nowhere/results"));
}
