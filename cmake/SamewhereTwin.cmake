# Embree, which finds what the rays of the rendered buildings meet: 3.13 or newer, or 4, whichever is there. Packages of Embree 4
# do not count as a newer 3, so no version is asked for.
#
# SAMEWHERE_TWIN=OFF builds without it: twin:PRESET is then refused, and the tests that render are left out.
if(SAMEWHERE_TWIN)
  find_package(embree QUIET)
  if(NOT embree_FOUND OR embree_VERSION VERSION_LESS 3.13 OR embree_VERSION VERSION_GREATER_EQUAL 5)
    message(FATAL_ERROR "Found no Embree of version 3.13 to 4 (found: ${embree_VERSION}), which renders the buildings of twin:PRESET. "
                        "On Debian and Ubuntu it is the package libembree-dev. -DSAMEWHERE_TWIN=OFF builds without.")
  endif()
  set(SAMEWHERE_EMBREE embree)
endif()

# samewhere_leave_out_rendered(SOURCES): takes the tests that render out of the list SOURCES where nothing can be rendered, and
# those of a build that cannot (x_without_test.cpp) where it can.
function(samewhere_leave_out_rendered SOURCES)
  set(sources ${${SOURCES}})
  if(SAMEWHERE_TWIN)
    list(FILTER sources EXCLUDE REGEX "/twin/[a-z_]*_without_test\\.cpp$")
  else()
    set(without ${sources})
    list(FILTER without INCLUDE REGEX "/twin/[a-z_]*_without_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "/twin/[a-z_]*_test\\.cpp$")
    list(APPEND sources ${without})
    list(FILTER sources EXCLUDE REGEX "/(pipeline/(disturbance|relocalisation|slam)|run/recognition)_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "^cli/(commands|dense|known_map|ledger|map|twin)_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "^(corridor/corridor|stereo/stereo|threads/threads)_test\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "^(carried_pixels|shared_surface)_test\\.cpp$")
  endif()
  set(${SOURCES} ${sources} PARENT_SCOPE)
endfunction()
