// SPDX-License-Identifier: MIT
#include "gl/known_devices.hpp"

#include <algorithm>
#include <cctype>
#include <type_traits>
#include <utility>

namespace sk::gl {

namespace {

constexpr std::pair<RendererKind, std::string_view> renderers[] = {
#define SK_RENDERER(kind, part) {RendererKind::kind, part},
#include "gl/known_devices.def"
};

constexpr DeviceTraits inSoftware{
#define SK_DEVICE_TRAIT(type, name, software, hardware, most, meaning, reason) .name = software,
#include "gl/known_devices.def"
};
constexpr DeviceTraits inHardware{
#define SK_DEVICE_TRAIT(type, name, software, hardware, most, meaning, reason) .name = hardware,
#include "gl/known_devices.def"
};

constexpr DeviceTraitRow rows[] = {
#define SK_DEVICE_TRAIT(type, name, software, hardware, most, meaning, reason)  \
  {#name,                                                                       \
   meaning,                                                                     \
   reason,                                                                      \
   std::is_same_v<type, bool>,                                                  \
   std::is_integral_v<type>,                                                    \
   double(most),                                                                \
   [](const DeviceTraits& traits) { return static_cast<double>(traits.name); }, \
   [](TraitChoices& choices, double value) { choices.name = static_cast<type>(value); }},
#include "gl/known_devices.def"
};

}  // namespace

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

RendererKind kindOf(std::string_view renderer) {
  const std::string name = lowerCase(renderer);
  for (const auto& [kind, part] : renderers) {
    if (name.find(part) != std::string::npos) return kind;
  }
  return RendererKind::Integrated;
}

std::string_view nameOf(RendererKind kind) {
  switch (kind) {
    case RendererKind::Software: return "software renderer";
    case RendererKind::Virtual: return "virtual GPU";
    case RendererKind::Integrated: return "integrated GPU";
    case RendererKind::Discrete: break;
  }
  return "discrete GPU";
}

TraitChoices TraitChoices::over(const TraitChoices& others) const {
  TraitChoices all = *this;
#define SK_DEVICE_TRAIT(type, name, software, hardware, most, meaning, reason) \
  if (!all.name) all.name = others.name;
#include "gl/known_devices.def"
  return all;
}

DeviceTraits traitsOf(RendererKind kind, const TraitChoices& choices) {
  const DeviceTraits& known = kind == RendererKind::Software ? inSoftware : inHardware;
  return {
#define SK_DEVICE_TRAIT(type, name, software, hardware, most, meaning, reason) \
  .name = choices.name.value_or(known.name),
#include "gl/known_devices.def"
  };
}

std::span<const DeviceTraitRow> deviceTraitRows() { return rows; }

}  // namespace sk::gl
