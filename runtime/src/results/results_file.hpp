// SPDX-License-Identifier: MIT
//
// The file that SK_RESULTS names: what the host of a program read from its devices, which kernels ran for how long, and which
// choices of accuracy these have. The recorder (results/recorder.hpp) writes it, `sk tune` reads it. The format is binary: a line
// with a version, the members below in their order, and a checksum. Must not know devices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sk::results {

/// The numbers of one read, as the host got them. A reference device, and streams of doubles, give doubles for floats.
struct Values {
  enum class Kind : std::uint8_t { Single, Double, Integer };

  Kind kind = Kind::Single;
  std::string bytes = {};  ///< floats, doubles, or integers of 64 bits

  std::size_t count() const { return bytes.size() / (kind == Kind::Single ? sizeof(float) : sizeof(double)); }
  double at(std::size_t i) const;
  std::int64_t integerAt(std::size_t i) const;
};

/// All reads of one stream or of the values of one reduce, in order.
struct Series {
  /// How many of the first reads are kept whole, and how many of the last.
  static constexpr std::size_t keptAtEnds = 4;

  std::string name = {};
  std::uint64_t reads = 0;
  std::uint64_t hash = 0;  ///< of the numbers of all reads
  std::vector<Values> first = {};
  std::vector<Values> last = {};  ///< those after `first`
  std::uint64_t droppedBytes = 0;  ///< of reads that the limit of the file left no room for
};

/// A kernel, a reduce or a scan that the program has called.
struct Kernel {
  std::string name = {};
  std::string device = {};  ///< of its first call
  bool isNative = false;  ///< all calls ran on native devices, which may be references
  bool isOnReference = false;  ///< likewise on reference devices
  bool isReduce = false;
  std::uint64_t calls = 0;
  double seconds =
      0;  ///< of its calls, by the wall clock; 0 on devices that queue calls, unless times are asked for; the
  ///< first call then counts as the mean of the others, because it builds programs
  bool hasFloats = false;
  std::string whyNotHalf = {}, whyNotWide = {};  ///< why it lacks variants that its device would need
  bool compensates = false;  ///< it sums floats, and can carry the rounding errors of the sums
  bool sumsExactly = false;
  bool hasFastFunctions = false;  ///< it calls functions of which its device has a form of its own
  bool mayContract = false;
  std::vector<std::string> tables = {};  ///< the tabulated functions that it calls
  std::vector<std::string> called = {};  ///< choices that calls made themselves: "precision double"
  std::vector<std::string> used =
      {};  ///< choices that calls ran with, whoever made them; "tables default" for none
};

/// A stream that has floats and whose storage a configuration file may choose.
struct Stream {
  std::string name = {};  ///< empty for all streams without a name
  std::string storage = {};  ///< "single", "half" ...
  std::uint64_t count = 0;  ///< of streams with this name
  std::uint64_t bytes = 0;  ///< of all of them, as floats
};

struct Device {
  std::string name = {};
  bool isReference = false;
  bool isNative = false;
};

struct Process {
  std::vector<Device> devices = {};
  std::vector<Series> series = {};
  std::vector<Kernel> kernels = {};
  std::vector<Stream> streams = {};
  std::vector<std::string> linkedKernels = {};  ///< all names of the program, whether called or not
  std::vector<std::string> notes = {};  ///< what is missing, and why
  double span = 0;  ///< seconds from the first device to the end of the last read or call
  bool hasTimes = false;  ///< the seconds of all kernels are known
};

std::string toBytes(const Process& process);
/// Throws std::runtime_error, which says what is wrong with the bytes of the file of this name.
Process fromBytes(std::string_view bytes, std::string_view file);

}  // namespace sk::results
