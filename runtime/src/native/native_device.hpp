// SPDX-License-Identifier: MIT
//
// A device without GL: streams are in host memory, and kernels are the object code that skc compiled for the
// application. With double or __float128 in place of float, it is the reference that other devices are
// measured against.
#pragma once

#include "device/device_state.hpp"
#include "native/components.hpp"

namespace sk {

class NativeDevice final : public DeviceState {
 public:
  explicit NativeDevice(RealType real);
  ~NativeDevice() override;

  bool isSilent = false;  ///< printf in kernels prints nothing

  RealType real() const { return real_; }
  /// Adds to the bytes of streams in the trace.
  void countBytes(std::int64_t change) noexcept {
    bytes_ += change;
    if (trace) trace->countBytes(bytes_, 0);
  }

  const std::string& name() const override { return name_; }
  const std::string& driver() const override { return none_; }
  const std::string& shadingLanguage() const override { return none_; }
  std::string_view profileName() const override { return "native"; }
  bool isSoftware() const override { return true; }
  const Arithmetic& arithmetic() override { return arithmetic_; }
  bool hasQueue() const override { return false; }
  bool combinesScattered() const override { return true; }
  bool usesPrecisionVariants() const override { return false; }
  bool sumsInDoubles() const override { return real_ == RealType::Float; }
  bool isReference() const override { return real_ != RealType::Float; }
  void checkProgram(const program::Kernel& kernel) override;
  void checkProgram(const program::Reduction& reduction) override;
  std::unique_ptr<StreamState> createStream(const program::Element& element, const Shape& shape,
                                            Storage storage) override;
  void startTrace(const std::string& file) override;
  std::optional<std::int64_t> availableMemory() override;
  void finish() override {}
  void release() override {}
  void makeCurrent() override;
  void run(const ResolvedCall& call) override;
  std::unique_ptr<RecordedCall> prepare(const ResolvedCall& call) override;
  std::unique_ptr<RecordedCall> prepareScalars(ScalarPass pass) override;
  std::unique_ptr<LoopRunner> makeLoopRunner() override;
  bool mayRunTogether(std::int64_t elements) const override { return elements >= std::int64_t{1} << 14; }
  bool runTogether(LoopState& calls, std::span<StreamState* const> locals) override;
  bool needsDense(const program::Kernel& kernel, std::span<const Argument> arguments, std::size_t i) override;
  bool needsDense(const StreamRegion&) override { return false; }
  void reduce(const ResolvedReduction& call) override;
  bool combine(const ResolvedReduction& call, std::span<const StreamRegion> parts,
               std::span<const StreamRegion> results) override;
  bool foldsBesideOutputs(const ResolvedReduction&) override { return true; }
  bool sumsExactly(const ResolvedReduction& call) const override;
  std::unique_ptr<RoundedSums> sumExactly(const ResolvedReduction& call,
                                          const program::ExactSum& sum) override;
  std::vector<std::int64_t> exactWords(const ResolvedReduction& call, const program::ExactSum& sum,
                                       bool isFirst) override;

 private:
  /// The arguments of kernelOfTerm().
  static std::vector<Argument> termArguments(const ResolvedReduction& call, const program::ExactSum& sum);
  RealType realOf(const CallOptions& options) const;
  /// Throws sk::Error if a call asks for GLSL programs.
  void checkTarget(const program::Kernel& kernel, Target requested) const;
  /// True if a call takes the variant that rounds to halves. A reference does not.
  bool computesInHalf(const CallOptions& options) const {
    return options.precision == Precision::Half && !isReference();
  }
  /// The tables of a call's tabulated functions; empty if it computes them.
  std::vector<native::Table> tablesOf(const program::Kernel& kernel, RealType real,
                                      const CallOptions& options);

  RealType real_;
  std::int64_t bytes_ = 0;  ///< of streams
  std::string name_;
  std::string none_;
  Arithmetic arithmetic_;  ///< IEEE 754, as compilers guarantee
};

}  // namespace sk
