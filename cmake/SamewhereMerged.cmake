# SAMEWHERE_MERGED, for all presets but those to work with: the sources of a folder are compiled several at a time, and headers that
# nearly every file includes once. It halves the building time. The others leave it out, so that a file which
# forgets an #include fails there; a name that two files of a folder define for themselves fails here.
#
# samewhere_merge(TARGET): a library or program.
# samewhere_merge_test(TARGET): a test program, which includes GoogleTest.

set(SAMEWHERE_COMMON_HEADERS
  <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <numbers> <optional> <set> <span>
  <sstream> <string> <string_view> <vector>
  <Eigen/Core> <Eigen/Dense> <Eigen/Geometry>
  <fmt/format.h> <opencv2/core.hpp> <opencv2/imgproc.hpp>)

if(SAMEWHERE_MERGED)
  # a compiled header holds only for files with the same definitions and folders
  target_link_libraries(samewhere_options INTERFACE Eigen3::Eigen fmt::fmt opencv_core opencv_imgproc)
  file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/precompiled/empty.cpp CONTENT "")
  add_library(samewhere_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled/empty.cpp)
  target_link_libraries(samewhere_precompiled PRIVATE samewhere_options)
  target_precompile_headers(samewhere_precompiled PRIVATE ${SAMEWHERE_COMMON_HEADERS})
  if(SAMEWHERE_TESTS)
    add_library(samewhere_precompiled_test OBJECT ${CMAKE_BINARY_DIR}/precompiled/empty.cpp)
    target_link_libraries(samewhere_precompiled_test PRIVATE samewhere_options GTest::gtest GTest::gmock)
    target_precompile_headers(samewhere_precompiled_test PRIVATE ${SAMEWHERE_COMMON_HEADERS} <gmock/gmock.h> <gtest/gtest.h>)
  endif()
endif()

function(samewhere_merge TARGET)
  if(SAMEWHERE_MERGED)
    set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    # a file that is included in another is taken for a header, which should have no types of its own
    target_compile_options(${TARGET} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    target_precompile_headers(${TARGET} REUSE_FROM samewhere_precompiled)
  endif()
endfunction()

function(samewhere_merge_test TARGET)
  if(SAMEWHERE_MERGED)
    set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
    target_precompile_headers(${TARGET} REUSE_FROM samewhere_precompiled_test)
  endif()
endfunction()
