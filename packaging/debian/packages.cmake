# The Debian packages, made by CPack from the components of the installation. tools/package runs it.
set(MURAL_MAINTAINER "Mural maintainers <maintainers@users.noreply.github.com>" CACHE STRING "maintainer in the Debian packages")
set(components mural libmural libmural-dev)
if(TARGET mural_transport_fabric)
  list(APPEND components mural-fabric)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mural)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${MURAL_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_DEBUGINFO_PACKAGE ON)

# Mural opens these at run time, so dpkg-shlibdeps does not find them: the GL of programs and nodes, and the driver.
set(CPACK_DEBIAN_MURAL_PACKAGE_NAME mural)
set(CPACK_DEBIAN_MURAL_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_MURAL_PACKAGE_DEPENDS "libegl1, libepoxy0, libgl1, libgl1-mesa-dri, libgles1, libgles2, libopengl0")
set(CPACK_DEBIAN_MURAL_PACKAGE_RECOMMENDS "ffmpeg, openssh-client, xauth, xvfb")
set(CPACK_DEBIAN_MURAL_PACKAGE_SUGGESTS "avahi-daemon, glmark2-x11, libavahi-client3, libosmesa6, mesa-utils, mural-fabric, slurm-client")
set(CPACK_COMPONENT_MURAL_DESCRIPTION
"Mural runs unmodified OpenGL programs on a cluster of render nodes. One
machine runs the program. Several processes or machines draw it, each its own
part of the picture. Every pixel equals the pixel that one machine draws.
.
The command mural starts programs, render nodes and daemons. It records and
replays streams of OpenGL commands, and checks machines and networks.")
set(CPACK_DEBIAN_MURAL_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/mural/prerm ${CMAKE_CURRENT_LIST_DIR}/mural/postrm)

set(CPACK_DEBIAN_MURAL-FABRIC_PACKAGE_NAME mural-fabric)
set(CPACK_DEBIAN_MURAL-FABRIC_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_MURAL-FABRIC_PACKAGE_DEPENDS "mural (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_MURAL-FABRIC_DESCRIPTION
"Mural runs OpenGL programs on display walls and clusters. This plug-in adds
connections of the form fabric://, which use InfiniBand, RoCE and other
networks by libfabric.")

set(CPACK_DEBIAN_LIBMURAL_PACKAGE_NAME libmural${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_LIBMURAL_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBMURAL_PACKAGE_SUGGESTS "mural (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_LIBMURAL_PACKAGE_DEPENDS "libegl1, libepoxy0, libgl1, libgl1-mesa-dri, libgles1, libgles2, libopengl0")
set(CPACK_COMPONENT_LIBMURAL_DESCRIPTION
"Programs with the native interface of Mural draw on display walls and
clusters: each render node runs the program's own drawing code for its part
of the picture or of the data.")
configure_file(${CMAKE_CURRENT_LIST_DIR}/libmural/shlibs.in ${CMAKE_CURRENT_BINARY_DIR}/libmural/shlibs @ONLY)
set(CPACK_DEBIAN_LIBMURAL_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/libmural/shlibs ${CMAKE_CURRENT_LIST_DIR}/libmural/triggers)

set(CPACK_DEBIAN_LIBMURAL-DEV_PACKAGE_NAME libmural-dev)
set(CPACK_DEBIAN_LIBMURAL-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBMURAL-DEV_PACKAGE_DEPENDS "libmural${PROJECT_VERSION_MAJOR} (= ${PROJECT_VERSION}), libgl-dev")
set(CPACK_DEBIAN_LIBMURAL-DEV_PACKAGE_SUGGESTS "mural (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_LIBMURAL-DEV_DESCRIPTION
"Headers of the native interface of Mural, and the files by which CMake and
pkg-config find its library.")

# Debian Policy 12.5 and 12.7: every package has its copyright and changelog.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(MURAL_CHANGELOG ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz)
add_custom_command(OUTPUT ${MURAL_CHANGELOG}
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/changelog.py ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${PROJECT_VERSION} ${MURAL_MAINTAINER} ${MURAL_CHANGELOG}
  DEPENDS ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_CURRENT_LIST_DIR}/changelog.py VERBATIM)
add_custom_target(mural_changelog DEPENDS ${MURAL_CHANGELOG})
foreach(component ${components})
  string(TOUPPER ${component} upper)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${folder} COMPONENT ${component})
  # Only packages need the changelog. Installations without the target above have none.
  install(FILES ${MURAL_CHANGELOG} DESTINATION ${folder} COMPONENT ${component} OPTIONAL)
endforeach()
include(CPack)
