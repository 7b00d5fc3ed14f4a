// SPDX-License-Identifier: MIT
//
// Tests the trace file alone; runtime/tests/trace_test.py tests what devices write to it.
#include "trace/trace.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include <catch2/catch.hpp>

#include "sk/error.hpp"
#include "support/process_name.hpp"

using namespace sk;

namespace {

namespace fs = std::filesystem;

class File {
 public:
  File() : name(fs::temp_directory_path() / ("sk_trace_" + std::to_string(::getpid()) + ".json")) {}
  ~File() { fs::remove(name); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  std::string text() const {
    std::ifstream in(name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t count(const std::string& part) const {
    std::size_t found = 0;
    const std::string all = text();
    for (std::size_t at = all.find(part); at != std::string::npos; at = all.find(part, at + 1)) ++found;
    return found;
  }
  bool isClosed() const { return text().ends_with("}\n]}\n"); }

  const std::string name;
};

}  // namespace

TEST_CASE("a text as a JSON string") {
  CHECK(jsonString("heat::diffuse") == "\"heat::diffuse\"");
  CHECK(jsonString("a \"b\" \\ c\n") == "\"a \\\"b\\\" \\\\ c\\u000a\"");
}

TEST_CASE("the file of a trace is whole after each write, and after the process that began it joins in") {
  const File file;
  std::ofstream(file.name) << "an older trace";
  TraceFile first(file.name);
  CHECK(file.isClosed());
  CHECK(file.count("older") == 0);
  first.append("{\"name\":\"one\"}");
  CHECK(file.isClosed());
  TraceFile second(file.name);
  const std::int64_t track = second.openTrack("a device");
  CHECK(second.openTrack("another") != track);
  first.append("{\"name\":\"two\"}");
  CHECK(file.isClosed());
  CHECK(file.count("\"process_name\"") == 1);
  CHECK(file.count("\"name\":\"one\"},\n") == 1);
  CHECK(file.count("\"name\":\"two\"}\n]}\n") == 1);
}

TEST_CASE("threads write to one file of a trace") {
  const File file;
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&] {
        TraceFile own(file.name);
        for (int i = 0; i < 200; ++i) own.append("{\"name\":\"an event\"}");
      });
    }
  }
  CHECK(file.count("{\"name\":\"an event\"}") == 800);
  CHECK(file.isClosed());
}

TEST_CASE("names of files that processes share") {
  CHECK(sk::withProcess("a%p/b%p", "7") == "a7/b7");
  CHECK(sk::withProcess("%%p %%%p 100% %d %", "7") == "%p %7 100% %d %");
  for (const char* const name : {"%p", "%%p", "100%", "%", "a, b=c", ""})
    CHECK(sk::withProcess(sk::withoutProcess(name), "7") == name);
}

TEST_CASE("%p is the number of the process") {
  const std::string expected = fs::temp_directory_path() / ("sk_" + std::to_string(::getpid()) + ".json");
  {
    const TraceFile file(fs::temp_directory_path() / "sk_%p.json");
  }
  CHECK(fs::remove(expected));
}

TEST_CASE("a file that cannot be written is an error") {
  CHECK_THROWS_WITH(
      TraceFile("/no/such/folder/trace.json"),
      "SK_TRACE: '/no/such/folder/trace.json' cannot be written: No such file or directory; name a "
      "file in a folder where you may write, or unset SK_TRACE");
  CHECK_THROWS_AS(TraceFile("/dev/full"), Error);
}

TEST_CASE("slices are told when the outermost one ends, also by an exception") {
  const File file;
  Trace trace(file.name, "a device");
  trace.setBandwidth(10);
  try {
    const TraceScope call(&trace, "call", "saxpy");
    call.add("domain", Shape{3, 4});
    {
      const TraceScope inner(&trace, "program", "compile");
      inner.add("bytes", 12);
    }
    CHECK(file.count("compile") == 0);
    throw Error("stop");
  } catch (const Error&) {
    CHECK(file.count("\"args\":{\"bytes\":12}") == 1);
    CHECK(file.count("\"args\":{\"domain\":\"{3, 4}\",\"threw\":true}") == 1);
  }
  trace.devicePass({"saxpy", "fold", "draw", "{3, 4}", 150, 50}, 1000, 1040, "wall clock");
  {
    const TraceScope nothing(nullptr, "call", "nothing");
    nothing.add("bytes", 1);
    const TraceScope end(&trace, "wait", "finish");
  }
  CHECK(file.count("\"ts\":1.000,\"dur\":0.040") == 1);
  CHECK(file.count("\"GB/s\":5,\"of copy bandwidth\":0.5") == 1);
  CHECK(file.isClosed());
}
