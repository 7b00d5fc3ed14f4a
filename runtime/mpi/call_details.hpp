// SPDX-License-Identifier: MIT
//
// What a rank calls, beyond the name: what the ranks compare, and the words by which an error says what differs between two calls of
// one name.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "agreement.hpp"
#include "sk/call.hpp"
#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {
class DomainState;
class DomainStreamState;
}  // namespace sk

namespace sk::mpi {

class CallPlan;

/// The call of a kernel, a reduction or a scan.
class KernelDetails final : public Details {
 public:
  /// All of these must outlive it.
  KernelDetails(const DomainState& domain, const program::Kernel& kernel, std::span<const Argument> arguments,
                const CallOptions& options)
      : domain_(domain), kernel_(kernel), arguments_(arguments), options_(options) {}

  /// Adds to the hash what SK_CHECK=collectives compares beside the kernel and its options: the box, shapes, streams, and the
  /// values of uniforms.
  void addTo(Call& call) const;
  /// Lets details() name the halos that the call exchanges. The plan must outlive it.
  void setPlan(const CallPlan& plan) { plan_ = &plan; }
  std::string details() const override;

 private:
  std::string wordsOf(const Argument& argument, const program::Parameter& parameter) const;

  const DomainState& domain_;
  const program::Kernel& kernel_;
  const std::span<const Argument> arguments_;
  const CallOptions& options_;
  const CallPlan* plan_ = nullptr;
};

/// The domain, the options that are not Default, and the box of a call, one a line.
std::string linesOf(const DomainState& domain, const CallOptions& options, const Box& box);

/// An operation on the elements of a stream. The ranks compare the words themselves.
class StreamCall final : public Details {
 public:
  /// Allocates nothing, so that a rank without memory can refuse the operation.
  StreamCall(std::string_view what, const DomainState& domain);
  /// With SK_CHECK=collectives, the ranks compare which stream it is, and otherwise its type.
  StreamCall(std::string_view what, const DomainStreamState& stream);
  StreamCall& with(std::string_view name, std::string_view value);
  StreamCall& with(std::string_view name, std::int64_t value);

  /// Refers to this.
  Call call() const { return {.what = what_, .hash = hash_.value(), .details = this}; }
  std::string details() const override { return {text_.data(), length_}; }

 private:
  std::string_view what_;
  Hash hash_;
  std::array<char, 400> text_;  ///< cut off if it is longer
  std::size_t length_ = 0;
};

}  // namespace sk::mpi
