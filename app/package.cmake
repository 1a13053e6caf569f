# What `cmake --install` puts where, and the packages that `cpack` makes of it: two .deb files and a .tar.gz.
# The viewer's component is here; the simulated runtime's, "runtime", is in xr/simulated.
include(GNUInstallDirs)

install(TARGETS binosplat RUNTIME COMPONENT viewer)
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/binosplat COMPONENT viewer)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT viewer PATTERN "*.py" EXCLUDE)
install(FILES README.md CONTRIBUTING.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT viewer)
install(FILES third_party/NOTICES.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/third_party COMPONENT viewer)  # where the pages link to it
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT viewer)             # where Debian looks for it

# The man page and the completions are what the program itself says.
if(NOT CMAKE_CROSSCOMPILING)
    set(documents ${CMAKE_CURRENT_BINARY_DIR}/documents)
    foreach(document "man binosplat.1 man/man1" "bash binosplat bash-completion/completions" "zsh _binosplat zsh/vendor-completions"
                     "fish binosplat.fish fish/vendor_completions.d")
        string(REPLACE " " ";" document ${document})
        list(GET document 0 kind)
        list(GET document 1 name)
        list(GET document 2 folder)
        install(CODE "file(MAKE_DIRECTORY ${documents}/${kind})
            execute_process(COMMAND $<TARGET_FILE:binosplat> document ${kind} OUTPUT_FILE ${documents}/${kind}/${name} COMMAND_ERROR_IS_FATAL ANY)"
            COMPONENT viewer)
        install(FILES ${documents}/${kind}/${name} DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder} COMPONENT viewer)
    endforeach()
endif()

set(CPACK_PACKAGE_NAME binosplat)
set(CPACK_PACKAGE_VENDOR "the binosplat authors")
set(CPACK_PACKAGE_CONTACT "the binosplat authors")
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/app/package_version.cmake)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Gaussian splatting scenes in a VR headset")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR TGZ DEB)
set(CPACK_COMPONENTS_ALL viewer)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_VIEWER_PACKAGE_NAME binosplat)
set(CPACK_DEBIAN_VIEWER_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_VIEWER_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd, fonts-dejavu-core")
set(CPACK_DEBIAN_VIEWER_PACKAGE_SUGGESTS "fonts-noto-cjk | fonts-droid-fallback")
set(CPACK_COMPONENT_VIEWER_DESCRIPTION "binosplat renders scenes of 2D and 3D Gaussian splats for both eyes of an OpenXR headset, one eye from the other where that pays.")
if(BINOSPLAT_OPENXR)
    list(APPEND CPACK_COMPONENTS_ALL runtime)
    string(APPEND CPACK_DEBIAN_VIEWER_PACKAGE_SUGGESTS ", binosplat-simulated-runtime")
    set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME binosplat-simulated-runtime)
    set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION devel)
    set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "python3, libopenxr-loader1, mesa-vulkan-drivers | vulkan-icd")
    set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "An OpenXR runtime without a headset: tests of OpenXR programs load it, move its head and hands by script, and get the pictures that a wearer would see.")
endif()
include(CPack)
