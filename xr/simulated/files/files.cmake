# Headset and motion files, read alike by the simulated runtime and by programs beside it: the standard library and toml++, nothing else.
if(NOT TARGET binosplat_files)
    add_library(binosplat_files STATIC
        ${CMAKE_CURRENT_LIST_DIR}/file_words.cpp ${CMAKE_CURRENT_LIST_DIR}/headset_file.cpp ${CMAKE_CURRENT_LIST_DIR}/motion_file.cpp)
    set_target_properties(binosplat_files PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(binosplat_files PUBLIC binosplat_flags PRIVATE third_party_toml)
endif()
