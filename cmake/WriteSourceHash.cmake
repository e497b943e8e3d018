# cmake -DFOLDERS=DIR;DIR -DBUILD=TEXT -DOUT=FILE -P WriteSourceHash.cmake
#
# Writes a C++ file that defines samewhere::twin::source_hash(): SHA-256 over BUILD and over name and content of all
# sources in FOLDERS, tests apart.
set(text "${BUILD}")
foreach(folder IN LISTS FOLDERS)
  get_filename_component(name ${folder} NAME)
  file(GLOB sources RELATIVE ${folder} ${folder}/*.cpp ${folder}/*.hpp)
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$|^test_")
  list(SORT sources)
  foreach(source IN LISTS sources)
    file(SHA256 ${folder}/${source} hash)
    string(APPEND text "\n${name}/${source} ${hash}")
  endforeach()
endforeach()
string(SHA256 hash "${text}")
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#include <samewhere/twin/render/source_hash.hpp>

namespace samewhere::twin {

std::string_view source_hash() { return "@hash@"; }

}  // namespace samewhere::twin
]])
