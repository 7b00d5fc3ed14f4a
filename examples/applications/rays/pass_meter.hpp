// SPDX-License-Identifier: MIT
//
// What each kernel of many costs: passes, bytes and time. Whoever calls kernels names them to a meter; without one nothing is measured, and nothing
// waits.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

namespace rays {

/// Native and software devices do.
bool runsOnProcessor(const sk::Device& device);
/// The time that a call takes: processor time on devices that run on the processor, which other processes do not change; elapsed time
/// on others.
double milliseconds(const sk::Device& device, const std::function<void()>& call);

class PassMeter {
 public:
  struct Row {
    std::string_view kernel;
    std::int64_t calls = 0;
    std::int64_t elements = 0;  ///< of the domains of all calls
    sk::PassCount count{};
    double milliseconds = 0.0;
  };

  explicit PassMeter(sk::Device& device) : device_(device) {}

  /// In the order in which kernels were first called.
  const std::vector<Row>& rows() const { return rows_; }
  void forget() { rows_.clear(); }

  template <class Call>
  void measure(std::string_view kernel, std::int64_t elements, const Call& call) {
    device_.finish();
    device_.countPasses(true);
    const double time = milliseconds(device_, [&] {
      call();
      device_.finish();
    });
    note(kernel, elements, time);
    device_.countPasses(false);
  }

 private:
  void note(std::string_view kernel, std::int64_t elements, double time);

  sk::Device& device_;
  std::vector<Row> rows_;
};

/// Calls, and measures where there is a meter.
template <class Call>
void metered(PassMeter* meter, std::string_view kernel, std::int64_t elements, const Call& call) {
  if (meter == nullptr)
    call();
  else
    meter->measure(kernel, elements, call);
}

}  // namespace rays
