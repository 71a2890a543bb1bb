# precompiled.cmake -- headers that most files take, read by the compiler once: one set for the libraries, one for the tests, and one
# for each level of optimisation, as g++ would take a function's level from the set.
# Files still include what they use; a build with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows that they do.
set(regather_standard_headers <algorithm> <array> <bit> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory>
    <numeric> <optional> <set> <span> <string> <string_view> <tuple> <utility> <vector> <fmt/format.h>)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/precompiled.cpp CONTENT "// Empty: its target holds precompiled headers.\n")

function(regather_precompiled_headers name)
    cmake_parse_arguments(ARG "" "" "HEADERS;NEEDS" ${ARGN})
    add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/generated/precompiled.cpp)
    target_link_libraries(${name} PRIVATE regather_flags ${ARG_NEEDS})
    target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()
# What ccache asks for, to know a file's result again although it was compiled with a precompiled header.
target_compile_options(regather_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
    $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>)
regather_precompiled_headers(regather_precompiled HEADERS ${regather_standard_headers} NEEDS fmt::fmt)
set(regather_cold_precompiled regather_precompiled)
if(REGATHER_COLD_LEVEL)
    set(regather_cold_precompiled regather_precompiled_cold)
    regather_precompiled_headers(regather_precompiled_cold HEADERS ${regather_standard_headers} NEEDS fmt::fmt)
    target_compile_options(regather_precompiled_cold PRIVATE ${REGATHER_COLD_LEVEL})
endif()
if(REGATHER_TESTS)
    regather_precompiled_headers(regather_test_precompiled
        HEADERS ${regather_standard_headers} <gtest/gtest.h> <gmock/gmock.h> <rapidcheck.h>
        NEEDS fmt::fmt GTest::gtest GTest::gmock rapidcheck)
    target_compile_options(regather_test_precompiled PRIVATE ${REGATHER_TEST_LEVEL})
endif()
