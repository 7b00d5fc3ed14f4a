// SPDX-License-Identifier: MIT
//
// A hierarchy of boxes and its shapes on a device, and the choices that kernels are specialised by.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "bvh.hpp"
#include "bvh.sk.hpp"
#include "model.hpp"
#include "vertex_storage.hpp"

namespace rays {

enum class HowToTraverse : std::uint8_t { Stack, Leaves, Skip };
/// Returns the name that scene files use.
std::string_view nameOf(HowToTraverse way);

enum class HowToIntersect : std::uint8_t { Watertight, Moller };

/// Paths followed by one kernel to their end, or by a call for each segment of all paths that are left.
enum class PathMachine : std::uint8_t { Megakernel, Wavefront };

/// How rays are sorted before they are traced, so that neighbours go the same way: by the cell of the origin and then the signs of the direction
/// (Origin), or by the signs first (Direction).
enum class RaySort : std::uint8_t { None, Origin, Direction };

struct DeviceSettings {
  BvhSettings bvh{};
  std::optional<HowToTraverse> traversal{};  ///< none: what is faster on the device
  std::optional<int>
      nodes{};  ///< children of a node, 2 or `wideChildren`; none: what is faster. Skip needs 2
  HowToIntersect intersection = HowToIntersect::Watertight;
  /// Single or Double. Boxes and links are stored in the bits of floats, which halves would round.
  sk::Precision precision = sk::Precision::Single;
  VertexStorage storage = VertexStorage::Single;
  PathMachine machine = PathMachine::Megakernel;
  RaySort sort = RaySort::None;  ///< of lists of rays, and of the wavefront machine
};

/// Uploads the elements. An empty list becomes one element, because a gather must not be empty.
template <class T>
sk::Stream<T> streamOf(sk::Device& device, std::vector<T> elements) {
  if (elements.empty()) elements.push_back(T{});
  sk::Stream<T> stream = device.stream<T>({static_cast<std::int64_t>(elements.size())});
  stream.write(elements);
  return stream;
}

/// The shapes and planes of a model on a device. Shapes are either floats as `shapeLayout` has them, or rows of halves and numbers as
/// `halfLayout` has them; the streams of the other kind have one element.
struct DeviceShapes {
  /// `order` numbers the shapes as in Bvh::order. Device and model must outlive it.
  DeviceShapes(sk::Device& onDevice, const Model& ofModel, std::span<const std::uint32_t> order,
               VertexStorage storage = VertexStorage::Single);
  /// Triangles before spheres, in floats.
  DeviceShapes(sk::Device& onDevice, const Model& ofModel);

  bool hasTriangles() const { return !model.triangles.empty(); }
  bool hasSpheres() const { return !model.spheres.empty(); }
  bool hasShapes() const { return hasTriangles() || hasSpheres(); }
  /// What kernels read that shade nothing; PathTables adds the rest. Refers to the streams.
  kernels::Scene scene() const;

  sk::Device& device;
  const Model& model;
  bool inHalves;
  sk::Stream<sk::float4> planes, floats;
  sk::Stream<sk::half4> halves;
  sk::Stream<sk::int2> numbers;
};

class DeviceScene {
 public:
  /// The model must outlive it. A model in halves is rounded first.
  DeviceScene(sk::Device& device, const Model& model, const DeviceSettings& settings);

  /// Calls a kernel with the scene, the hierarchy, and then `more`.
  template <class Kernel, class... More>
  void call(const Kernel& kernel, More&&... more) {
    callWith(shapes_->scene(), kernel, std::forward<More>(more)...);
  }
  /// The same with a scene of these shapes that has materials and lights, too.
  template <class Kernel, class... More>
  void callWith(const kernels::Scene& scene, const Kernel& kernel, More&&... more) {
    try {
      kernel.with({.precision = precision_})(scene, hierarchy(), std::forward<More>(more)...);
    } catch (const sk::Error& error) {
      explain(error);
      throw;
    }
  }

  sk::Device& device() const { return *device_; }
  /// What is traced: the given model, or its copy that is rounded to halves.
  const Model& model() const { return *model_; }
  const Bvh& bvh() const { return bvh_; }
  /// In the order in which hits number them.
  const DeviceShapes& shapes() const { return *shapes_; }
  /// The number of nodes on the device: with two or eight children, and once per octant for links.
  std::int64_t nodeCount() const { return width_ == wideChildren ? wide_.size() / 4 : nodes_.size() / 2; }
  std::vector<std::string> account() const;
  /// What rounding to halves has lost.
  std::vector<std::string> warnings() const;

 private:
  /// Throws std::runtime_error, with what a scene may say instead, if the device lacks the doubles that the scene asks for.
  void explain(const sk::Error& error) const;
  /// Refers to the streams.
  kernels::Hierarchy hierarchy() const;

  sk::Device* device_;
  std::unique_ptr<Model> rounded_;  ///< where shapes are in halves
  const Model* model_;
  Rounding rounding_;
  Bvh bvh_;
  double milliseconds_ = 0.0;  ///< that building took
  HowToIntersect intersection_;
  sk::Precision precision_;
  HowToTraverse traversal_;
  int width_;  ///< children of a node
  bool isChosen_;  ///< both, because nothing was asked for
  std::optional<DeviceShapes> shapes_;
  sk::Stream<sk::float4> nodes_;
  sk::Stream<sk::int4> wide_;
  sk::Stream<std::int32_t> children_;
};

}  // namespace rays
