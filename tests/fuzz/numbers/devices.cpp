// SPDX-License-Identifier: MIT
#include "numbers/devices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <variant>

#include <fmt/format.h>

#include "numbers/operations.hpp"
#include "numbers/signature.hpp"

namespace fuzz::numbers {
namespace {

template <class T>
T elementAt(const Values& values, std::size_t i) {
  if constexpr (std::is_same_v<T, sk::float3>) {
    return {static_cast<float>(values[3 * i]), static_cast<float>(values[3 * i + 1]),
            static_cast<float>(values[3 * i + 2])};
  } else {
    return static_cast<T>(values[i]);
  }
}

/// A number that would be noticed if it took part.
template <class T>
T poison() {
  if constexpr (std::is_same_v<T, sk::float3>) {
    return {-0x1.8p100F, -0x1.8p100F, -0x1.8p100F};
  } else if constexpr (std::is_floating_point_v<T>) {
    return T(-0x1.8p100);
  } else {
    return T(123456789);
  }
}

/// A stream, and the elements of it that the call sees.
template <class T>
struct Placed {
  sk::Stream<T> stream;
  sk::StreamRegion region;
};

template <class T>
Placed<T> place(sk::Device& device, const std::vector<std::int64_t>& extents, View view,
                sk::Storage storage) {
  std::vector<std::int64_t> whole = extents;
  const int rank = static_cast<int>(extents.size());
  sk::Index begin = sk::Index::origin(rank), end = begin, steps = begin, offsets = begin;
  for (int d = 0; d < rank; ++d) {
    const auto at = static_cast<std::size_t>(d);
    begin[d] = 1 + d;
    end[d] = begin[d] + extents[at];
    steps[d] = d == rank - 1 ? 2 : 1;
    offsets[d] = 1;
    if (view == View::Box) whole[at] = end[d] + 1;
    if (view == View::Strided) whole[at] = offsets[d] + steps[d] * extents[at];
  }
  if (view == View::Reshaped) whole = {shapeOf(extents).size()};
  Placed<T> made{device.stream<T>(shapeOf(whole), storage), {}};
  if (view != View::Whole) made.stream.fill(poison<T>());
  switch (view) {
    case View::Whole: made.region = made.stream.region(); break;
    case View::Box: made.region = made.stream.domain(begin, end).region(); break;
    case View::Strided: made.region = sk::stride(made.stream, steps, offsets).region(); break;
    case View::Reshaped: made.region = made.stream.reshape(shapeOf(extents)).region(); break;
  }
  return made;
}

using AnyStream = std::variant<sk::Stream<float>, sk::Stream<sk::float3>, sk::Stream<double>,
                               sk::Stream<std::int32_t>, sk::Stream<std::uint32_t>>;

/// Calls with(T()) for the type of an element.
template <class With>
auto withElement(Element element, const With& with) {
  switch (element) {
    case Element::Float: return with(float());
    case Element::Float3: return with(sk::float3());
    case Element::Double: return with(double());
    case Element::Int: return with(std::int32_t());
    case Element::Uint: break;
  }
  return with(std::uint32_t());
}

Values read(Element element, const sk::StreamRegion& region) {
  return withElement(element, [&]<class T>(T) {
    Values values;
    for (const T& one : sk::View<const T>(region).read()) appendComponents(one, values);
    return values;
  });
}

bool isReal(Element element) { return element == Element::Float || element == Element::Float3; }

}  // namespace

const std::vector<std::string> targetNames = {"native", "glsl330", "glsl430", "essl300", "essl310", "webgl2"};

bool canRun(const std::string& target, const Case& one) {
  const Operation& operation = operationNamed(one.operation);
  const bool isNative = target == "native", isWeb = target == "webgl2",
             isPairs = one.isPairs || isWeb || target.starts_with("essl");
  if (one.options.contraction == sk::Contraction::Fast && !isNative) return false;
  if (one.options.precision == sk::Precision::Double && (isPairs && !isNative)) return false;
  if (isNative) return true;
  if (isWeb) {  // docs/browser.md, How it differs from C++
    const bool isMap = operation.kind == Kind::Map, isWhole = one.view == View::Whole;
    const bool hasVariants = operation.name == "operators" || operation.name == "literals";
    if (!one.starts.empty() || one.view == View::Reshaped || one.storage != sk::Storage::Single ||
        one.textureLimit != 0)
      return false;
    if (!isWhole && (isMap || operation.kind == Kind::Fold)) return false;
    // its neighbours are read without a test for the ends only where none of them is further away than the stream is long
    if (operation.name == "foldedNeighbors" && one.shape.back() <= 17) return false;
    return one.options.precision == sk::Precision::Default || hasVariants;
  }
  return one.storage != sk::Storage::Double || !target.starts_with("essl");
}

bool isToValue(const Case& one) {
  return operationNamed(one.operation).kind == Kind::Reduce && one.result.empty() && one.starts.empty();
}

std::vector<std::vector<std::int64_t>> outputShapes(const Case& one) {
  const Operation& operation = operationNamed(one.operation);
  std::vector<std::vector<std::int64_t>> shapes;
  std::size_t component = 0;
  for (const Element output : operation.outputs) {
    const bool isFolded = component >= operation.componentsOfElementOutputs() && operation.kind != Kind::Scan;
    component += static_cast<std::size_t>(components(output));
    std::vector<std::int64_t> shape = one.shape;
    if (isFolded && !one.starts.empty()) {
      shape = {static_cast<std::int64_t>(one.starts.size()) - 1};
    } else if (isFolded) {
      shape = one.result.empty() ? std::vector<std::int64_t>(one.shape.size(), 1) : one.result;
    }
    shapes.push_back(shape);
  }
  return shapes;
}

Arithmetic arithmeticOf(const std::string& target, const Case& one) {
  const bool isNative = target == "native";
  return {{.isNative = isNative,
           .flushesDenormals = !isNative,
           .hasPairs = !isNative && (one.isPairs || target.starts_with("essl") || target == "webgl2"),
           .isDispatched = target == "glsl430" || target == "essl310"}};
}

Arithmetic Devices::arithmetic(const std::string& target, const Case& one) {
  Arithmetic result = arithmeticOf(target, one);
  if (!result.isNative) result.roundsQuotients = roundsQuotients(target);
  return result;
}

bool Devices::roundsQuotients(const std::string& target) {
  const auto found = roundsQuotients_.find(target);
  if (found != roundsQuotients_.end()) return found->second;
  constexpr std::int64_t count = 4096;
  std::mt19937 random(1);
  const auto number = [&] { return std::ldexp(static_cast<double>(random() >> 9U | 1U << 23U), -23); };
  Case trial;
  trial.operation = "operators";
  trial.shape = {count};
  trial.inputs.assign(2, Values(count));
  for (Values& values : trial.inputs) std::ranges::generate(values, number);
  const Values quotients = run(target, trial)[3];
  bool isEach = true;
  for (std::size_t i = 0; i < quotients.size(); ++i) {
    const auto a = static_cast<float>(trial.inputs[0][i]), b = static_cast<float>(trial.inputs[1][i]);
    isEach = isEach && quotients[i] == static_cast<double>(a / b);
  }
  return roundsQuotients_[target] = isEach;
}

sk::Device& Devices::device(const std::string& target, const Case& one) {
  const bool isNative = target == "native";
  const std::string key = isNative ? target : fmt::format("{} {} {}", target, one.textureLimit, one.isPairs);
  const auto found = devices_.find(key);
  if (found != devices_.end()) return found->second;
  if (isNative) return devices_.try_emplace(key, sk::Device::native()).first->second;
  const sk::DeviceOptions options{
      .profile = target, .textureLimit = one.textureLimit, .doubles = one.isPairs ? "pairs" : ""};
  return devices_.try_emplace(key, options).first->second;
}

std::vector<Values> Devices::run(const std::string& target, const Case& one) {
  const Operation& operation = operationNamed(one.operation);
  sk::Device& on = device(target, one);
  Call call;
  call.options = one.options;
  std::vector<AnyStream> streams;
  for (std::size_t k = 0; k < operation.inputs.size(); ++k) {
    const Parameter& parameter = operation.inputs[k];
    const Values& values = one.inputs[k];
    call.uniforms.push_back(parameter.role == Role::Uniform ? &values : nullptr);
    if (parameter.role == Role::Uniform) {
      call.inputs.emplace_back();
      continue;
    }
    const bool isTable = parameter.role == Role::Table;
    withElement(parameter.element, [&]<class T>(T) {
      const auto count = values.size() / static_cast<std::size_t>(components(parameter.element));
      const std::vector<std::int64_t> shape =
          isTable ? std::vector{static_cast<std::int64_t>(count)} : one.shape;
      auto placed = place<T>(on, shape, isTable ? View::Whole : one.view,
                             isReal(parameter.element) ? one.storage : sk::Storage::Single);
      std::vector<T> elements;
      for (std::size_t i = 0; i < count; ++i) elements.push_back(elementAt<T>(values, i));
      sk::View<T>(placed.region).write(elements);
      call.inputs.push_back(placed.region);
      streams.emplace_back(std::move(placed.stream));
    });
  }
  std::optional<sk::Stream<std::int32_t>> starts;
  std::optional<sk::Rows> rows;
  if (!one.starts.empty()) {
    starts = on.stream<std::int32_t>({static_cast<std::int64_t>(one.starts.size())});
    starts->write(std::vector<std::int32_t>(one.starts.begin(), one.starts.end()));
    rows.emplace(*starts);
    call.rows = (*rows)(*starts).rows;
  }
  std::vector<Values> results;
  if (isToValue(one)) {
    call.values = &results;
    operation.call(call);
    return results;
  }
  const std::vector<std::vector<std::int64_t>> shapes = outputShapes(one);
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    withElement(operation.outputs[k], [&]<class T>(T) {
      auto placed = place<T>(on, shapes[k], one.view, sk::Storage::Single);
      call.outputs.push_back(placed.region);
      streams.emplace_back(std::move(placed.stream));
    });
  }
  operation.call(call);
  for (std::size_t k = 0; k < operation.outputs.size(); ++k)
    results.push_back(read(operation.outputs[k], call.outputs[k]));
  return results;
}

}  // namespace fuzz::numbers
