# Unpacks the inputs that fuzzing kept, one archive per target (tests/fuzz/run.sh --keep packs them), for
# fuzz_corpus_test.
if(WIN32)
    return()
endif()
set(fuzz_corpus ${CMAKE_CURRENT_BINARY_DIR}/fuzz_corpus)
file(GLOB archives CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/corpus/*.tar.gz)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${archives})
file(REMOVE_RECURSE ${fuzz_corpus})
foreach(archive IN LISTS archives)
    file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${fuzz_corpus})
endforeach()
target_compile_definitions(binosplat_test_flags INTERFACE BINOSPLAT_FUZZ_CORPUS="${fuzz_corpus}")
