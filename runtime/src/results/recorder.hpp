// SPDX-License-Identifier: MIT
//
// Records what the host of a program reads, which kernels it calls and how long they take, and writes all of it to the file
// that SK_RESULTS names when the process ends: SK_RESULTS=FILE, or FILE,times to measure kernels on devices that queue calls, by
// waiting around each. "%p" in the name stands for the process id, "%%" for a percent sign. A device's recorder is null if the variable is not set, so
// that recording costs a test. Never disturbs the program: what cannot be recorded is left out, and the file says why.
//
// One recorder serves all devices of the process, because reads of several devices have one order. It is global state for the same
// reason as the list of linked files: it describes the process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "results/results_file.hpp"
#include "sk/options.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {
class DeviceState;
class StreamState;
}  // namespace sk

namespace sk::results {

class Recorder {
 public:
  using Time = std::int64_t;  ///< nanoseconds of the monotonic clock
  /// The number of streams that hold the results of operations with scalars.
  static constexpr std::uint32_t scalarNumber = ~std::uint32_t{0};
  /// The most bytes of numbers that the file holds, floats counted as doubles.
  static constexpr std::uint64_t mostBytes = std::uint64_t{256} << 20;

  /// Null unless SK_RESULTS names a file, which the first call reads.
  static Recorder* ofProcess();

  explicit Recorder(std::string setting, std::uint64_t limit = mostBytes);

  /// Whether devices that queue calls wait around each, to measure it.
  bool measures() const { return measures_; }

  void addDevice(const DeviceState& device) noexcept;
  /// Returns the stream's number, from 1 in order of creation: the name of a stream without one.
  std::uint32_t addStream(std::string_view name, std::optional<Storage> chosenByFile,
                          std::uint64_t bytes) noexcept;

  /// Elements that the host has read. A stream without a number is the runtime's own, and is left out, as are the streams of
  /// libraries of the runtime, whose names begin with "sk::".
  void addRead(const StreamState& stream, const std::byte* elements, std::size_t count) noexcept;
  /// Likewise the components of elements, all of them floats.
  void addReals(const StreamState& stream, std::span<const double> components, Values::Kind kind) noexcept;
  /// The value of an accumulator that the host gets.
  void addValue(const std::string& name, const program::Element& element, const std::byte* value) noexcept;
  void addValue(const std::string& name, const program::Element& element,
                std::span<const double> components) noexcept;

  /// A call is checked, and will run at least once, now or in a loop. `called` are its own options, `used` those that it runs with.
  void addCall(const DeviceState& device, const program::Kernel& kernel, const program::Reduction* reduction,
               const CallOptions& called, const CallOptions& used) noexcept;
  void addTime(std::string_view kernel, Time begin, Time end, bool isMeasured) noexcept;
  void addNote(std::string_view note) noexcept;

  /// Writes the file unless this is the child of a fork. What fails is not reported.
  void write() noexcept;

 private:
  struct Recorded {
    Series series;
    std::deque<Values> last = {};
  };
  struct Called {
    Kernel kernel;
    CallOptions called, used;  ///< of the last call that was added
    bool isNew = true;
    double firstSeconds = 0;  ///< of the first call that was measured
  };

  template <class Add>
  void add(Add&& add) noexcept;
  /// The kernel as the file has it: the first call of a kernel, in which a device that queues calls builds its programs, counts as the
  /// mean of the others.
  Kernel measured(const Called& call) const;
  void keep(const std::string& name, Values values);
  void makeRoom(Recorded& recorded, std::size_t bytes);
  void addComponents(const std::string& name, const program::Element& element, const std::byte* elements,
                     std::size_t count);
  void addComponents(const std::string& name, const program::Element& element,
                     std::span<const double> components, Values::Kind kind);

  std::mutex mutex_;
  std::string file_;
  bool measures_ = false;
  const std::uint64_t limit_;
  const int process_id_;
  Process process_;
  std::vector<std::string> order_;  ///< of the names of series
  std::map<std::string, Recorded, std::less<>> series_;
  std::vector<std::string> kernelOrder_;
  std::map<std::string, Called, std::less<>> kernels_;
  std::map<std::string, Stream, std::less<>> streams_;
  std::uint32_t streamCount_ = 0;
  std::uint64_t bytes_ = 0;
  Time begin_ = 0, end_ = 0;
  bool isUnmeasured_ = false;  ///< a kernel ran on a device that queues its calls
};

}  // namespace sk::results
