// SPDX-License-Identifier: MIT
//
// Parses the options of `sk info`, selects devices and caches their reports.
#include "commands.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "info/device_info.hpp"
#include "info/missing_gpu.hpp"
#include "info/report.hpp"
#include "sk/error.hpp"
#include "support/cache_folder.hpp"

namespace sk_tool {

namespace {

struct InfoOptions {
  std::string device;
  std::string profile;
  std::string jsonFile;
  bool json = false;
  bool refresh = false;
};

/// The cached report of the device, if there is one.
Json kept(const std::string& key) {
  const std::optional<std::string> text = sk::CacheFolder().read("info", key);
  return text ? readKept(*text) : Json();
}

Json infoOf(sk::Device& device, bool refresh) {
  const std::string key = keyOf(device);
  Json info = refresh ? Json() : kept(key);
  if (info.is_null()) {
    info = {{"schema", infoSchema}, {"streamkernel", SK_VERSION}};
    info.update(describe(device));
    std::fprintf(stderr, "sk info: measuring %s ...\n", device.name().c_str());
    measure(device, info);
    sk::CacheFolder().write("info", key, info.dump(2) + '\n');
  }
  addTraits(device, info);
  return info;
}

/// Opens the device with programs of its profile only, because its own choice may mix in others.
sk::Device openPlain(sk::DeviceOptions options) {
  sk::Device device(options);
  if (!options.profile.empty()) return device;
  options.profile = device.profile();
  return sk::Device(options);
}

/// The requested device; by default native code and the best GL device, if there is one, the better one
/// first.
Json infoOfAll(const InfoOptions& options) {
  Json all, devices = Json::array();
  const char* chosen = std::getenv("SK_DEVICE");
  const std::string name = options.device.empty() && chosen != nullptr ? chosen : options.device;
  bool hasGpu = false;
  try {
    sk::Device device = openPlain({.device = name.empty() ? "gl" : name, .profile = options.profile});
    hasGpu = !device.isSoftware();
    devices.push_back(infoOf(device, options.refresh));
  } catch (const sk::Error& error) {
    if (!name.empty() || !options.profile.empty()) throw;
    all["no_gl"] = error.what();
  }
  if (name.empty() && !hasGpu) all["no_gpu"] = whyNoGpu(thisMachine());
  if (name.empty()) {
    sk::Device native = sk::Device::native();
    devices.insert(hasGpu ? devices.end() : devices.begin(), infoOf(native, options.refresh));
  }
  all["devices"] = std::move(devices);
  return all;
}

/// Clears options of this process that would distort measurements, because these are cached for the driver.
void dropWishes() {
  for (const char* wish : {"SK_BARRIER", "SK_DOUBLES", "SK_LIMITS", "SK_TEXTURE_LIMIT"}) ::unsetenv(wish);
}

void writeJson(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", file));
}

void runInfo(const InfoOptions& options) {
  dropWishes();
  const Json all = infoOfAll(options);
  const std::string json = all.dump(2) + '\n';
  if (options.json && options.jsonFile.empty()) {
    std::fputs(json.c_str(), stdout);
    return;
  }
  if (options.json) writeJson(options.jsonFile, json);
  if (all.contains("no_gl")) fmt::print("no OpenGL: {}\n\n", all["no_gl"].get<std::string>());
  for (const Json& device : all["devices"]) fmt::print("{}\n", report(device));
  if (all.contains("no_gpu")) fmt::print("no GPU: {}\n", all["no_gpu"].get<std::string>());
}

}  // namespace

void addInfo(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "Devices: what they are, hold, compute and cost");
  auto options = std::make_shared<InfoOptions>();
  command
      ->add_option(
          "--device", options->device,
          "Only this one: native, reference, gpu, gpu:N, software, gl, or a part of a renderer's name")
      ->type_name("NAME");
  command
      ->add_option("--profile", options->profile,
                   "glsl330, glsl430, essl300 or essl310 (default: the device's best)")
      ->type_name("NAME");
  CLI::Option* json = command->add_option("--json", options->jsonFile, "JSON, to a file or standard output")
                          ->type_name("[FILE]")
                          ->expected(0, 1);
  command->add_flag("--refresh", options->refresh, "Measure again what was kept of an earlier run");
  command->footer(
      "What is measured is kept for each driver in $SK_CACHE (off: nowhere), else in "
      "$XDG_CACHE_HOME/streamkernel, else in ~/.cache/streamkernel.");
  command->callback([options, json] {
    options->json = json->count() > 0;
    runInfo(*options);
  });
}

}  // namespace sk_tool
