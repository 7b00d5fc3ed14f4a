// SPDX-License-Identifier: MIT
//
// What StreamKernel knows of devices by their names: known_devices.def as types and functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sk::gl {

/// In the order in which a machine's renderers are preferred, the best one last.
enum class RendererKind : std::uint8_t { Software, Virtual, Integrated, Discrete };

/// `text` with the letters of ASCII in lower case, as parts of renderers' names are compared.
std::string lowerCase(std::string_view text);

/// The kind of a renderer of this name (GL_RENDERER).
RendererKind kindOf(std::string_view renderer);

/// "software renderer", "virtual GPU", "integrated GPU" or "discrete GPU".
std::string_view nameOf(RendererKind kind);

/// The constants of a device. known_devices.def has their meanings.
struct DeviceTraits {
#define SK_DEVICE_TRAIT(type, name, software, hardware, most, meaning, reason) type name;
#include "gl/known_devices.def"
};

/// Constants that somebody chooses; those that are empty keep their values.
struct TraitChoices {
#define SK_DEVICE_TRAIT(type, name, software, hardware, most, meaning, reason) std::optional<type> name = {};
#include "gl/known_devices.def"

  /// These, and the others' where these are empty.
  TraitChoices over(const TraitChoices& others) const;
};

DeviceTraits traitsOf(RendererKind kind, const TraitChoices& choices);

/// A row of known_devices.def.
struct DeviceTraitRow {
  std::string_view name, meaning, reason;
  bool isBool, isWhole;
  double most;  ///< the largest value; the least is 0
  double (*get)(const DeviceTraits& traits);
  void (*choose)(TraitChoices& choices, double value);
};
std::span<const DeviceTraitRow> deviceTraitRows();

}  // namespace sk::gl
