# The Python package lightwalk: its module, and as the install component "python" all that its wheel holds. pip builds the
# wheel by pyproject.toml; tests/python takes one from any build folder.
if(NOT LIGHTWALK_PYTHON_MODULE)
  return()
endif()
if(NOT SKBUILD AND NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)  # Debian's pybind11 and NumPy are installed for it, whatever else stands first on the PATH
endif()
find_package(Python 3.9 COMPONENTS Interpreter Development.Module)
set(PYBIND11_FINDPYTHON ON)
find_package(pybind11 2.10 CONFIG)
if(NOT Python_Development.Module_FOUND OR NOT pybind11_FOUND)
  if(SKBUILD)
    message(FATAL_ERROR "pybind11 and Python's headers are what the module is built with")
  endif()
  message(STATUS "The Python package is left out: it needs pybind11 and Python's headers")
  return()
endif()

foreach(part core parallel io session apps)
  set_target_properties(lightwalk_${part} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endforeach()
if(NOT TARGET liblightwalk_shared)
  target_compile_options(lightwalk_flags INTERFACE -fno-semantic-interposition)
endif()
file(GLOB python_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.cpp)
add_library(lightwalk_python MODULE ${python_sources})
set_target_properties(lightwalk_python PROPERTIES PREFIX "" OUTPUT_NAME _core SUFFIX ".${Python_SOABI}.so" CXX_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python)
target_compile_definitions(lightwalk_python PRIVATE LIGHTWALK_VERSION="${PROJECT_VERSION}")
target_link_libraries(lightwalk_python PRIVATE lightwalk_apps lightwalk_session pybind11::module)
target_link_options(lightwalk_python PRIVATE -Wl,--exclude-libs,ALL)
compile_by_folder(lightwalk_python)
if(SKBUILD)  # for who installs it; here it would take a twentieth of a build's time, for tests that count no rays
  optimize_at_link_time(lightwalk_python)
endif()

set(package lightwalk)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/lightwalk_program.py DESTINATION . COMPONENT python EXCLUDE_FROM_ALL)
install(DIRECTORY ${CMAKE_CURRENT_LIST_DIR}/lightwalk/ DESTINATION ${package} COMPONENT python EXCLUDE_FROM_ALL
  FILES_MATCHING PATTERN *.py PATTERN *.pyi PATTERN py.typed PATTERN __pycache__ EXCLUDE)
install(TARGETS lightwalk lightwalk_served lightwalk_python lightwalk_openimageio lightwalk_mpi
  RUNTIME DESTINATION ${package}/bin COMPONENT python EXCLUDE_FROM_ALL LIBRARY DESTINATION ${package}/bin COMPONENT python EXCLUDE_FROM_ALL)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/io/library/ DESTINATION ${package}/share/lightwalk/lib COMPONENT python EXCLUDE_FROM_ALL)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/apps/scenes/ DESTINATION ${package}/share/lightwalk/scenes COMPONENT python
  EXCLUDE_FROM_ALL PATTERN *.py EXCLUDE)
