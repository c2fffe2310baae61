# cmake --install: program, headers and CMake package, RTL with what is generated for it, scenarios, shell completion.
include(CMakePackageConfigHelpers)
set(share ${CMAKE_INSTALL_DATADIR}/hemi)

install(TARGETS hemi hemi_board_sim RUNTIME)
install(DIRECTORY scripts/scenarios DESTINATION ${share})
# What a program in the build directory finds in the same way as an installed one.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/hemi)
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/scripts/scenarios ${CMAKE_BINARY_DIR}/share/hemi/scenarios SYMBOLIC)

# The core and its double-precision model: find_package(hemi), hemi::core, hemi::golden. Includes are those of the tree.
set(headers ${CMAKE_INSTALL_INCLUDEDIR}/hemi)
install(DIRECTORY hls DESTINATION ${headers} FILES_MATCHING PATTERN *.hpp)
install(DIRECTORY golden/chain DESTINATION ${headers}/golden FILES_MATCHING PATTERN *.hpp)
install(FILES ${CMAKE_BINARY_DIR}/rtl/hemi_registers.h DESTINATION ${headers})
install(TARGETS hemi_hls hemi_chain EXPORT hemi ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/hemi)
install(EXPORT hemi NAMESPACE hemi:: FILE hemiTargets.cmake DESTINATION ${package})
configure_package_config_file(cmake/hemiConfig.cmake.in ${CMAKE_BINARY_DIR}/hemiConfig.cmake INSTALL_DESTINATION ${package}
  PATH_VARS share NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/hemiConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/hemiConfig.cmake ${CMAKE_BINARY_DIR}/hemiConfigVersion.cmake DESTINATION ${package})

# Everything that a synthesizer or a simulator reads, as rtl/hemi.core (FuseSoC) names it.
install(DIRECTORY rtl/ DESTINATION ${share}/rtl
  FILES_MATCHING PATTERN *.sv PATTERN *.pcf PATTERN hemi.core PATTERN microcode EXCLUDE PATTERN registers EXCLUDE)
install(FILES ${CMAKE_BINARY_DIR}/rtl/hemi_registers_pkg.sv DESTINATION ${share}/rtl)
foreach(instrument reference wide)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/rtl/${instrument} DESTINATION ${share}/rtl FILES_MATCHING PATTERN *.sv)
endforeach()

# Completion, made by the program that it completes.
set(completion ${CMAKE_BINARY_DIR}/completion)
file(MAKE_DIRECTORY ${completion})
foreach(shell bash zsh fish)
  add_custom_command(OUTPUT ${completion}/${shell} COMMAND hemi completion ${shell} > ${completion}/${shell} DEPENDS hemi VERBATIM)
endforeach()
add_custom_target(hemi_completion ALL DEPENDS ${completion}/bash ${completion}/zsh ${completion}/fish)
install(FILES ${completion}/bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME hemi)
install(FILES ${completion}/zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _hemi)
install(FILES ${completion}/fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME hemi.fish)

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
