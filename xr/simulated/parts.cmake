# The parts of the simulated runtime that are pure functions, apart from OpenXR and Vulkan so that tests can
# link them.
add_library(binosplat_simulated_parts STATIC compose/geometry.cpp script/hand_model.cpp script/script.cpp script/script_words.cpp script/script_parser.cpp script/script_headset.cpp script/script_runtime.cpp script/script_poses.cpp script/script_presses.cpp script/script_timeline.cpp script/script_files.cpp script/script_profile.cpp script/script_gaze.cpp
            api/profiles.cpp compose/compose.cpp compose/seen_shapes.cpp compose/texels.cpp
            compose/picture_file.cpp log/frame_log.cpp compose/old_output.cpp
            $<IF:$<BOOL:${WIN32}>,system_windows.cpp,system_posix.cpp>)
# <windows.h> defines words that other files use.
set_source_files_properties(system_windows.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
set_target_properties(binosplat_simulated_parts PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(binosplat_simulated_parts PUBLIC binosplat_flags third_party_glm binosplat_files ${CMAKE_DL_LIBS} PRIVATE third_party_fmt_inside third_party_json third_party_png)
