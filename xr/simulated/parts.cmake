# The parts of the simulated runtime that are pure functions, apart from OpenXR and Vulkan so that tests can link them.
add_library(binosplat_simulated_parts STATIC geometry.cpp hand_model.cpp script.cpp script_words.cpp script_parser.cpp script_files.cpp script_motion.cpp script_profile.cpp
            profiles.cpp compose.cpp seen_shapes.cpp texels.cpp
            picture_file.cpp frame_log.cpp old_output.cpp)
set_target_properties(binosplat_simulated_parts PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(binosplat_simulated_parts PUBLIC binosplat_flags third_party_glm PRIVATE third_party_fmt third_party_json third_party_toml third_party_png)
