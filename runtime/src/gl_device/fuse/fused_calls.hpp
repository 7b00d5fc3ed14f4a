// SPDX-License-Identifier: MIT
//
// Calls of kernels that follow each other and read of each other's results no more than their own elements, as one call of
// one kernel:
//
//   lift(x, y);           void sk_fused(float x, out float y, out float z) {
//   bend(y, z);             float a, b;
//                           lift(x, a);
//                           bend(a, b);
//                           y = a; z = b;
//                         }
//
// Each stream is read and written once. What a stream would round is not handed on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "assemble/program/several_bodies.hpp"
#include "call/resolved_call.hpp"
#include "gl_device/program/made_kernels.hpp"
#include "sk/call.hpp"

namespace sk {

class GlDevice;

class FusedCalls {
 public:
  explicit FusedCalls(GlDevice& device) : device_(&device) {}

  /// Adds a call, which follows those before, if one pass can run all of them. Otherwise returns why not, without effect.
  /// GlCall::whyAlone() must be empty; the call must outlive this.
  std::string add(const ResolvedCall& call);
  std::size_t size() const { return calls_.size(); }

  /// Prepares run(). At least one call must have been added.
  void finish();
  void run() const;

  /// "lift + bend"
  std::string_view name() const { return made_->kernel.name; }
  /// The bytes that the calls would read and write one by one, and those that they do in one pass.
  std::int64_t bytesOfCalls() const { return bytesOfCalls_; }
  std::int64_t bytes() const;

 private:
  /// A parameter of the whole.
  struct Outer {
    program::Parameter parameter;
    std::string symbol, name;
    Argument argument;
  };
  /// A stream that a call has written, and the variable with its element.
  struct Written {
    StreamState* stream;
    std::string variable;
    const program::Parameter* parameter;
    Argument argument;
  };

  std::string tryAdd(const ResolvedCall& call);
  std::string whyNotWith(const ResolvedCall& call) const;
  std::string whyTooLarge() const;
  std::string symbolOf(std::size_t parameter) const;
  Outer& addOuter(const ResolvedCall& call, std::size_t i);
  /// The symbol of a stream's element or of a gather that the calls before read, too; empty if they do not.
  std::string sharedInput(const program::Parameter& parameter, const Argument& argument);
  Written* writtenOf(const StreamState* stream);
  std::shared_ptr<MadeKernel> make() const;

  GlDevice* device_;
  std::vector<const ResolvedCall*> calls_;
  assemble::SeveralBodies bodies_;
  std::vector<Outer> outers_;
  std::vector<Written> written_;
  std::string statements_;
  int variables_ = 0;
  std::int64_t bytesOfCalls_ = 0;
  std::shared_ptr<const MadeKernel> made_;
  std::vector<Argument> arguments_;
};

/// The attributes of a parameter on one line, for the text by which kernels are kept (MadeKernels).
std::string describeParameter(const program::Parameter& parameter);

/// Adds what a body needs of its kernel to the kernel of several bodies: flags, weights and intrinsics.
void addNeeds(program::Kernel& whole, std::vector<program::IntrinsicUse>& intrinsics,
              const program::Kernel& part);

/// The value of a spec parameter as an argument, which compilers know.
std::string specValue(const program::Parameter& parameter, std::uint32_t bits);

/// Whether programs of both may be one, as far as options say.
bool haveSameOptions(CallOptions a, CallOptions b);

/// The bytes of a region's elements.
std::int64_t elementBytes(const StreamRegion& region);

}  // namespace sk
