// SPDX-License-Identifier: MIT
#include "gl/known_devices.hpp"

#include <catch2/catch.hpp>

#include <set>
#include <string_view>
#include <utility>

namespace sk::gl {
namespace {

TEST_CASE("kinds of renderers are told by their names") {
  const std::pair<const char*, RendererKind> known[] = {
      {"llvmpipe (LLVM 15.0.6, 256 bits)", RendererKind::Software},
      {"softpipe", RendererKind::Software},
      {"Software Rasterizer", RendererKind::Software},
      {"Mesa swrast", RendererKind::Software},
      {"Google SwiftShader", RendererKind::Software},
      {"ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero)), SwiftShader driver)",
       RendererKind::Software},
      {"D3D12 (Microsoft Basic Render Driver)", RendererKind::Software},
      {"ANGLE (Microsoft, Microsoft Basic Render Driver (0x0000008C) Direct3D11 vs_5_0 ps_5_0, D3D11)",
       RendererKind::Software},
      {"virgl (Mesa Intel(R) UHD Graphics 620 (KBL GT2))", RendererKind::Virtual},
      {"SVGA3D; build: RELEASE;  LLVM;", RendererKind::Virtual},
      {"Mesa Intel(R) UHD Graphics 620 (KBL GT2)", RendererKind::Integrated},
      {"Mesa Intel(R) Arc(tm) Graphics (MTL)", RendererKind::Integrated},
      {"AMD Radeon Graphics (radeonsi, renoir, LLVM 15.0.6, DRM 3.49, 6.1.0)", RendererKind::Integrated},
      {"NVIDIA Tegra Orin (nvgpu)/integrated", RendererKind::Integrated},
      {"V3D 4.2", RendererKind::Integrated},
      {"Mali-G610", RendererKind::Integrated},
      {"Adreno (TM) 640", RendererKind::Integrated},
      {"NVIDIA H200/PCIe/SSE2", RendererKind::Discrete},
      {"D3D12 (NVIDIA GeForce RTX 3080)", RendererKind::Discrete},
      {"AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.6, DRM 3.49, 6.1.0)", RendererKind::Discrete},
      {"Mesa Intel(R) Arc(tm) A770 Graphics (DG2)", RendererKind::Discrete},
  };
  for (const auto& [name, kind] : known) {
    CAPTURE(name);
    CHECK(nameOf(kindOf(name)) == nameOf(kind));
  }
  CHECK(RendererKind::Software < RendererKind::Virtual);
  CHECK(RendererKind::Virtual < RendererKind::Integrated);
  CHECK(RendererKind::Integrated < RendererKind::Discrete);
}

TEST_CASE("each constant of a device has a name, a value within its range, and a choice that replaces it") {
  std::set<std::string_view> names;
  for (const DeviceTraitRow& row : deviceTraitRows()) {
    CAPTURE(row.name);
    CHECK(names.insert(row.name).second);
    CHECK_FALSE(row.meaning.empty());
    CHECK_FALSE(row.reason.empty());
    for (const RendererKind kind : {RendererKind::Software, RendererKind::Discrete}) {
      const double usual = row.get(traitsOf(kind, {}));
      CHECK((usual >= 0 && usual <= row.most));
      const double other = usual == 0 ? 1 : 0;
      TraitChoices choices;
      row.choose(choices, other);
      CHECK(row.get(traitsOf(kind, choices)) == other);
      CHECK(row.get(traitsOf(kind, TraitChoices().over(choices))) == other);
      TraitChoices first;
      row.choose(first, usual);
      CHECK(row.get(traitsOf(kind, first.over(choices))) == usual);
      for (const DeviceTraitRow& another : deviceTraitRows()) {
        if (another.name != row.name)
          CHECK(another.get(traitsOf(kind, choices)) == another.get(traitsOf(kind, {})));
      }
    }
  }
}

}  // namespace
}  // namespace sk::gl
