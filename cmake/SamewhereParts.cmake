# The parts that a build can leave out with their libraries: a robot needs neither.
#
# SAMEWHERE_TWIN=OFF: no Embree. twin:PRESET and `samewhere twin` are refused with one line.
# SAMEWHERE_DENSE=OFF: no OctoMap. `samewhere dense` is refused with one line.
# SAMEWHERE_DDS=OFF, or no Cyclone DDS installed: `samewhere dds` is refused with one line.
# SAMEWHERE_MATIO=OFF, or no libmatio installed: matrices of same places are read as text only.
# Of a pair of files x.cpp and x_without.cpp one is compiled; tests that need what is left out are
# left out, too.

# Embree 3.13 or newer, or 4, whichever is there. Packages of Embree 4 do not count as a newer 3,
# so no version is asked for.
if(SAMEWHERE_TWIN)
  find_package(embree QUIET)
  if(NOT embree_FOUND OR embree_VERSION VERSION_LESS 3.13 OR embree_VERSION VERSION_GREATER_EQUAL 5)
    message(FATAL_ERROR "Found no Embree of version 3.13 to 4 (found: ${embree_VERSION}), which renders the buildings of twin:PRESET. "
                        "On Debian and Ubuntu it is the package libembree-dev. -DSAMEWHERE_TWIN=OFF builds without.")
  endif()
  set(SAMEWHERE_EMBREE embree)
endif()

if(SAMEWHERE_DENSE)
  find_package(octomap 1.9 QUIET)
  if(NOT octomap_FOUND)
    message(FATAL_ERROR "Found no OctoMap of version 1.9 or newer, which `samewhere dense` needs. "
                        "On Debian and Ubuntu it is the package liboctomap-dev. -DSAMEWHERE_DENSE=OFF builds without.")
  endif()
  set(SAMEWHERE_OCTOMAP octomap)
endif()

if(SAMEWHERE_DDS)
  find_package(CycloneDDS 0.10 QUIET)
  if(NOT CycloneDDS_FOUND)
    message(STATUS "Found no Cyclone DDS of version 0.10 or newer: without `samewhere dds`. "
                   "On Debian and Ubuntu it is the package cyclonedds-dev.")
  endif()
endif()

if(SAMEWHERE_MATIO)
  find_path(SAMEWHERE_MATIO_FOLDER matio.h)
  find_library(SAMEWHERE_MATIO_LIBRARY matio)
  if(SAMEWHERE_MATIO_FOLDER AND SAMEWHERE_MATIO_LIBRARY)
    add_library(samewhere_matio INTERFACE)
    target_include_directories(samewhere_matio SYSTEM INTERFACE ${SAMEWHERE_MATIO_FOLDER})
    target_link_libraries(samewhere_matio INTERFACE ${SAMEWHERE_MATIO_LIBRARY})
    set(SAMEWHERE_MATIO_TARGET samewhere_matio)
  else()
    message(STATUS "Found no libmatio: matrices of same places are not read from MATLAB files. "
                   "On Debian and Ubuntu it is the package libmatio-dev.")
  endif()
endif()

# samewhere_leave_out_tests(SOURCES): takes the tests of parts that are left out from the list
# SOURCES, and those of a build without a part (x_without_test.cpp) where the part is there.
function(samewhere_leave_out_tests SOURCES)
  set(sources ${${SOURCES}})
  if(SAMEWHERE_TWIN)
    list(FILTER sources EXCLUDE REGEX "/twin/[a-z_/]*_without_test\\.cpp$")
  else()
    set(without ${sources})
    list(FILTER without INCLUDE REGEX "/twin/[a-z_/]*_without_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "/twin/[a-z_/]*_test\\.cpp$")
    list(APPEND sources ${without})
    list(FILTER sources EXCLUDE REGEX "/(pipeline/(disturbance|relocalization|slam)|run/recognition)_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "/(library/[a-z_]*|node/(node|transforms))_test\\.cpp$|^examples/examples_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "^cli/(commands|dense|known_map|ledger|map|twin)_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "^(corridor/corridor|stereo/stereo|threads/threads)_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "^(carried_pixels|shared_surface)_test\\.cpp$")
  endif()
  if(SAMEWHERE_DENSE)
    list(FILTER sources EXCLUDE REGEX "/dense/[a-z_]*_without_test\\.cpp$")
  else()
    list(FILTER sources EXCLUDE REGEX "/dense/octree_map_test\\.cpp$|^cli/dense_test\\.cpp$")
  endif()
  if(SAMEWHERE_MATIO_TARGET)
    list(FILTER sources EXCLUDE REGEX "/input/mat_file_without_test\\.cpp$")
  else()
    list(FILTER sources EXCLUDE REGEX "/input/mat_file_test\\.cpp$")
  endif()
  set(${SOURCES} ${sources} PARENT_SCOPE)
endfunction()
