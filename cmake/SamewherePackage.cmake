# libsamewhere: all folders of src/samewhere in one shared library, which exports the classes of include/samewhere alone. What is
# installed can be moved: the models are found relative to the library, and the package files relative to themselves.
#
#   cmake --preset release -DSAMEWHERE_LIBRARY=ON && cmake --build build/release && cmake --install build/release --prefix PREFIX
#   find_package(samewhere 0.1 REQUIRED)  ->  samewhere::samewhere          pkg-config --cflags --libs samewhere
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

file(WRITE ${CMAKE_BINARY_DIR}/package/empty.cpp "")
add_library(samewhere_shared SHARED ${CMAKE_BINARY_DIR}/package/empty.cpp)
add_dependencies(samewhere_shared samewhere-video)  # it loads the plugin that lies beside it
# as a whole: nothing refers to the classes from inside
target_link_libraries(samewhere_shared PRIVATE $<LINK_LIBRARY:WHOLE_ARCHIVE,samewhere_library>)
target_link_libraries(samewhere_shared INTERFACE Eigen3::Eigen)
target_link_options(samewhere_shared PRIVATE -Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/samewhere.map -Wl,--no-undefined)
target_include_directories(samewhere_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(samewhere_shared INTERFACE cxx_std_20)
# -march options of a user would change the layout of poses
target_compile_definitions(samewhere_shared INTERFACE EIGEN_MAX_ALIGN_BYTES=16)
# before version 1 any minor version may change the interface
set_target_properties(samewhere_shared PROPERTIES
  OUTPUT_NAME samewhere EXPORT_NAME samewhere VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/samewhere.map)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/samewhere)
install(TARGETS samewhere_shared EXPORT samewhere
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/include/samewhere DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT samewhere NAMESPACE samewhere:: FILE samewhereTargets.cmake DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/samewhereConfig.cmake.in ${CMAKE_BINARY_DIR}/package/samewhereConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/samewhereConfigVersion.cmake COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH prefix_from_pc /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${CMAKE_CURRENT_LIST_DIR}/samewhere.pc.in ${CMAKE_BINARY_DIR}/package/samewhere.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/package/samewhereConfig.cmake ${CMAKE_BINARY_DIR}/package/samewhereConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT development)
install(FILES ${CMAKE_BINARY_DIR}/package/samewhere.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/models ${CMAKE_SOURCE_DIR}/configs DESTINATION ${CMAKE_INSTALL_DATADIR}/samewhere COMPONENT library)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/samewhere COMPONENT development)
install(TARGETS samewhere RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
# found relative to the program and to the library: src/samewhere/input/video_plugin.cpp
install(TARGETS samewhere-video LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/samewhere COMPONENT library)
