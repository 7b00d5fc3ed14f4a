// SPDX-License-Identifier: MIT
//
// Promises: a kernel runs if its streams fit the device's texture units, with all that its passes read besides, and else throws before it
// changes anything.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "test_kernel.hpp"

namespace {

using namespace sk;
using namespace sk::test;

/// The sum of `inputs` streams, which is stored, or pushed.
class Sum {
 public:
  Sum(std::size_t inputs, bool pushes) {
    std::string text, sum = "0.0";
    std::vector<program::Parameter> parameters;
    for (std::size_t i = 0; i < inputs; ++i) {
      const std::string& name = names_.emplace_back("x" + std::to_string(i));
      parameters.push_back(input<float>(name));
      text += (i == 0 ? "float " : ", float ") + name;
      sum += " + " + name;
    }
    parameters.push_back(pushes ? variableOutput<float>("r") : output<float>("r"));
    body_ =
        "void sum_of_many(" + text +
        (pushes ? ") { if (x0 > 0.0) sk_push_r(" + sum + "); }\n" : ", out float r) { r = " + sum + "; }\n");
    kernel_ = std::make_unique<TestKernel>("sum_of_many", body_, parameters);
  }

  void operator()(const Stream<float>& x, const Stream<float>& r) const {
    std::vector<Argument> arguments(names_.size(), argumentOf(x));
    arguments.push_back(argumentOf(r));
    run(kernel_->kernel(), arguments);
  }

 private:
  std::deque<std::string> names_;
  std::string body_;
  std::unique_ptr<TestKernel> kernel_;
};

std::string messageOf(const Sum& sum, const Stream<float>& x, const Stream<float>& r) {
  try {
    sum(x, r);
  } catch (const Error& error) {
    CHECK(error.kind() == Error::Kind::Device);
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("kernels run with as many streams as the device has texture units, and no more") {
  static std::deque<Sum> sums;  // programs are found by their kernels' addresses
  for (const std::string& profile : profileNames) {
    Device device(DeviceOptions{.profile = profile});
    const auto units = static_cast<std::size_t>(device.limits().textureUnits);
    auto x = device.stream<float>({3}), r = device.stream<float>({3});
    x.write(std::vector<float>{1, 2, 3});
    for (const bool pushes : {false, true}) {
      const std::size_t most = pushes ? units - 2 : units;  // a pass reads the two textures of a pyramid
      for (std::size_t inputs = units - 3; inputs <= units + 1; ++inputs) {
        CAPTURE(profile, pushes, inputs);
        const Sum& sum = sums.emplace_back(inputs, pushes);
        r.write(std::vector<float>{-1, -1, -1});
        const std::string message = messageOf(sum, x, r);
        CHECK(message.empty() == (inputs <= most));
        const auto n = static_cast<float>(inputs);
        CHECK(r.read() ==
              (inputs <= most ? std::vector<float>{n, 2 * n, 3 * n} : std::vector<float>{-1, -1, -1}));
        if (!message.empty()) {
          CHECK(message.find(std::to_string(pushes ? inputs + 2 : inputs) + " planes") != std::string::npos);
        }
      }
    }
  }
}
