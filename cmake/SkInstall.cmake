# SPDX-License-Identifier: MIT
#
# What `cmake --install` puts where: skc, sk, the runtime's libraries and headers, and the CMake package
# that finds them wherever the folder is moved to. Nothing else: prelude and intrinsics are in skc.
include(CMakePackageConfigHelpers)

set(packageFolder "${CMAKE_INSTALL_LIBDIR}/cmake/StreamKernel")

foreach(library runtime gl assemble toml text linear)
  install(TARGETS sk_${library} EXPORT StreamKernelTargets)
  set_target_properties(sk_${library} PROPERTIES EXPORT_NAME ${library})
endforeach()
if(TARGET sk_mpi)   # targets of their own: they need an MPI where they are used
  install(TARGETS sk_mpi EXPORT StreamKernelMpiTargets)
  set_target_properties(sk_mpi PROPERTIES EXPORT_NAME mpi)
  install(EXPORT StreamKernelMpiTargets NAMESPACE sk:: DESTINATION "${packageFolder}")
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/runtime/mpi/include/sk" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
endif()
install(EXPORT StreamKernelTargets NAMESPACE sk:: DESTINATION "${packageFolder}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/runtime/include/sk" "${PROJECT_SOURCE_DIR}/runtime/linear/include/sk" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.def")

if(SK_BUILD_COMPILER)
  # An LLVM outside of the linker's own folders is found by the installed skc too.
  set_target_properties(skc PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
  install(TARGETS skc)
endif()

if(SK_BUILD_TOOLS)
  install(TARGETS sk)
endif()

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/StreamKernelConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/StreamKernelConfig.cmake"
  INSTALL_DESTINATION "${packageFolder}" PATH_VARS CMAKE_INSTALL_BINDIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/StreamKernelConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_BINARY_DIR}/StreamKernelConfig.cmake"
  "${PROJECT_BINARY_DIR}/StreamKernelConfigVersion.cmake"
  "${PROJECT_SOURCE_DIR}/compiler/SkKernels.cmake"
  DESTINATION "${packageFolder}")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
