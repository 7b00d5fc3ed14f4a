// SPDX-License-Identifier: MIT
//
// edges [IN.png] [OUT.png]: the edges of any picture, or of a generated one.
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "detector.hpp"
#include "reference.hpp"
#include "still_life.hpp"
#include "support/application.hpp"
#include "support/colormap.hpp"
#include "support/image.hpp"
#include "support/stopwatch.hpp"
#include "text/real_option.hpp"

namespace {

struct Settings {
  std::filesystem::path input;
  std::filesystem::path output = "edges.png";
  int size = 512;
  double sigma = 1.4;
  float low = 0.0f;
  float high = 0.0f;
  std::string style = "hue";
  bool beside = false;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("input", s.input, "the picture (default: a generated one, saved beside the result)");
  cli.add_option("-o,--output,output", s.output, "the result, a PNG (default: edges.png)");
  cli.add_option("--size", s.size, "width and height of the generated picture (default: 512)")
      ->check(CLI::Range(1, 8192));
  cli.add_option("--sigma", s.sigma, "blur before the gradient, in pixels; 0 for none (default: 1.4)")
      ->check(sk::text::realFrom(0, 50), "0 to 50");
  CLI::Option* low = cli.add_option(
      "--low", s.low,
      "weakest edge that is kept where it touches a sure one, as a slope per pixel in linear light");
  CLI::Option* high = cli.add_option("--high", s.high, "weakest edge that is sure; with --low")
                          ->check(sk::text::aboveZero(), "above 0");
  low->needs(high)->check(sk::text::aboveZero(), "above 0");
  high->needs(low);
  cli.add_option("--style", s.style,
                 "hue: the way that the light rises in colour; white: on black; ink: on paper (default: hue)")
      ->check(CLI::IsMember({"hue", "white", "ink"}));
  cli.add_flag("--beside", s.beside, "put the picture and its edges side by side");
}

/// The light of each code.
std::vector<float> linearTable(int white) {
  std::vector<float> table;
  for (int code = 0; code <= white; ++code) {
    table.push_back(static_cast<float>(examples::linearFromSrgb(static_cast<double>(code) / white)));
  }
  return table;
}

std::vector<sk::float3> painted(examples::Detector& detector, sk::Device& device, const std::string& style) {
  if (style == "ink")
    return detector.paint(device, {0.98f, 0.97f, 0.95f}, std::vector<sk::float3>{{0.12f, 0.13f, 0.16f}});
  if (style == "white") return detector.paint(device, {0, 0, 0}, std::vector<sk::float3>{{1, 1, 1}});
  return detector.paint(device, {0.045f, 0.05f, 0.07f}, examples::hueWheel(360));
}

void save(const Settings& s, const examples::Picture& picture, const std::vector<sk::float3>& edges) {
  if (!s.beside) return examples::savePng(s.output, picture.width, picture.height, edges);
  constexpr int gap = 8;
  const auto width = static_cast<std::size_t>(picture.width);
  std::vector<sk::float3> both;
  for (std::size_t row = 0; row < edges.size(); row += width) {
    for (std::size_t i = row; i < row + width; ++i) {
      const auto component = [&](std::int32_t code) {
        return static_cast<float>(code) / static_cast<float>(picture.white);
      };
      both.push_back(
          {component(picture.pixels[i].x), component(picture.pixels[i].y), component(picture.pixels[i].z)});
    }
    both.insert(both.end(), gap, {1, 1, 1});
    both.insert(both.end(), edges.begin() + static_cast<std::ptrdiff_t>(row),
                edges.begin() + static_cast<std::ptrdiff_t>(row + width));
  }
  examples::savePng(s.output, 2 * picture.width + gap, picture.height, both);
}

examples::Picture inputPicture(const Settings& s) {
  if (!s.input.empty()) return examples::loadPicture(s.input);
  examples::Picture picture = examples::stillLife(s.size, s.size);
  if (!s.beside) {
    std::filesystem::path file = s.output;
    file.replace_filename(s.output.stem().string() + "_input.png");
    examples::savePng(file, picture);
    fmt::print("no picture was given, so one was made: {}\n", file.string());
  }
  return picture;
}

void findEdges(examples::Application& app, const Settings& s) {
  examples::checkPngName(s.output);
  std::optional<examples::Thresholds> thresholds;
  if (s.high > 0.0f) thresholds = {s.low, s.high};
  if (s.low > s.high)
    throw std::runtime_error(fmt::format("--low {} is above --high {}; exchange them", s.low, s.high));
  const examples::Picture picture = inputPicture(s);
  const std::vector<float> linear = linearTable(picture.white);
  const std::vector<float> weights = examples::gaussianWeights(s.sigma);

  sk::Device device(app.device());
  examples::Detector detector(device, picture, linear, weights, thresholds);
  detector.detect();  // once unmeasured: programs are compiled at their first call
  device.finish();
  const double milliseconds = examples::millisecondsOf(device, [&] { detector.detect(); });
  app.report(
      fmt::format("edges of {} x {} pixels{}", picture.width, picture.height, thresholds ? ", linked" : ""),
      device.name(), milliseconds);

  save(s, picture, painted(detector, device, s.style));
  fmt::print("wrote {}\n", s.output.string());

  const examples::Reference reference(picture, linear, weights);
  app.verified(reference.checkSteepness(detector.steepness()));
  app.verified(reference.checkRidges(detector.ridges()));
  if (thresholds)
    app.verified(
        examples::checkLinks(picture.width, picture.height, detector.classified(), detector.linked()));
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app("edges",
                            "Finds the edges of a picture: blur, Sobel's gradient, non-maximum suppression, "
                            "and linking if asked for.");
  addOptions(app.options(), settings);
  return app.run(argc, argv, [&] { findEdges(app, settings); });
}
