// SPDX-License-Identifier: MIT
//
// A stream on a GL device: its planes, and where its elements lie in them.
#pragma once

#include <cstdint>
#include <vector>

#include "layout.hpp"
#include "stream_state.hpp"
#include "surface.hpp"

namespace sk {

class GlDevice;

class GlStream final : public StreamState {
 public:
  /// A scope of the device must be open. Throws sk::Error where there is no room.
  GlStream(GlDevice& device, const program::Element& element, const Shape& shape);
  ~GlStream() override;

  void settle() override;
  void write(const StreamRegion& region, const std::byte* elements) override;
  void read(const StreamRegion& region, std::byte* elements) override;
  void readReals(const StreamRegion& region, double* values) override;
  StreamTexture texture(int plane) override;

  Layout layout;                       ///< holds once the stream is settled
  std::vector<Surface> planes;         ///< one a field of the element; none where the stream is empty

  /// Takes what a kernel has pushed for its elements, and gives its planes for it. `total`: where their number
  /// is not known, CountTree::totalTexture(); `list` has then room for all that may be.
  void become(std::vector<Surface>& elements, const Layout& list, Surface* total);

 private:
  friend class GlDevice;
  GlDevice& owner() const;
  void takeSize(std::int32_t count);

  Surface total_;  ///< holds the number of elements until somebody asks
};

/// The stream of an argument of a call on a GL device.
inline GlStream& glStream(const StreamRegion& region) { return static_cast<GlStream&>(*region.stream); }

}  // namespace sk
