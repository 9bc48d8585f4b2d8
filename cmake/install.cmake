# Says what `cmake --install` and CPack leave behind: the command with its presets, shaders, manual pages and completions;
# the headers, the libraries and find_package(glint); the Python package (in the main file).
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/glint)
get_property(libraries GLOBAL PROPERTY GLINT_LIBRARIES)
install(TARGETS ${libraries} EXPORT glint
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/glint COMPONENT dev
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/glint COMPONENT dev)
install(EXPORT glint FILE glint-targets.cmake NAMESPACE glint:: DESTINATION ${cmake_dir} COMPONENT dev)
configure_package_config_file(cmake/glint-config.cmake.in ${PROJECT_BINARY_DIR}/glint-config.cmake
  INSTALL_DESTINATION ${cmake_dir} PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/glint-config-version.cmake COMPATIBILITY ExactVersion)
install(FILES ${PROJECT_BINARY_DIR}/glint-config.cmake ${PROJECT_BINARY_DIR}/glint-config-version.cmake
  ${PROJECT_BINARY_DIR}/plugin_stamp.cpp DESTINATION ${cmake_dir} COMPONENT dev)

install(TARGETS glint COMPONENT glint)
set(web ${PROJECT_SOURCE_DIR}/web/dist)
install(FILES ${web}/report.html ${web}/report.css ${web}/report.js ${web}/unpack.js DESTINATION share/glint/web/dist COMPONENT glint)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs ${PROJECT_SOURCE_DIR}/labs ${PROJECT_SOURCE_DIR}/shaders DESTINATION share/glint COMPONENT glint)

# The command's own help becomes manual pages and completions when it is installed, because only then it certainly exists.
if(Python3_FOUND)
  install(CODE "
    execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/command_pages.py $<TARGET_FILE:glint>
      ${PROJECT_BINARY_DIR}/command_pages COMMAND_ERROR_IS_FATAL ANY)
    file(INSTALL ${PROJECT_BINARY_DIR}/command_pages/ DESTINATION \"\${CMAKE_INSTALL_PREFIX}/share\")" COMPONENT glint)
  # Below /usr/local Debian's Python looks in the folder of its version, below /usr in lib/python3/dist-packages.
  set(GLINT_PYTHON_DIR "" CACHE STRING "Where the Python package goes, below the prefix; empty: where Debian's Python looks")
  install(CODE "
    set(folder \"${GLINT_PYTHON_DIR}\")
    if(NOT folder AND CMAKE_INSTALL_PREFIX STREQUAL /usr)
      set(folder lib/python3/dist-packages)
    elseif(NOT folder)
      set(folder lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/dist-packages)
    endif()
    file(INSTALL ${PROJECT_SOURCE_DIR}/python/glint DESTINATION \"\${CMAKE_INSTALL_PREFIX}/\${folder}\"
      PATTERN __pycache__ EXCLUDE)" COMPONENT python)
endif()

# Packages of Debian: glint has the command and the Python package, glint-dev has headers and libraries.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The Glint authors <glint@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Emulator of a GPU with hardware ray tracing")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL glint dev python)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_GLINT_PACKAGE_NAME glint)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME glint-dev)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-glint)
set(CPACK_DEBIAN_GLINT_PACKAGE_SECTION science)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS python3)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "glint (= ${PROJECT_VERSION}), libfmt-dev")
set(CPACK_DEBIAN_GLINT_PACKAGE_SHLIBDEPS ON)  # needs the packages dpkg-dev and file
include(CPack)
