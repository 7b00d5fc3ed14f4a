// SPDX-License-Identifier: MIT
//
// Every scene by every engine and machine, drawn, dispatched and native: how far from the default engine's native picture, in standard errors.
#include "study.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "alike.hpp"
#include "support/progress.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

struct Place {
  std::string_view name;
  sk::Device device;
};

/// Where the program is, or in the sources.
std::filesystem::path sceneFolder() {
  for (const char* folder : {"scenes", "examples/applications/rays/scenes"})
    if (std::filesystem::is_directory(folder)) return folder;
  throw std::runtime_error("there is no folder 'scenes' here; go to examples/applications/rays, which has it");
}

}  // namespace

Findings studyAlike(sk::Device&, bool isSmall) {
  std::array places = {
      Place{"native", sk::Device::native()},
      Place{"fragment", sk::Device(sk::DeviceOptions{.device = "software", .profile = "glsl330"})},
      Place{"compute", sk::Device(sk::DeviceOptions{.device = "software", .profile = "glsl430"})}};
  const Overrides overrides{.width = isSmall ? 8 : 24,
                            .height = isSmall ? 6 : 16,
                            .samples = isSmall ? 2 : 8,
                            .mostLevel = isSmall ? 1 : 2};
  std::vector<std::filesystem::path> files = sceneFiles(sceneFolder());
  if (isSmall) files.resize(1);
  const std::vector<Mode> modes = allModes();
  examples::Table table({"mode", "on", "means", "of", "pixels", "of", "pixels that differ"});
  examples::Verification means("standard errors between means of pictures", 4.0,
                               "one in 16,000 is larger by chance, and the numbers are fixed");
  examples::Verification pixels("standard errors between pixels", 6.0,
                                "one path of many may take another turn; variances are estimates");
  examples::Progress progress("rendering",
                              static_cast<std::int64_t>(files.size() * modes.size() * places.size()));
  std::vector<Scene> scenes;
  std::vector<Result> expected;
  for (const std::filesystem::path& file : files) {
    scenes.push_back(readScene(file, overrides));
    expected.push_back(resultOf(places[0].device, scenes.back(), modes[0]));
  }
  std::int64_t done = 0;
  for (const Mode& mode : modes) {
    for (Place& place : places) {
      Likeness worst{.mean = -1, .pixel = -1};
      std::string_view ofMean, ofPixel;
      for (std::size_t i = 0; i < scenes.size(); ++i) {
        const Likeness likeness = likenessOf(resultOf(place.device, scenes[i], mode), expected[i]);
        means.note(done, likeness.mean);
        pixels.note(done, likeness.pixel);
        progress.update(++done);
        if (likeness.mean > worst.mean) ofMean = scenes[i].name;
        if (likeness.pixel > worst.pixel) ofPixel = scenes[i].name;
        worst = {std::max(worst.mean, likeness.mean), std::max(worst.pixel, likeness.pixel),
                 std::max(worst.differing, likeness.differing)};
      }
      table.add({mode.name, std::string(place.name), fmt::format("{:.1f}", worst.mean), std::string(ofMean),
                 fmt::format("{:.1f}", worst.pixel), std::string(ofPixel),
                 fmt::format("{:.1f} %", 100 * worst.differing)});
    }
  }
  progress.clear();
  return {table.markdown(), {means, pixels}};
}

}  // namespace rays
