// SPDX-License-Identifier: MIT
//
// `sk shadow`: reads the report of a run with SK_SHADOW, prints it, and writes its page again.
#include "commands.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "shadow/entry.hpp"
#include "shadow/report_page.hpp"
#include "shadow/report_text.hpp"

namespace sk_tool {

namespace {

constexpr std::string_view shadowFormat = "streamkernel-shadow";
constexpr int shadowVersion = 1;

struct ShadowOptions {
  std::string file, kernel, page;
  bool isAll = false;
};

std::string textOfFile(const std::string& file) {
  if (!std::filesystem::exists(file)) throw std::runtime_error(fmt::format("there is no file '{}'", file));
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw std::runtime_error(fmt::format("cannot read '{}'", file));
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Parses JSON. Throws std::runtime_error if the text is no JSON, or ends too early.
nlohmann::ordered_json parsed(const std::string& text, const std::string& file) {
  if (text.starts_with("<!"))
    throw std::runtime_error(fmt::format("'{}' is a page; give its report, the .json file beside it", file));
  try {
    return nlohmann::ordered_json::parse(text);
  } catch (const nlohmann::ordered_json::parse_error& error) {
    if (error.byte > text.size() || text.empty()) {
      throw std::runtime_error(fmt::format(
          "'{}' is cut off: the program that wrote it was ended meanwhile, or still writes; run it again",
          file));
    }
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(error.byte);
    const auto line = std::count(text.begin(), end, '\n') + 1;
    throw std::runtime_error(fmt::format("'{}' is no JSON, from line {} on", file, line));
  }
}

void checkFormat(const nlohmann::ordered_json& report, const std::string& file) {
  const bool hasFormat = report.is_object() && report.contains("format") && report["format"] == shadowFormat;
  if (!hasFormat)
    throw std::runtime_error(fmt::format(
        "'{}' is no report of SK_SHADOW, which begins with \"format\": \"{}\"", file, shadowFormat));
  const auto version = report.find("version");
  if (version == report.end() || *version != shadowVersion) {
    throw std::runtime_error(fmt::format(
        "'{}' has version {} of the report, and this sk reads version {}; use the sk of the "
        "StreamKernel that the program was built with",
        file, version != report.end() && version->is_number() ? version->dump() : "?", shadowVersion));
  }
}

void writePage(const std::string& file, const std::string& json) {
  std::ofstream stream(file, std::ios::binary);
  stream << sk::shadow::reportPage(json) << std::flush;
  if (!stream) throw std::runtime_error(fmt::format("cannot write '{}'", file));
}

void runShadow(const ShadowOptions& options) {
  const std::string text = textOfFile(options.file);
  const nlohmann::ordered_json report = parsed(text, options.file);
  checkFormat(report, options.file);
  const std::size_t most = options.isAll ? std::numeric_limits<std::size_t>::max() / 4 : 20;
  const Entry root(report);
  std::string tables;
  try {
    tables = shadowText(root, most);  // also if one kernel is wanted: a damaged report is not shown in part
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("'{}' is damaged: {}", options.file, error.what()));
  }
  if (!options.kernel.empty()) tables = shadowKernelText(root, options.kernel, most);
  fmt::print("{}", tables);
  if (!options.page.empty()) writePage(options.page, text);
}

}  // namespace

void addShadow(CLI::App& app) {
  CLI::App* command = app.add_subcommand("shadow", "Print the report of a program that ran with SK_SHADOW");
  auto options = std::make_shared<ShadowOptions>();
  command->add_option("file", options->file, "The report, which SK_SHADOW=report.html writes beside its page")
      ->type_name("report.json")
      ->required();
  command->add_option("--kernel", options->kernel, "Show all that the report has of this kernel")
      ->type_name("NAME");
  command->add_flag("--all", options->isAll, "Show all rows of each table (default: the first 20)");
  command->add_option("--html", options->page, "Also write the report's page")->type_name("FILE");
  command->callback([options] { runShadow(*options); });
}

}  // namespace sk_tool
