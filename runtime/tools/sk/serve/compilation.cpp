// SPDX-License-Identifier: MIT
#include "serve/compilation.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"

namespace sk_tool {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* fileName = "program.sk";

void writeText(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error(fmt::format("'{}' cannot be written", file.string()));
}

std::string readText(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What to tell of a run that ended by a limit, or of its own fault.
std::string endOf(const ProcessResult& result, const ProcessLimits& limits) {
  using End = ProcessResult::End;
  switch (result.end) {
    case End::Exit: return result.status == 0 ? "" : "skc rejects the program without a message";
    case End::Time:
      return fmt::format("skc was stopped after {} s of CPU time; compile this program by skc itself",
                         limits.cpuSeconds);
    case End::Output: return "the program is too large for the playground; compile it by skc itself";
    case End::Signal:
      return fmt::format(
          "skc ended by signal {}; it has {} MiB here, and a program that needs more is for skc itself",
          result.status, limits.memory >> 20);
    case End::NotStarted: return "skc cannot be started";
  }
  return {};
}

bool succeeded(const ProcessResult& result) {
  return result.end == ProcessResult::End::Exit && result.status == 0;
}

json kernelsOf(const std::string& descriptors) {
  const json file = json::parse(descriptors);
  json kernels = json::array();
  for (const json& callable : file.at("callables")) {
    const json& kernel = file.at("kernels").at(callable.at("kernel").get<std::size_t>());
    json parameters = json::array();
    for (const json& parameter : kernel.at("parameters")) {
      const json& element = file.at("elements").at(parameter.at("element").get<std::size_t>());
      parameters.push_back({{"name", parameter.at("name")},
                            {"role", parameter.at("role")},
                            {"type", element.at("name")},
                            {"rank", parameter.at("rank")}});
    }
    kernels.push_back(
        {{"name", kernel.at("name")}, {"kind", callable.at("kind")}, {"parameters", parameters}});
  }
  return kernels;
}

json toJson(const std::vector<Message>& messages) {
  json list = json::array();
  for (const Message& message : messages) {
    list.push_back({{"line", message.line},
                    {"column", message.column},
                    {"severity", message.severity},
                    {"text", message.text}});
  }
  return list;
}

}  // namespace

std::vector<Message> messagesOf(std::string_view written, std::string_view file) {
  static const std::regex placed(R"((?:(\d+):(\d+): )?(?:fatal )?(error|warning|note): (.*))");
  std::vector<Message> messages;
  for (std::size_t start = 0; start < written.size();) {
    const std::size_t end = std::min(written.find('\n', start), written.size());
    std::string_view line = written.substr(start, end - start);
    start = end + 1;
    if (line.starts_with("skc: ")) {
      messages.push_back({0, 0, "error", std::string(line.substr(5))});
      continue;
    }
    if (!line.starts_with(file)) continue;   // an excerpt, or a place in the prelude
    line.remove_prefix(std::min(file.size() + 1, line.size()));
    if (line.starts_with(' ')) line.remove_prefix(1);
    line = line.substr(0, 2000);   // std::regex recurses for each character
    std::cmatch found;
    if (!std::regex_match(line.begin(), line.end(), found, placed)) continue;
    const auto number = [&](int group) { return found[group].matched ? std::stoul(found[group].str()) : 0; };
    messages.push_back({number(1), number(2), found[3].str(), found[4].str()});
  }
  return messages;
}

std::string compileForPage(const std::string& skc, const std::string& text, const ProcessLimits& limits) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / fileName;
  writeText(file, text);
  // skc names the file as it is given.
  const auto run = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {skc, "--isolated", "--color=never"});
    options.push_back(file.string());
    return runLimited(options, limits);
  };
  const ProcessResult module = run({"--emit=js", "-Wall", "-o", folder.path().string()});
  std::vector<Message> messages = messagesOf(module.messages, file.string());
  json answer;
  bool isWhole = succeeded(module);
  const auto fail = [&](const ProcessResult& result) {
    isWhole = false;
    const bool isTold =
        result.end == ProcessResult::End::Exit &&
        std::ranges::any_of(messages, [](const Message& one) { return one.severity == "error"; });
    if (!isTold) messages.push_back({0, 0, "error", endOf(result, limits)});
  };
  if (!isWhole) fail(module);
  if (isWhole) {
    const ProcessResult descriptors =
        run({"--emit=json", "--profile=webgl2", "--precision=single", "--target=fragment"});
    const ProcessResult glsl =
        run({"--emit=glsl", "--profile=webgl2", "--precision=single", "--target=fragment"});
    if (!succeeded(descriptors))
      fail(descriptors);
    else if (!succeeded(glsl))
      fail(glsl);
    else {
      answer = {{"module", readText(folder.path() / (std::string(fileName) + ".js"))},
                {"glsl", glsl.output},
                {"kernels", kernelsOf(descriptors.output)}};
    }
  }
  answer["messages"] = toJson(messages);
  return answer.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace sk_tool
