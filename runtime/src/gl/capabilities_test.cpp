// SPDX-License-Identifier: MIT
#include "gl/capabilities.hpp"

#include <catch2/catch.hpp>

using sk::gl::isSoftwareRenderer;

TEST_CASE("renderers that run on the processor are told from GPUs by their names") {
  for (const char* name :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "Software Rasterizer", "Mesa swrast",
        "Google SwiftShader",
        "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero)), SwiftShader driver)",
        "D3D12 (Microsoft Basic Render Driver)",
        "ANGLE (Microsoft, Microsoft Basic Render Driver (0x0000008C) Direct3D11 vs_5_0 ps_5_0, D3D11)"}) {
    CAPTURE(name);
    CHECK(isSoftwareRenderer(name));
  }
  for (const char* name :
       {"NVIDIA H200/PCIe/SSE2", "Mesa Intel(R) UHD Graphics 620 (KBL GT2)", "AMD Radeon RX 6800 (navi21)",
        "D3D12 (NVIDIA GeForce RTX 3080)", "V3D 4.2", "Mali-G610"}) {
    CAPTURE(name);
    CHECK_FALSE(isSoftwareRenderer(name));
  }
}
