# SPDX-License-Identifier: MIT
#
# What only our own build wants: a build type where none is given, and ccache where it is installed.
# A project that takes StreamKernel in decides these itself.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(SK_CCACHE ccache)
mark_as_advanced(SK_CCACHE)
if(SK_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  # it keeps what is compiled with precompiled headers, too
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND};-E;env;CCACHE_SLOPPINESS=pch_defines,time_macros;${SK_CCACHE}")
endif()
