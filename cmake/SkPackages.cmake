# SPDX-License-Identifier: MIT
#
# How a dependency is asked for: sk_need stops with the name of the Debian package that has it.

# sk_need(PACKAGE DEBIAN_PACKAGE [ARGUMENTS of find_package...])
macro(sk_need package debianPackage)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "StreamKernel: ${package} not found (${ARGN}).\n"
      "  On Debian: apt-get install ${debianPackage}\n"
      "  Elsewhere: give its place by CMAKE_PREFIX_PATH.")
  endif()
endmacro()

# sk_need_module(TARGET MODULE DEBIAN_PACKAGE): a pkg-config module as PkgConfig::TARGET.
macro(sk_need_module target module debianPackage)
  sk_need(PkgConfig pkg-config)
  if(NOT TARGET PkgConfig::${target})
    pkg_check_modules(${target} QUIET IMPORTED_TARGET GLOBAL ${module})
    if(NOT ${target}_FOUND)
      message(FATAL_ERROR "StreamKernel: ${module} not found by pkg-config.\n"
        "  On Debian: apt-get install ${debianPackage}\n"
        "  Elsewhere: give its place by PKG_CONFIG_PATH.")
    endif()
  endif()
endmacro()
