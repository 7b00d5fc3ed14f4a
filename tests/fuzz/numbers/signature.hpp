// SPDX-License-Identifier: MIT
//
// Calls the generated objects of kernels, whose parameters are typed, with the untyped streams of a Call.
#pragma once

#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>

#include "numbers/operations.hpp"
#include "sk/sk.hpp"

namespace fuzz::numbers {

template <class T>
constexpr Element elementOf() {
  if constexpr (std::is_same_v<T, float>) return Element::Float;
  if constexpr (std::is_same_v<T, sk::float3>) return Element::Float3;
  if constexpr (std::is_same_v<T, double>) return Element::Double;
  if constexpr (std::is_same_v<T, std::int32_t>) return Element::Int;
  return Element::Uint;
}

template <class T>
void appendComponents(const T& element, Values& values) {
  if constexpr (std::is_same_v<T, sk::float3>) {
    for (const float x : {element.x, element.y, element.z}) values.push_back(x);
  } else {
    values.push_back(static_cast<double>(element));
  }
}

template <class T, Data data = Data::Arguments>
struct Elements {
  static constexpr Parameter parameter{elementOf<T>(), Role::Elements, data};
  static sk::ElementIn<T> argument(const Call& call, std::size_t i) {
    if (call.rows != nullptr) return sk::InRows<T>{call.inputs[i], call.rows};
    return sk::View<const T>(call.inputs[i]);
  }
};
/// Elements that the kernel reads by gathering.
template <class T, Data data = Data::Arguments>
struct Gathered {
  static constexpr Parameter parameter{elementOf<T>(), Role::Elements, data};
  static sk::View<const T> argument(const Call& call, std::size_t i) {
    return sk::View<const T>(call.inputs[i]);
  }
};
template <class T, Data data = Data::Arguments>
struct Table {
  static constexpr Parameter parameter{elementOf<T>(), Role::Table, data};
  static sk::View<const T> argument(const Call& call, std::size_t i) {
    return sk::View<const T>(call.inputs[i]);
  }
};
template <class T, Data data = Data::Integers>
struct Uniform {
  static constexpr Parameter parameter{elementOf<T>(), Role::Uniform, data};
  static T argument(const Call& call, std::size_t i) { return static_cast<T>(call.uniforms[i]->front()); }
};

/// The parameters of a kernel: Inputs<Elements<float>, ...> and Outputs<float, ...>.
template <class... P>
struct Inputs {
  static std::vector<Parameter> parameters() { return {P::parameter...}; }
  static constexpr std::size_t count = sizeof...(P);
  template <std::size_t i>
  using At = std::tuple_element_t<i, std::tuple<P...>>;
};
template <class... T>
struct Outputs {
  static std::vector<Element> elements() { return {elementOf<T>()...}; }
  static constexpr std::size_t count = sizeof...(T);
  template <std::size_t i>
  using At = std::tuple_element_t<i, std::tuple<T...>>;
};

template <const auto& kernel, class In, class Out>
void callKernel(const Call& call) {
  const auto object = kernel.with(call.options);
  [&]<std::size_t... i, std::size_t... o>(std::index_sequence<i...>, std::index_sequence<o...>) {
    if (call.values == nullptr) {
      object(In::template At<i>::argument(call, i)...,
             sk::View<typename Out::template At<o>>(call.outputs[o])...);
      return;
    }
    if constexpr (requires { [](auto&&) {}(object(In::template At<i>::argument(call, i)...)); }) {
      const auto results = [&] {
        auto got = object(In::template At<i>::argument(call, i)...);
        if constexpr (Out::count == 1) {
          return std::tuple(got);
        } else {
          return got;
        }
      }();
      call.values->resize(Out::count);
      (appendComponents(std::get<o>(results), (*call.values)[o]), ...);
    }
  }(std::make_index_sequence<In::count>(), std::make_index_sequence<Out::count>());
}

}  // namespace fuzz::numbers
