# fuzz.cmake -- fuzz targets of the readers (libFuzzer of clang), built with -D REGATHER_FUZZ=ON.
# regather_fuzz(NAME NEEDS TARGET...): the program fuzz_NAME of tests/fuzz/NAME_fuzz.cpp and the test fuzz.NAME, which begins with
# the inputs in tests/fuzz/corpus/NAME and runs for REGATHER_FUZZ_SECONDS (2 when the environment says nothing).
function(regather_fuzz name)
    if(NOT REGATHER_FUZZ)
        return()
    endif()
    cmake_parse_arguments(ARG "" "" "NEEDS" ${ARGN})
    add_executable(fuzz_${name} EXCLUDE_FROM_ALL tests/fuzz/${name}_fuzz.cpp)
    target_link_libraries(fuzz_${name} PRIVATE ${ARG_NEEDS})
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
    target_precompile_headers(fuzz_${name} REUSE_FROM regather_precompiled)
    add_dependencies(fuzz_targets fuzz_${name})
    add_test(NAME fuzz.${name} COMMAND ${CMAKE_SOURCE_DIR}/tests/fuzz/run.sh $<TARGET_FILE:fuzz_${name}>
        ${CMAKE_SOURCE_DIR}/tests/fuzz/corpus/${name} ${CMAKE_BINARY_DIR}/fuzz/${name})
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz)
endfunction()
if(REGATHER_FUZZ)
    add_custom_target(fuzz_targets)
endif()
