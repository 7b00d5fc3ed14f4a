// SPDX-License-Identifier: MIT
//
// A hierarchy of boxes and its shapes on a device, and the choices that kernels are specialised by.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sk/sk.hpp>

#include "bvh.hpp"
#include "bvh.sk.hpp"
#include "model.hpp"

namespace rays {

enum class HowToTraverse : std::uint8_t { Stack, Leaves, Skip };
enum class HowToIntersect : std::uint8_t { Watertight, Moller };

struct DeviceSettings {
  BvhSettings bvh{};
  std::optional<HowToTraverse> traversal{};  ///< none: what is faster on the device
  HowToIntersect intersection = HowToIntersect::Watertight;
  /// Single or Double. Numbers of shapes travel in floats, which halves would round.
  sk::Precision precision = sk::Precision::Single;
};

/// A gather must not be empty, and what no kernel reads may hold anything.
template <class T>
sk::Stream<T> streamOf(sk::Device& device, std::vector<T> elements) {
  if (elements.empty()) elements.push_back(T{});
  sk::Stream<T> stream = device.stream<T>({static_cast<std::int64_t>(elements.size())});
  stream.write(elements);
  return stream;
}

class DeviceScene {
 public:
  DeviceScene(sk::Device& device, const Model& model, const DeviceSettings& settings);

  /// The arguments that all kernels begin with, up to `shapes`, and then `more`.
  template <class Kernel, class... More>
  void call(const Kernel& kernel, More&&... more) {
    kernel.with({.precision = precision_})(static_cast<unsigned>(intersection_),
                                           static_cast<unsigned>(traversal_), contracted_, hasTriangles_,
                                           hasSpheres_, hasPlanes_, nodeCount_, planeCount_, firstPlane_,
                                           planes_, nodes_, shapes_, std::forward<More>(more)...);
  }

  sk::Device& device() const { return *device_; }
  const Model& model() const { return *model_; }
  const Bvh& bvh() const { return bvh_; }
  std::vector<std::string> account() const;

 private:
  sk::Device* device_;
  const Model* model_;
  Bvh bvh_;
  double milliseconds_ = 0.0;  ///< that building took
  HowToIntersect intersection_;
  sk::Precision precision_;
  HowToTraverse traversal_;
  bool contracted_, hasTriangles_, hasSpheres_, hasPlanes_;
  int nodeCount_, planeCount_, firstPlane_;
  sk::Stream<sk::float4> planes_, nodes_, shapes_;
};

}  // namespace rays
