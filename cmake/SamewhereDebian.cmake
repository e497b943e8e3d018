# The Debian packages that ./run package makes by CPack, from the preset `package`:
#
#   samewhere          program, libsamewhere.so, video plugin, models, configurations
#   libsamewhere-dev   headers, package files of CMake and pkg-config, examples
#   python3-samewhere  Python package (with SAMEWHERE_PYTHON=ON), for the minor version of Python that it was built with
#
# Dependencies on libraries are those of the Debian release that builds them, found by dpkg-shlibdeps. DEBFULLNAME and DEBEMAIL name the
# maintainer, as for Debian's own tools.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME samewhere)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(maintainer "the samewhere authors")
set(email samewhere@localhost)
if(DEFINED ENV{DEBFULLNAME})
  set(maintainer $ENV{DEBFULLNAME})
endif()
if(DEFINED ENV{DEBEMAIL})
  set(email $ENV{DEBEMAIL})
endif()
set(CPACK_PACKAGE_CONTACT "${maintainer} <${email}>")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# one package per group, or per component outside of groups
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program library development)
set(CPACK_COMPONENT_PROGRAM_GROUP main)
set(CPACK_COMPONENT_LIBRARY_GROUP main)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# of libsamewhere.so, on which the Python module depends
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
set(same_version "samewhere (= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_MAIN_PACKAGE_NAME samewhere)
set(CPACK_DEBIAN_MAIN_PACKAGE_SECTION science)
# CPack's own shlibs would name the plugin, too
file(WRITE ${CMAKE_BINARY_DIR}/package/shlibs "libsamewhere ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${same_version}\n")
file(WRITE ${CMAKE_BINARY_DIR}/package/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_MAIN_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/package/shlibs ${CMAKE_BINARY_DIR}/package/triggers)
set(CPACK_DEBIAN_MAIN_DESCRIPTION "visual SLAM that rejects false loop closures
Simultaneous localization and mapping with a depth, stereo or single camera,
for buildings with repeated corridors and floors. Loop closures that perceptual
aliasing would falsify are rejected, and the reason is reported.
.
This package has the program, the shared library and its models.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsamewhere-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${same_version}, libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "visual SLAM that rejects false loop closures: development files
Headers, examples and the package files of CMake and pkg-config for
libsamewhere: live SLAM, loop closures for other odometry, verification of
one loop.")

set(documented samewhere=library libsamewhere-dev=development)
if(SAMEWHERE_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  list(APPEND documented python3-samewhere=python)
  math(EXPR next_minor "${PYTHON_VERSION_MINOR} + 1")
  set(python "python3 (>= ${PYTHON_VERSION_MAJOR}.${PYTHON_VERSION_MINOR}~), python3 (<< ${PYTHON_VERSION_MAJOR}.${next_minor}~)")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-samewhere)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${same_version}, ${python}, python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-matplotlib)
  # compile the .py files, and remove what was compiled
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/postinst ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "visual SLAM that rejects false loop closures: Python package
The classes of libsamewhere for numpy arrays, evaluation of trajectories and
loops, and figures from results folders.")
endif()

# a changelog of one entry, as Debian's policy has it; what changed is in CHANGELOG.md
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${CMAKE_BINARY_DIR}/package/changelog
     "samewhere (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * Version ${PROJECT_VERSION}.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
execute_process(COMMAND gzip -9nf ${CMAKE_BINARY_DIR}/package/changelog COMMAND_ERROR_IS_FATAL ANY)

foreach(pair IN LISTS documented)
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 package)
  list(GET pair 1 component)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/debian/copyright ${CMAKE_BINARY_DIR}/package/changelog.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endforeach()

include(CPack)
