// SPDX-License-Identifier: MIT
//
// What every engine can do: hits of rays, shadows, pictures in passes. An engine lives in files of its own and has one row in
// engine.cpp; the table of the scene that has its name holds its settings.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "model.hpp"
#include "support/grid_stream.hpp"
#include "support/scene_file.hpp"

namespace rays {

enum class Sampling : std::uint8_t { Random, Sobol };

/// How paths reach lights with an extent (surfaces, discs of suns, images of the sky): by sampling the light, by scattered rays that meet it, or both.
enum class Strategy : std::uint8_t {
  Both,  ///< both ways, weighted by the power heuristic
  Lights,  ///< only by rays to points of lights
  Surfaces,  ///< only by rays that surfaces scatter
};

struct Picture {
  bool everything = false;  ///< compiles in what the scene does not name, too, to measure what that costs
  int width = 512;
  int height = 512;
  int depth = 8;  ///< segments of a path, the one from the camera included
  std::uint32_t seed = 1;
  Sampling sampling = Sampling::Sobol;  ///< independent numbers, or Sobol's with Owen's scrambling
  Strategy strategy = Strategy::Both;
  /// A grid of shape {height, width} divides the pixels over ranks; each rank has the whole scene on its device. Null: the engine's device computes all pixels.
  examples::DividedGrid* grid = nullptr;
};

/// Throws std::runtime_error if the pixels are divided over ranks: `what` needs all of them on one device.
void refuseDivided(const Picture& picture, std::string_view what);

class Exposure;

/// A picture that becomes better with each pass: one more sample for each pixel that still wants one.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Adds sample `index` of every active pixel; the same index makes the same sample.
  virtual void pass(std::int64_t index) = 0;
  /// The samples of all passes so far (exposure.hpp).
  virtual Exposure& exposure() = 0;
  /// Discards all samples and continues with another camera, in the model's units of length.
  virtual void look(const Camera& camera) = 0;
  /// Lines for the report: what this picture required, and what it would have cost otherwise.
  virtual std::vector<std::string> account() { return {}; }

  /// The mean of all passes so far: radiance, row by row from the top. Waits for the device.
  std::vector<sk::float3> image();
  /// The variance of image(), if the samples count as independent; empty before there are two.
  std::vector<sk::float3> variance();
};

/// How an engine tests triangles, which bounds the errors of its hits (docs/rays.md, "Needles").
struct TriangleTest {
  bool isWatertight = true;  ///< otherwise weights come from products of edges, as Möller's test has them
  double roundoff = 0x1p-24;  ///< half the distance from 1 to the next number of its arithmetic
};

class Engine {
 public:
  virtual ~Engine() = default;

  /// Finds the nearest hit of each ray, and the least id among hits at one distance. `hits` has the size of `rays`. The greatest
  /// component of a ray's direction lies between 1/2 and 4 (traceRays() sees to that).
  virtual void closest(std::span<const Ray> rays, std::span<Hit> hits) = 0;
  /// Sets `blocked` to 1 for rays that hit anything, else to 0.
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) = 0;
  /// Throws std::runtime_error where the engine does not know something that the scene names.
  virtual std::unique_ptr<Renderer> renderer(const Picture& picture) = 0;
  /// Lines for the report: sizes of what was built, time that it took.
  virtual std::vector<std::string> account() { return {}; }
  /// The model that hits are those of. It may differ from the given one by roundings that the scene has asked for.
  virtual const Model& model() const = 0;
  virtual TriangleTest triangleTest() const = 0;
  /// Sentences for the user about what the scene loses by its settings.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// An engine for a model, which must outlive it.
using MakeEngine = std::function<std::unique_ptr<Engine>(sk::Device&, const Model&)>;

struct EngineKind {
  std::string_view name;  ///< in scenes: engine = "name", and settings in [name]
  std::string_view does;  ///< for --help
  /// Reads the settings, before there is a device. `settings` is none where the scene has no such table.
  MakeEngine (*read)(const std::optional<examples::SceneTable>& settings);
};

/// All of them; the first is the default.
std::span<const EngineKind> engineKinds();

/// What Engine::closest() and Engine::occluded() find.
std::vector<Hit> hitsOf(Engine& engine, std::span<const Ray> rays);
std::vector<std::uint8_t> shadowsOf(Engine& engine, std::span<const Ray> rays);

/// The nearest hits of rays that have the lengths of the scene file, and directions of any length. Denormal directions count as
/// they are.
std::vector<Hit> traceRays(Engine& engine, const Model& model, std::span<const Ray> rays);

/// Hits of engines as those of the scene file: `t` in its lengths. For rays of unit length in the model's units.
void toSceneLengths(const Model& model, std::span<Hit> hits);

}  // namespace rays
