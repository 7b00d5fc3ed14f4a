// SPDX-License-Identifier: MIT
#include "results.hpp"

#include <cmath>
#include <fstream>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

namespace race {
namespace {

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

nlohmann::json resultsOf(const Session& session, const std::string& renderer) {
  nlohmann::json runs = nlohmann::json::array();
  for (const Run& run : session.runs()) {
    const Work work = run.program->work(std::ldexp(1.0, run.log2));
    runs.push_back({{"program", run.program->name},
                    {"log2", run.log2},
                    {"element", run.program->element},
                    {"operations", work.operations},
                    {"bytes", work.bytes},
                    {"contender", run.contender},
                    {"ours", run.isOurs},
                    {"seconds", run.seconds}});
  }
  nlohmann::json absent = nlohmann::json::array();
  for (const Absence& a : session.absences()) {
    absent.push_back({{"program", a.program},
                      {"log2", a.log2},
                      {"contender", a.contender},
                      {"why", a.why},
                      {"wrong", a.isWrong}});
  }
  return {{"machine",
           {{"processor", processorName()},
            {"threads", std::thread::hardware_concurrency()},
            {"renderer", renderer}}},
          {"runs", std::move(runs)},
          {"absent", std::move(absent)}};
}

}  // namespace race
