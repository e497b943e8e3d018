# samewhere_folder(NAME LINKS target...)
#
# One folder of src/samewhere, with its sub-folders, is one library `samewhere_NAME` (alias samewhere::NAME): its *.cpp,
# linked to nothing but LINKS. Its *_test.cpp become `samewhere_NAME_test`. Which folder may link which is the layering of
# docs/design.md; `./run lint` checks it on the #includes.
#
# samewhere_plain_folder(NAME LINKS target...): the same for a folder that no sanitizer needs to watch. A sanitized build takes
# the library from SAMEWHERE_PLAIN_BUILD, or else builds it without them.

add_library(samewhere_options INTERFACE)
target_compile_options(samewhere_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  # fields left out of a designated initialiser have their defaults
  -Wno-missing-field-initializers
  # gcc 12 warns falsely inside Eigen, and where strings are put together
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>
  # one rounding per operation: the same result on every build of the same source
  -ffp-contract=off
  $<$<BOOL:${SAMEWHERE_WERROR}>:-Werror>)
target_include_directories(samewhere_options INTERFACE ${CMAKE_SOURCE_DIR}/src)
if(SAMEWHERE_SANITIZE)
  target_compile_options(samewhere_options INTERFACE -fsanitize=${SAMEWHERE_SANITIZE} -fno-omit-frame-pointer)
  # checks before every access through a pointer make a file take twice as long to compile; the address sanitizer stops at null,
  # what is given up are unaligned pointers and objects of another type
  target_compile_options(samewhere_options INTERFACE -fno-sanitize=null,alignment,vptr)
  target_link_options(samewhere_options INTERFACE -fsanitize=${SAMEWHERE_SANITIZE})
  # Eigen would give out memory in another way than in Ceres, which is built without sanitizers: one must free what the other took
  target_compile_definitions(samewhere_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
if(SAMEWHERE_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    message(FATAL_ERROR "SAMEWHERE_FUZZ=ON needs clang, found ${CMAKE_CXX_COMPILER_ID}: -DCMAKE_CXX_COMPILER=clang++, or scripts/fuzz.")
  endif()
  # libFuzzer is told of every branch; whatever a sanitizer finds ends the program
  target_compile_options(samewhere_options INTERFACE -fsanitize=fuzzer-no-link -fno-sanitize-recover=all)
endif()

function(samewhere_folder NAME)
  cmake_parse_arguments(FOLDER "" "" "LINKS;TEST_LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp */*.cpp)
  file(GLOB tests CONFIGURE_DEPENDS *_test.cpp */*_test.cpp)
  file(GLOB benches CONFIGURE_DEPENDS *_bench.cpp */*_bench.cpp)
  list(REMOVE_ITEM sources ${tests} ${benches})
  if(sources)
    add_library(samewhere_${NAME} STATIC ${sources})
    target_link_libraries(samewhere_${NAME} PUBLIC samewhere_options ${FOLDER_LINKS})
    samewhere_merge(samewhere_${NAME})
  else()
    add_library(samewhere_${NAME} INTERFACE)
    target_link_libraries(samewhere_${NAME} INTERFACE samewhere_options ${FOLDER_LINKS})
  endif()
  add_library(samewhere::${NAME} ALIAS samewhere_${NAME})
  if(SAMEWHERE_TESTS AND tests)
    samewhere_test(samewhere_${NAME}_test SOURCES ${tests} LINKS samewhere::${NAME} ${FOLDER_TEST_LINKS})
  endif()
endfunction()

function(samewhere_plain_folder NAME)
  if(NOT SAMEWHERE_SANITIZE OR NOT SAMEWHERE_PLAIN_BUILD)
    samewhere_folder(${NAME} ${ARGN})
    if(SAMEWHERE_SANITIZE)
      target_compile_options(samewhere_${NAME} PRIVATE -fno-sanitize=all)
      # a compiled header holds only for files with the same sanitizers
      set_target_properties(samewhere_${NAME} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
    endif()
    return()
  endif()
  cmake_parse_arguments(FOLDER "" "" "LINKS;TEST_LINKS" ${ARGN})
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  add_library(samewhere_${NAME} STATIC IMPORTED GLOBAL)
  set_target_properties(samewhere_${NAME} PROPERTIES
    IMPORTED_LOCATION ${SAMEWHERE_PLAIN_BUILD}/${folder}/${CMAKE_STATIC_LIBRARY_PREFIX}samewhere_${NAME}${CMAKE_STATIC_LIBRARY_SUFFIX})
  target_link_libraries(samewhere_${NAME} INTERFACE samewhere_options ${FOLDER_LINKS})
  add_library(samewhere::${NAME} ALIAS samewhere_${NAME})
endfunction()

# Test programs, by the preset that runs them besides `test`: those that read files of others run with the address sanitizer,
# those with threads with the thread sanitizer too. The others would take too long to build and to run with them.
set(samewhere_asan_tests core input scene features dense describe)
list(TRANSFORM samewhere_asan_tests REPLACE "(.+)" "samewhere_\\1_test")
list(APPEND samewhere_asan_tests cli_test formats_test fuzz_corpus_test)
set(samewhere_tsan_tests samewhere_core_test samewhere_input_test samewhere_view_test recognition_threads_test slam_threads_test)
# run first, because they take longest
set(samewhere_long_tests golden_test cli_walks_test samewhere_pipeline_test cli_test slam_threads_test)
foreach(label asan tsan plain)
  add_custom_target(tests_${label})
endforeach()

# samewhere_test(NAME SOURCES file... LINKS target...): one GoogleTest program. ctest runs it as one test, since starting it takes
# longer than most of its cases; the cases are counted from the XML that it writes to test-results/ of the build folder. Labels:
# `asan` and `tsan` as above, `plain` without `asan`; targets tests_LABEL build them. Tests of parts that the build leaves out are
# left out (SamewhereParts.cmake), and a program of nothing else.
function(samewhere_test NAME)
  cmake_parse_arguments(TEST "" "" "SOURCES;LINKS" ${ARGN})
  samewhere_leave_out_tests(TEST_SOURCES)
  if(NOT TEST_SOURCES)
    return()
  endif()
  add_executable(${NAME} ${TEST_SOURCES})
  target_link_libraries(${NAME} PRIVATE ${TEST_LINKS} samewhere_options GTest::gtest_main GTest::gmock)
  samewhere_merge_test(${NAME})
  # a test that ends its process does so in one that is started for it: this one may have threads by then
  add_test(NAME ${NAME}
           COMMAND ${NAME} --gtest_brief=1 --gtest_death_test_style=threadsafe --gtest_death_test_use_fork
                   --gtest_output=xml:${CMAKE_BINARY_DIR}/test-results/${NAME}.xml)
  set(labels plain)
  if(NAME IN_LIST samewhere_asan_tests)
    set(labels asan)
  endif()
  if(NAME IN_LIST samewhere_tsan_tests)
    list(APPEND labels tsan)
  endif()
  foreach(label IN LISTS labels)
    add_dependencies(tests_${label} ${NAME})
  endforeach()
  list(FIND samewhere_long_tests ${NAME} rank)
  if(rank LESS 0)
    set(rank 100)
  endif()
  math(EXPR cost "100 - ${rank}")
  set_tests_properties(${NAME} PROPERTIES WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} TIMEOUT 1500 LABELS "${labels}" COST ${cost})
endfunction()
