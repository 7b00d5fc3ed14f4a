# SPDX-License-Identifier: MIT
#
# What only our own build wants: a build type where none is given, ccache where it is installed, and a fast linker.
# A project that takes StreamKernel in decides these itself.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(SK_CCACHE ccache)
mark_as_advanced(SK_CCACHE)
if(SK_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  # It keeps what is compiled with precompiled headers, too. It asks the compiler which files were read: if it preprocessed a header that
  # is to be precompiled anew, g++ would take the old one in place of the text.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND};-E;env;CCACHE_SLOPPINESS=pch_defines,time_macros;CCACHE_DEPEND=1;${SK_CCACHE}")
endif()

# The hundred programs of the tests link in half of the time with gold, which is a part of binutils up to 2.43, and in a quarter with lld.
set(SK_LINKER "" CACHE STRING "Linker of our own programs, as -fuse-ld names it (empty: lld or gold where they work)")
include(CheckLinkerFlag)
foreach(linker IN ITEMS lld gold)
  if(NOT SK_LINKER)
    check_linker_flag(CXX "-fuse-ld=${linker}" SK_HAS_${linker})
    if(SK_HAS_${linker})
      set(SK_LINKER ${linker})
    endif()
  endif()
endforeach()
if(SK_LINKER)
  add_link_options("-fuse-ld=${SK_LINKER}")
endif()
