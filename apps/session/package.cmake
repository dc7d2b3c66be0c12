# The library below the commands (scenes, renderers, pictures), and its package: liblightwalk, static and shared, the
# headers of lightwalk/ with what they include, and the files that find_package(lightwalk) reads.
file(GLOB session_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/session/*.cpp)
file(GLOB session_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/session/*.h ${PROJECT_SOURCE_DIR}/apps/session/lightwalk/*.h)
add_library(lightwalk_session STATIC ${session_sources})
target_sources(lightwalk_session PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${session_headers})
set_target_properties(lightwalk_session PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
target_compile_definitions(lightwalk_session PRIVATE LIGHTWALK_VERSION="${PROJECT_VERSION}")
target_link_libraries(lightwalk_session PUBLIC lightwalk_parallel_chosen lightwalk_io PRIVATE nlohmann_json::nlohmann_json)
# With a sanitizer, whose library stands in front of every program, no package is made.
if(NOT LIGHTWALK_PACKAGE OR LIGHTWALK_SANITIZE)
  return()
endif()

# The same objects serve the program and both libraries. What the shared one does not export may be inlined as in a program.
set(package_parts lightwalk_core lightwalk_parallel lightwalk_io lightwalk_session)
set_target_properties(${package_parts} PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_compile_options(lightwalk_flags INTERFACE -fno-semantic-interposition)
set(package_objects "")
foreach(part ${package_parts})
  list(APPEND package_objects $<TARGET_OBJECTS:${part}>)
endforeach()
set(package_links embree TBB::tbb Boost::context Threads::Threads ${CMAKE_DL_LIBS} ${ZSTD_LIBRARY} ${TURBOJPEG_LIBRARY} ${XXHASH_LIBRARY} pugixml ${ZLIB_LIBRARIES})
foreach(kind STATIC SHARED)
  string(TOLOWER ${kind} name)
  add_library(liblightwalk_${name} ${kind} ${package_objects})
  set_target_properties(liblightwalk_${name} PROPERTIES OUTPUT_NAME lightwalk LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_link_libraries(liblightwalk_${name} PRIVATE ${package_links})
  target_compile_features(liblightwalk_${name} INTERFACE cxx_std_20)
  target_include_directories(liblightwalk_${name} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  install(TARGETS liblightwalk_${name} EXPORT lightwalk-${name} LIBRARY COMPONENT library NAMELINK_COMPONENT development
    ARCHIVE COMPONENT development)
  install(EXPORT lightwalk-${name} NAMESPACE lightwalk:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lightwalk COMPONENT development)
endforeach()
set_target_properties(liblightwalk_shared PROPERTIES EXPORT_NAME lightwalk)
set_target_properties(liblightwalk_static PROPERTIES EXPORT_NAME lightwalk_static)
if(link_time)  # what is for the program alone; other versions of GCC could not even read it
  target_link_options(liblightwalk_shared PRIVATE -fno-lto)
  add_custom_command(TARGET liblightwalk_static POST_BUILD
    COMMAND ${CMAKE_OBJCOPY} --remove-section=.gnu.lto_* --remove-section=.gnu.debuglto_* $<TARGET_FILE:liblightwalk_static> VERBATIM)
endif()
target_link_options(liblightwalk_shared PRIVATE -Wl,--no-undefined -Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/exports.map)
set_target_properties(liblightwalk_shared PROPERTIES LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/exports.map)

# Headers as they are installed: those of apps/session/lightwalk in lightwalk/, and beside them, by the folders that they
# have here, what they include. Who uses them writes #include <lightwalk/...>, and nothing else comes into their way.
set(public_headers ${PROJECT_BINARY_DIR}/public_headers)
file(REMOVE_RECURSE ${public_headers})
file(GLOB waiting RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/apps/session/lightwalk/*.h)
set(written "")
while(waiting)
  list(POP_FRONT waiting header)
  if(header IN_LIST written)
    continue()
  endif()
  list(APPEND written ${header})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
  file(READ ${PROJECT_SOURCE_DIR}/${header} text)
  string(REGEX MATCHALL "#include \"[^\"]+" includes "${text}")
  list(TRANSFORM includes REPLACE "#include \"" "")
  list(APPEND waiting ${includes})
  string(REGEX REPLACE "#include \"(apps/session/lightwalk/)?" "#include \"lightwalk/" text "${text}")
  string(REPLACE "apps/session/lightwalk/" "" place ${header})
  file(WRITE ${public_headers}/lightwalk/${place} "${text}")
endwhile()
install(DIRECTORY ${public_headers}/lightwalk DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

include(CMakePackageConfigHelpers)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lightwalk-config.cmake.in ${PROJECT_BINARY_DIR}/lightwalk-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lightwalk)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lightwalk-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lightwalk-config.cmake ${PROJECT_BINARY_DIR}/lightwalk-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lightwalk COMPONENT development)
