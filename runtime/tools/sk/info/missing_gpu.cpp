// SPDX-License-Identifier: MIT
#include "info/missing_gpu.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include <fmt/format.h>

namespace sk_tool {

namespace {

namespace fs = std::filesystem;

std::string firstLine(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// The files of a folder whose names begin with `start`, sorted.
std::vector<fs::path> filesNamed(const fs::path& folder, std::string_view start) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().starts_with(start)) found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

/// The PCI vendors of display controllers (class 03), which include virtual ones without 3D.
std::vector<std::string> displayVendors(const fs::path& root) {
  std::vector<std::string> vendors;
  for (const fs::path& device : filesNamed(root / "sys/bus/pci/devices", "")) {
    if (firstLine(device / "class").starts_with("0x03")) vendors.push_back(firstLine(device / "vendor"));
  }
  return vendors;
}

std::string withoutAccess(const Machine& machine, const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    if (machine.mayUse(file)) continue;
    return fmt::format(
        "this user has no rights on {}: usermod -aG render,video $USER, then log in again, or in a container "
        "pass the file on with its group",
        "/" + file.lexically_relative(machine.root).string());
  }
  return {};
}

/// NVIDIA's driver has its own EGL library.
std::string whyNoNvidia(const Machine& machine, const std::vector<fs::path>& files) {
  if (files.empty()) {
    return "there is a GPU of NVIDIA, but no /dev/nvidia0: its kernel driver is not loaded (nvidia-smi says "
           "more), or in a "
           "container the GPU is not passed on (docker run --gpus all)";
  }
  if (!machine.canLoad("libEGL_nvidia.so.0")) {
    return "there is a GPU of NVIDIA, but not its library libEGL_nvidia.so.0: install the driver's package "
           "for GL (libnvidia-gl, or "
           "on Debian nvidia-egl-icd); in a container set "
           "NVIDIA_DRIVER_CAPABILITIES=graphics,compute,utility";
  }
  return withoutAccess(machine, files);
}

}  // namespace

Machine thisMachine() {
  return {.root = "/",
          .canLoad =
              [](const std::string& library) {
                void* handle = ::dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
                if (handle != nullptr) ::dlclose(handle);
                return handle != nullptr;
              },
          .mayUse = [](const fs::path& file) { return ::access(file.c_str(), R_OK | W_OK) == 0; }};
}

std::string whyNoGpu(const Machine& machine) {
  if (!machine.canLoad("libEGL.so.1")) return "libEGL.so.1 is not installed: apt-get install libegl1";
  const std::vector<std::string> vendors = displayVendors(machine.root);
  const std::vector<fs::path> renderNodes = filesNamed(machine.root / "dev/dri", "renderD");
  const std::vector<fs::path> nvidia = filesNamed(machine.root / "dev", "nvidia0");
  if (!nvidia.empty() || std::ranges::find(vendors, "0x10de") != vendors.end()) {
    if (std::string why = whyNoNvidia(machine, nvidia); !why.empty()) return why;
  }
  if (std::string why = withoutAccess(machine, renderNodes); !why.empty()) return why;
  if (!renderNodes.empty()) {
    return "there is a GPU, but its driver gives no context that serves: apt-get install libgl1-mesa-dri, "
           "and see what "
           "SK_DEVICE=gpu reports";
  }
  if (vendors.empty()) {
    return "the system knows of none: no display controller on its PCI bus, no /dev/dri/renderD128, no "
           "/dev/nvidia0. In a virtual machine or a "
           "container the GPU has to be passed on (docker run --device /dev/dri, or --gpus all)";
  }
  return "there is a display controller, but no /dev/dri/renderD128: it has no 3D, its kernel driver is not "
         "loaded, or a container "
         "does not pass it on (docker run --device /dev/dri)";
}

}  // namespace sk_tool
