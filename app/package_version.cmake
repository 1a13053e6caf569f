# The version of the packages, read by cpack each time it makes them: PROJECT_VERSION where the source is
# tagged so or is no checkout; otherwise with the number of commits and the last one, so that a later build
# counts as newer, and with "~" before the tag is there, as older than it.
set(source ${CMAKE_CURRENT_LIST_DIR}/..)
execute_process(COMMAND git -C ${source} describe --tags --always --dirty OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(described AND NOT described STREQUAL "v${CPACK_PACKAGE_VERSION}")
    execute_process(COMMAND git -C ${source} rev-list --count HEAD OUTPUT_VARIABLE commits OUTPUT_STRIP_TRAILING_WHITESPACE)
    execute_process(COMMAND git -C ${source} rev-parse --short HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE)
    set(sign "~")
    if(described MATCHES "^v${CPACK_PACKAGE_VERSION}-")
        set(sign "+")
    endif()
    string(APPEND CPACK_PACKAGE_VERSION "${sign}git${commits}.${commit}")
    if(described MATCHES "-dirty$")
        string(APPEND CPACK_PACKAGE_VERSION ".dirty")
    endif()
endif()
set(CPACK_PACKAGE_FILE_NAME ${CPACK_PACKAGE_NAME}-${CPACK_PACKAGE_VERSION}-${CPACK_SYSTEM_NAME})
