# The library, its manifest for XR_RUNTIME_JSON, and the tool that compares two logs. The manifest finds the library relative to itself.
include(GNUInstallDirs)
set(manifest_folder ${CMAKE_INSTALL_DATADIR}/openxr/1)
file(RELATIVE_PATH library_folder /prefix/${manifest_folder} /prefix/${CMAKE_INSTALL_LIBDIR})
set(SIMULATED_LIBRARY_PATH ${library_folder}/lib${SIMULATED_NAME}.so)
configure_file(simulated_runtime.json.in ${CMAKE_BINARY_DIR}/install/${SIMULATED_NAME}.json @ONLY)
install(TARGETS binosplat_simulated_runtime LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime)
install(FILES ${CMAKE_BINARY_DIR}/install/${SIMULATED_NAME}.json DESTINATION ${manifest_folder} COMPONENT runtime)
install(PROGRAMS compare_frame_logs.py DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME compare_frame_logs COMPONENT runtime)
