// SPDX-License-Identifier: MIT
//
// Collects what the shadows of a process find out, and writes the report: when the first device is made, so that a file that
// cannot be written is known early, every few seconds, so that a program that crashes leaves one, and at the end. Never throws
// an error of its own to the program.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shadow/recorded_inputs.hpp"
#include "shadow/report.hpp"

namespace sk::shadow {

class Recorder {
 public:
  /// The recorder of this process, made by the first call; null if the report cannot be written or SK_SHADOW is not valid, which
  /// has been said on standard error then.
  static Recorder* ofProcess(std::string_view option);

  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  const Options& options() const { return report_.options; }
  /// False in the child of a fork, which must not write the parent's report.
  bool isInOwnProcess() const;

  /// Locks the report while it lives.
  class Access {
   public:
    explicit Access(Recorder& recorder) : lock_(recorder.mutex_), report_(recorder.report_) {}
    Report* operator->() { return &report_; }
    Report& operator*() { return report_; }

   private:
    std::lock_guard<std::mutex> lock_;
    Report& report_;
  };

  /// The number of a kernel, whose record exists then; and of an output, a stream and a result.
  static int kernel(Report& report, std::string_view name);
  static std::size_t output(KernelRecord& kernel, std::string_view name, std::string_view type);
  static std::size_t result(Report& report, const std::string& name, bool isValue);
  std::string nameOfKernel(int kernel);
  /// Takes the place of inputs of the kernel that it has.
  void keepInputs(const std::string& kernel, RecordedInputs inputs);
  /// A value of the option set= has been put in the place of another.
  void noteApplied(std::size_t setting);
  /// Adds a note once.
  void note(const std::string& text);

  /// How the program has ended: Normal if no device is left.
  enum class Ending : std::uint8_t { None, Normal, Exception };

  /// Writes the report if the last one is some seconds old.
  void writeSometimes();
  /// Writes the report as it is now.
  void write(Ending ending);

  /// A device has a shadow. The report names the first one.
  void deviceBegins(const std::string& name);
  void deviceEnds();
  void writeAtExit();
  /// Nothing catches an exception.
  void writeAtTermination();
  /// A device has no shadow, for a reason that the report gives unless another device has one.
  void deviceStaysAlone(const std::string& name, const std::string& why);

 private:
  explicit Recorder(Options options);
  void writeLocked(Ending ending);
  /// Concludes a report and writes it. `isLast`: no other follows.
  void finish(Report& report, bool isLast);
  void writeFiles(const Report& report);

  std::mutex mutex_;
  Report report_;
  std::vector<bool> applied_;  ///< of the option set=
  std::map<std::string, RecordedInputs> inputs_;  ///< of each kernel's worst call, if they are asked for
  const int process_;
  int devices_ = 0;
  bool hasDevice_ = false;  ///< some device has had a shadow
  std::string whyAlone_;  ///< a device has none
  std::vector<std::string> said_;  ///< notes that have gone to standard error, too
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point lastWrite_ = start_;
  std::string jsonFile_;
  std::string lastPage_, lastJson_;  ///< marks of the files that it wrote last (fileMark())
};

}  // namespace sk::shadow
