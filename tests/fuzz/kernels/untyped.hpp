// SPDX-License-Identifier: MIT
//
// An element type that only descriptors know.
#pragma once

#include "sk/sk.hpp"

namespace fuzz {

/// Streams of it are made with the current `element`.
struct Untyped {
  static inline const sk::program::Element* element = nullptr;
};

}  // namespace fuzz

template <>
struct sk::ElementTraits<fuzz::Untyped> {
  static const sk::program::Element& element() { return *fuzz::Untyped::element; }
};
