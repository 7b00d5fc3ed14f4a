// SPDX-License-Identifier: MIT
//
// What is behind a Stream: its planes, where its elements lie in them, and the device that it is on,
// as long as there is one.
#pragma once

#include <string_view>
#include <vector>

#include "layout.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"
#include "surface.hpp"

namespace sk {

class DeviceState;

class StreamState {
 public:
  /// A scope of the device must be open. Throws sk::Error where there is no room.
  StreamState(DeviceState& device, const program::Element& element, const Shape& shape);
  ~StreamState();
  StreamState(const StreamState&) = delete;
  StreamState& operator=(const StreamState&) = delete;

  DeviceState* device;                 ///< null once the device is gone
  const program::Element* const element;
  const Shape shape;
  const Layout layout;
  std::vector<Surface> planes;         ///< one a field of the element; none where the stream is empty

 private:
  friend class DeviceState;
  StreamState* previous_ = nullptr;    ///< in the device's list
  StreamState* next_ = nullptr;
};

/// The stream of a region. Throws sk::Error, its text after `context`, where it was moved from or its
/// device is gone.
StreamState& liveStream(const StreamRegion& region, std::string_view context);

}  // namespace sk
