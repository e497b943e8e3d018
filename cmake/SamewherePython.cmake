# SAMEWHERE_PYTHON=ON: the Python package `samewhere` (python/), with pybind11 and numpy of the interpreter that pybind11 finds. Its
# module is a shared library, so that all code becomes position-independent.
if(SAMEWHERE_PYTHON)
  # Debian's own interpreter first: numpy and matplotlib are its packages
  if(NOT PYTHON_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(PYTHON_EXECUTABLE /usr/bin/python3)
  endif()
  find_package(pybind11 2.10 QUIET CONFIG)
  if(NOT pybind11_FOUND)
    message(FATAL_ERROR "Found no pybind11 of version 2.10 or newer, which the Python package needs. "
                        "On Debian and Ubuntu scripts/packages-python.txt lists the packages.")
  endif()
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
