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
  Shape shape;                         ///< both hold once the stream is settled
  Layout layout;
  std::vector<Surface> planes;         ///< one a field of the element; none where the stream is empty

  /// Takes what a kernel has pushed for its elements, and gives its planes for it. `total`: where their number
  /// is not known, CountTree::totalTexture(); `list` has then room for all that may be.
  void become(std::vector<Surface>& elements, const Layout& list, Surface* total);
  /// Finds out how many elements there are, if that is not known, which waits for the device. No scope of the
  /// device is open.
  void settle();

 private:
  friend class DeviceState;
  void takeSize(std::int32_t count);

  Surface total_;  ///< holds the number of elements until somebody asks
  StreamState* previous_ = nullptr;  ///< in the device's list
  StreamState* next_ = nullptr;
};

/// The stream of a region, settled. Throws sk::Error, its text after `context`, where it was moved from, its
/// device is gone, or a kernel has left it less elements than the region has.
StreamState& liveStream(const StreamRegion& region, std::string_view context);

/// Whether a region is inside its stream, which is settled: a kernel that pushes to a stream changes its size.
bool isInside(const StreamRegion& region);

}  // namespace sk
