# What is special about the packages for aarch64. They are for any distribution since 2022: libraries that one
# of these may lack, or have in another version, come with the program, and their licences with them. The
# others are named in the package's Depends.
set(system_libraries ${CMAKE_SYSROOT}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE})
foreach(library zip bz2 OpenEXR-* Iex-* IlmThread-* Imath-* openxr_loader jsoncpp glfw stb webp fmt)
    file(GLOB files ${system_libraries}/lib${library}.so.*)
    install(FILES ${files} DESTINATION ${CMAKE_INSTALL_LIBDIR}/binosplat COMPONENT viewer)
endforeach()
foreach(package zip bz2 openexr imath openxr-loader jsoncpp glfw stb webp fmt imgui)
    file(GLOB folders ${CMAKE_SYSROOT}/usr/share/doc/lib${package}*)
    foreach(folder IN LISTS folders)
        get_filename_component(name ${folder} NAME)
        install(FILES ${folder}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR}/third_party/${name} COMPONENT viewer)
    endforeach()
endforeach()
set_target_properties(binosplat PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/binosplat")
set_target_properties(binosplat_library PROPERTIES INSTALL_RPATH "$ORIGIN/binosplat")
foreach(target binosplat binosplat_library)
    # These libraries find each other there, too.
    target_link_options(${target} PRIVATE LINKER:--disable-new-dtags)
endforeach()

set(CPACK_SYSTEM_NAME linux-arm64)
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "libc6 (>= 2.35), libstdc++6 (>= 12), libvulkan1, libpng16-16 | libpng16-16t64, zlib1g, libzstd1")
set(CPACK_DEBIAN_VIEWER_PACKAGE_DEPENDS "${CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS}, libcurl4, libfontconfig1, libfreetype6, libfribidi0, libharfbuzz0b, libssl3, libx11-6")
