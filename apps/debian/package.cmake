# Manual pages, and Debian packages, split as Debian does: cpack -G DEB in a build folder. The preset debian compiles for
# more processors than release and installs into /usr.
if(NOT LIGHTWALK_PACKAGE OR LIGHTWALK_SANITIZE OR SKBUILD)
  return()
endif()
find_program(GZIP_PROGRAM gzip REQUIRED)
set(debian ${PROJECT_BINARY_DIR}/debian)

# What the program says of itself, as pages for man(1).
set(manual_pages "")
foreach(command "" render animate walk trace contrib relight freeze info launch install-names)
  string(REGEX REPLACE "(.+)" "-\\1" ending "${command}")
  set(page ${debian}/man/lightwalk${ending}.1)
  add_custom_command(OUTPUT ${page}.gz COMMAND ${CMAKE_COMMAND} -E make_directory ${debian}/man
    COMMAND lightwalk help man ${command} > ${page} COMMAND ${GZIP_PROGRAM} -9nf ${page} DEPENDS lightwalk VERBATIM)
  list(APPEND manual_pages ${page}.gz)
endforeach()
add_custom_target(manual_pages ALL DEPENDS ${manual_pages})
install(FILES ${manual_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)

# What Debian's policy wants beside each package's files.
set(LIGHTWALK_MAINTAINER "Lightwalk developers <lightwalk@lists.lightwalk.org>" CACHE STRING "Who stands in Debian packages as their maintainer")
string(TIMESTAMP DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, where it is set
file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
string(REGEX REPLACE "^.*All rights reserved\\.\n\n" "" license "${license}")
string(STRIP "${license}" license)
string(REPLACE "\n\n" "\n.\n" license "${license}")
string(REPLACE "\n" "\n " license "${license}")
set(LICENSE_LINES " ${license}")
configure_file(${CMAKE_CURRENT_LIST_DIR}/copyright.in ${debian}/copyright @ONLY)
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${debian}/changelog @ONLY)
execute_process(COMMAND ${GZIP_PROGRAM} -9nkf ${debian}/changelog COMMAND_ERROR_IS_FATAL ANY)

# It runs thousands of times, and starts in half the time so.
file(WRITE ${debian}/overrides "lightwalk: statically-linked-binary [usr/bin/lightwalk-served]\nlightwalk: no-manual-page [usr/bin/lightwalk-served]\n")
install(FILES ${debian}/overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME lightwalk COMPONENT program EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL "")
set(exact "(= ${PROJECT_VERSION})")
# A component of the installation as a package. Arguments: SECTION DEPENDS ARCHITECTURE CONTROL (files) TEXT (lines, the first one the synopsis)
function(add_debian_package component name)
  cmake_parse_arguments(PARSE_ARGV 2 with "" "SECTION;DEPENDS;RECOMMENDS;SUGGESTS;ARCHITECTURE" "CONTROL;TEXT")
  string(TOUPPER ${component} upper)
  list(JOIN with_TEXT "\n" with_TEXT)
  foreach(variable PACKAGE_NAME=${name} PACKAGE_SECTION=${with_SECTION} "PACKAGE_DEPENDS=${with_DEPENDS}" "PACKAGE_RECOMMENDS=${with_RECOMMENDS}"
      "PACKAGE_SUGGESTS=${with_SUGGESTS}" "PACKAGE_ARCHITECTURE=${with_ARCHITECTURE}" "PACKAGE_CONTROL_EXTRA=${with_CONTROL}" "DESCRIPTION=${with_TEXT}")
    string(REGEX MATCH "^[A-Z_]+" key "${variable}")
    string(REGEX REPLACE "^[A-Z_]+=" "" value "${variable}")
    if(NOT value STREQUAL "")
      set(CPACK_DEBIAN_${upper}_${key} "${value}" PARENT_SCOPE)
    endif()
  endforeach()
  install(FILES ${debian}/copyright ${debian}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component} EXCLUDE_FROM_ALL)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} PARENT_SCOPE)
