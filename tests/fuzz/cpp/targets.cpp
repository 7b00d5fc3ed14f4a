// SPDX-License-Identifier: MIT
#include "cpp/targets.hpp"

#include <cstddef>
#include <cstring>
#include <deque>
#include <span>

#include "cpp/sample_values.hpp"
#include "driver/native_library.hpp"
#include "kernels/untyped.hpp"
#include "native/native.hpp"
#include "sk/call.hpp"
#include "sk/scalar_bytes.hpp"

namespace fuzz::cpp {
namespace {

using Bytes = std::vector<std::byte>;
using HostScalar = sk::program::Scalar;

template <class T>
void put(std::byte* target, T value) {
  std::memcpy(target, &value, sizeof value);
}

void putSample(std::byte* target, HostScalar scalar, unsigned bits) {
  switch (scalar) {
    case HostScalar::Bool: return put(target, sampleBool(bits));
    case HostScalar::Uint: return put(target, sampleUint(bits));
    case HostScalar::Float: return put(target, sampleFloat(bits));
    case HostScalar::Double: return put(target, sampleDouble(bits));
    default: break;
  }
  const int value = sampleInt(bits);
  std::memcpy(target, &value, sk::program::hostBytes(scalar));  // the low bytes: the host is little-endian
}

/// The elements that a parameter is given.
Bytes sampleElements(const sk::program::Parameter& parameter, int count) {
  const sk::program::Element& element = *parameter.element;
  Bytes bytes(element.size * static_cast<std::size_t>(count));
  for (const sk::program::Field& field : element.fields) {
    Path path(std::string(parameter.name).c_str());
    if (!field.path.empty() && field.path.front() != '[') path.add('.');
    path.add(std::string(field.path).c_str());
    const int first = field.part > 0 ? 2 * field.part : 0;  // a pair of components of a vector of doubles
    const std::size_t size = sk::program::hostBytes(field.scalar);
    for (int i = 0; i < count; ++i) {
      std::byte* target = bytes.data() + static_cast<std::size_t>(i) * element.size + field.offset;
      for (int c = 0; c < field.width; ++c)
        putSample(target + static_cast<std::size_t>(c) * size, field.scalar, sampleBits(path, i, first + c));
    }
  }
  return bytes;
}

sk::Shape shapeOf(const int (&extents)[highestRank], int rank) {
  switch (rank) {
    case 1: return {extents[0]};
    case 2: return {extents[1], extents[0]};
    case 3: return {extents[2], extents[1], extents[0]};
    default: return {extents[3], extents[2], extents[1], extents[0]};
  }
}

/// A kernel's arguments beside the common ones, which live as long as this.
class Samples {
 public:
  explicit Samples(sk::Device& device) : device_(device) {}

  sk::Argument argumentOf(const sk::program::Parameter& parameter) {
    if (parameter.role != sk::program::Role::Gather)
      return {.value = bytes_.emplace_back(sampleElements(parameter, 1)).data()};
    int extents[highestRank];
    const Path path(std::string(parameter.name).c_str());
    for (int d = 0; d < highestRank; ++d) extents[d] = gatherExtent(path, parameter.rank, d);
    const int count = elementsOf(extents);
    Untyped::element = &sk::program::heldBy(parameter);
    sk::Stream<Untyped>& stream =
        streams_.emplace_back(device_.stream<Untyped>(shapeOf(extents, parameter.rank)));
    sk::detail::write(stream.region(), sampleElements(parameter, count).data(),
                      static_cast<std::size_t>(count));
    return {.region = stream.region()};
  }

 private:
  sk::Device& device_;
  std::deque<Bytes> bytes_;
  std::deque<sk::Stream<Untyped>> streams_;
};

/// Runs a kernel on a domain of `rank`, whose elements are the first samples. The others give 0.
Outputs runKernel(sk::Device& device, const sk::program::Kernel& kernel, int rank) {
  const int(&extents)[highestRank] = domainExtents[rank - 1];
  const sk::Shape shape = shapeOf(extents, rank);
  const auto count = static_cast<std::size_t>(elementsOf(extents));
  auto a = device.stream<int>(shape), r0 = device.stream<int>(shape);
  auto b = device.stream<unsigned>(shape), r1 = device.stream<unsigned>(shape);
  auto c = device.stream<float>(shape), r2 = device.stream<float>(shape);
  a.write(std::span(inputs().a).first(count));
  b.write(std::span(inputs().b).first(count));
  c.write(std::span(inputs().c).first(count));
  const std::map<std::string_view, sk::StreamRegion> common = {
      {"a", sk::regionOf(a)},   {"b", sk::regionOf(b)},   {"c", sk::regionOf(c)},
      {"r0", sk::regionOf(r0)}, {"r1", sk::regionOf(r1)}, {"r2", sk::regionOf(r2)}};
  Samples samples(device);
  std::vector<sk::Argument> arguments;
  for (const sk::program::Parameter& parameter : kernel.parameters) {
    const auto found = common.find(parameter.name);
    arguments.push_back(found != common.end() ? sk::Argument{.region = found->second}
                                              : samples.argumentOf(parameter));
  }
  sk::run(kernel, arguments);
  Outputs outputs{.kernel = std::string(kernel.name)};
  r0.read(std::span(outputs.r0).first(count));
  r1.read(std::span(outputs.r1).first(count));
  r2.read(std::span(outputs.r2).first(count));
  return outputs;
}

}  // namespace

const std::vector<std::string> deviceTargets = {"native", "glsl330", "glsl430", "essl300", "essl310"};

NativeObject compileNative(const skc::ir::Module& module, const std::string& level) {
  std::vector<skc::native::KernelRequest> requests;
  NativeObject result;
  const skc::emit::Program program(module);
  for (const skc::emit::Unit& unit : program.units()) {
    const std::string symbol = "code_of_" + std::to_string(unit.id);
    requests.push_back({.kernel = unit.id, .symbol = symbol});
    result.symbols.push_back(symbol);
  }
  skc::native::Options options;
  if (!level.empty()) options.levels = {level};
  result.object = skc::native::compile(module, requests, skc::driver::compileLibrary, options,
                                       skc::native::Output::Object);
  return result;
}

sk::Device& Targets::device(const std::string& target) {
  const auto found = devices_.find(target);
  if (found != devices_.end()) return found->second;
  sk::DeviceOptions options;
  if (target == "native") {
    options.device = target;
  } else {
    options.profile = target;
  }
  return devices_.try_emplace(target, options).first->second;
}

std::string Targets::difference(const skc::ir::Module& module, const skc::emit::CodeOf& codeOf,
                                const std::vector<Outputs>& wanted) {
  const skc::emit::Program& program = programs_.emplace_back(module, skc::emit::Targets{}, codeOf);
  for (const std::string& target : deviceTargets) {
    if (names_.count(target) == 0) continue;
    std::map<std::string, std::size_t>
        instances;  // instances of one template have one name, and come in their order
    for (const Outputs& outputs : wanted) {
      const KernelName name = nameOf(outputs);
      std::size_t instance = instances[name.name]++;
      for (const skc::emit::Unit& unit : program.units()) {
        if (unit.kernel.name != name.name || instance-- != 0) continue;
        std::string wrong = cpp::difference(runKernel(device(target), unit.kernel, name.rank), outputs);
        if (!wrong.empty()) return target + ": " + wrong;
      }
    }
  }
  return {};
}

void Targets::release() {
  for (auto& [name, device] : devices_) device.release();
}

}  // namespace fuzz::cpp
