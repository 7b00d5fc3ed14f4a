// SPDX-License-Identifier: MIT
//
// Elements of a GL stream on their way to host memory. On a GPU they go to a buffer of the driver's. A software renderer
// would first draw everything that is queued; there they are copied by one more draw, which it does in its time, and read
// from the copy.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assemble/storage.hpp"
#include "gl/fence.hpp"
#include "gl_device.hpp"
#include "layout.hpp"
#include "packed_transfer.hpp"
#include "transfer_state.hpp"

namespace sk {

class GlStream;

class PendingRead final : public TransferState {
 public:
  /// Of a region that has elements. A scope of the device must be open. Throws sk::Error where there is no memory.
  PendingRead(GlDevice& device, GlStream& stream, const StreamRegion& region);
  ~PendingRead() override;

  bool isReady() override;
  void wait() override;
  void take(std::byte* elements) override;

  /// The device ends: the elements come to host memory. Its context is current.
  void land() noexcept;
  /// The device ends, and its context is out of reach.
  void abandon() noexcept;

 private:
  void begin(GlStream& stream, const StreamRegion& region);
  bool isThere() const { return packed_ ? packed_->isReady() : fence_.isReached(); }
  void copy(std::byte* elements);
  void leave() noexcept;

  GlDevice* device_;  ///< null once it has ended, or the elements are taken
  const program::Element& element_;
  std::unique_ptr<assemble::HeldElement> held_;  ///< where the planes hold another
  const program::Element* texel_ = nullptr;  ///< what is copied: an element as it is held, or a packed texel
  std::size_t count_;
  std::optional<PackedRead> packed_;
  std::optional<PlanesLease> drawn_;  ///< the copy, which lies as
  Layout layout_;
  gl::Fence fence_;  ///< behind it
  std::vector<std::byte> landed_;
  std::string failure_;
};

}  // namespace sk