endfunction()
set(library_package liblightwalk${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
file(WRITE ${debian}/shlibs "liblightwalk ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${library_package} (>= ${PROJECT_VERSION})\n")
add_debian_package(program lightwalk SECTION graphics DEPENDS "lightwalk-data ${exact}, ${library_package} ${exact}" SUGGESTS "lightwalk-mpi, ffmpeg"
  TEXT "light in buildings that do not exist yet" "Renders scenes of Radiance on all cores, and on many machines: pictures, rays," "daylight coefficients, and walks through a building in a browser.")
add_debian_package(data lightwalk-data SECTION graphics ARCHITECTURE all
  TEXT "function files and a demo scene of Lightwalk" "What scenes refer to without bringing it with them: sky distributions," "lens functions and the like; and a lodge in the mountains to walk through.")
add_debian_package(library ${library_package} SECTION libs DEPENDS "lightwalk-data ${exact}" CONTROL ${CMAKE_CURRENT_LIST_DIR}/triggers ${debian}/shlibs
  TEXT "rendering of Radiance scenes, as a library" "What the program lightwalk is made of, for programs that render by themselves," "and what it loads to read and write EXR, PNG and JPEG pictures.")
add_debian_package(mpi lightwalk-mpi SECTION graphics DEPENDS "openmpi-bin, lightwalk ${exact}"
  TEXT "Lightwalk on many machines" "What lets several processes render one picture or walk together, started by" "Open MPI's mpirun.")
add_debian_package(development liblightwalk-dev SECTION libdevel
  DEPENDS "${library_package} ${exact}, libembree-dev, libtbb-dev, libboost-context-dev, libzstd-dev, libturbojpeg0-dev, libxxhash-dev, libpugixml-dev, zlib1g-dev"
  TEXT "rendering of Radiance scenes, for C++" "Headers, a static library, and what CMake's find_package(lightwalk) reads.")

# The Python package, for the system's Python. It finds program, modules and library by links.
if(TARGET lightwalk_python)
  set(packages lib/python3/dist-packages)
  set(links ${debian}/links)
  # A link in a folder of the package to what another package has.
  function(add_link folder name place)
    file(RELATIVE_PATH way /usr/${packages}/lightwalk/${folder} /usr/${place})
    file(MAKE_DIRECTORY ${links}/${folder})
    file(CREATE_LINK ${way} ${links}/${folder}/${name} SYMBOLIC)
    install(FILES ${links}/${folder}/${name} DESTINATION ${packages}/lightwalk/${folder} COMPONENT debian_python EXCLUDE_FROM_ALL)
  endfunction()
  add_link(bin lightwalk bin/lightwalk)
  add_link(bin liblightwalk_openimageio.so ${CMAKE_INSTALL_LIBDIR}/lightwalk/liblightwalk_openimageio.so)
  add_link(share lightwalk ${CMAKE_INSTALL_DATADIR}/lightwalk)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/apps/python/lightwalk/ DESTINATION ${packages}/lightwalk COMPONENT debian_python EXCLUDE_FROM_ALL
    FILES_MATCHING PATTERN *.py PATTERN py.typed PATTERN __pycache__ EXCLUDE)
  install(TARGETS lightwalk_python LIBRARY DESTINATION ${packages}/lightwalk/bin COMPONENT debian_python EXCLUDE_FROM_ALL)
  file(WRITE ${debian}/METADATA "Metadata-Version: 2.1\nName: lightwalk\nVersion: ${PROJECT_VERSION}\nRequires-Dist: numpy\n")
  install(FILES ${debian}/METADATA DESTINATION ${packages}/lightwalk-${PROJECT_VERSION}.dist-info COMPONENT debian_python EXCLUDE_FROM_ALL)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  add_debian_package(debian_python python3-lightwalk SECTION python CONTROL ${CMAKE_CURRENT_LIST_DIR}/postinst ${CMAKE_CURRENT_LIST_DIR}/prerm
    DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy, lightwalk ${exact}"
    TEXT "rendering of Radiance scenes from Python" "Scenes from files or built in code, pictures and rays as arrays of NumPy," "walks in a notebook.")
endif()

set(CPACK_PACKAGE_CONTACT "${LIGHTWALK_MAINTAINER}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_OUTPUT_FILE_PREFIX ${debian}/packages)
include(CPack)
