# The package for Windows: one .zip that runs wherever it is unpacked. The program finds the simulated runtime
# and configs/ beside itself.
install(TARGETS binosplat RUNTIME DESTINATION . COMPONENT windows)
install(DIRECTORY configs DESTINATION . COMPONENT windows)
install(DIRECTORY docs DESTINATION . COMPONENT windows PATTERN "*.py" EXCLUDE)
install(FILES README.md CONTRIBUTING.md CHANGELOG.md LICENSE DESTINATION . COMPONENT windows)
install(FILES third_party/NOTICES.md DESTINATION third_party COMPONENT windows)  # where the pages link to it
if(BINOSPLAT_OPENXR)
    install(TARGETS binosplat_simulated_runtime RUNTIME DESTINATION . COMPONENT windows)
    install(FILES ${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/simulated_runtime.json ${FRIBIDI_DLL} DESTINATION . COMPONENT windows)
    install(PROGRAMS xr/simulated/compare_frame_logs.py DESTINATION . COMPONENT windows)
endif()
# Of everything that is linked: third_party/windows/libraries.sh has gathered them, and the compiler's own
# come from its packages.
if(windows_prefix)
    install(DIRECTORY ${windows_prefix}/licences DESTINATION . COMPONENT windows)
endif()

set(CPACK_PACKAGE_NAME binosplat)
set(CPACK_PACKAGE_VENDOR "the binosplat authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Gaussian splatting scenes in a VR headset")
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/app/package_version.cmake)
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_SYSTEM_NAME windows-x64)
set(CPACK_GENERATOR ZIP)
set(CPACK_COMPONENTS_ALL windows)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
include(CPack)
