// SPDX-License-Identifier: MIT
//
// Regions that a device cannot use as they lie in their streams: strided views and other shapes. A temporary stream of
// the region's shape takes its place. Elements that are read are copied to it before, and those that are written are
// copied from it afterwards, so that a call reads everything as it was, and elements between those of a region keep
// their values.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "device/stream_state.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// A region, or the temporary stream in its place.
class DenseRegion {
 public:
  /// For transfers between a region and host memory. `isRead`: copies the elements first.
  DenseRegion(const StreamRegion& region, bool isRead);
  const StreamRegion& get() const { return region_; }
  /// Copies the elements to the region if they are in a temporary stream.
  void finish() const;

 private:
  StreamRegion given_, region_;
  std::unique_ptr<StreamState> stream_;
};

/// The checked arguments of a call, with temporary streams in place of some.
class DenseArguments {
 public:
  DenseArguments(const program::Kernel& kernel, std::span<const Argument> arguments);

  /// True if the call can use all arguments as they are.
  bool areAsGiven() const { return temporaries_.empty(); }
  std::span<const Argument> get() const {
    return areAsGiven() ? given_ : std::span<const Argument>(arguments_);
  }
  /// Copies what the call has written to the arguments that were given.
  void finish() const;

 private:
  struct Temporary {
    std::size_t argument;
    std::unique_ptr<StreamState> stream;
    bool isWritten;
  };
  void replace(std::size_t argument, bool isRead, bool isWritten);

  std::span<const Argument> given_;
  std::vector<Argument> arguments_;
  std::vector<Temporary> temporaries_;
};

/// Whether any argument of a checked call needs a temporary stream.
bool needsDenseArguments(const program::Kernel& kernel, std::span<const Argument> arguments);

}  // namespace sk
