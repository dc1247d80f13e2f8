# What `cmake --install` lays down beside program, libraries and headers, and what `cpack` packs of it. Component ricochet
# is what runs a study, dev what builds a plugin.

# The program says its own manual and its completions: they cannot differ from it.
set(manual ${CMAKE_BINARY_DIR}/manual)
file(MAKE_DIRECTORY ${manual})
find_program(RICOCHET_GZIP gzip)
mark_as_advanced(RICOCHET_GZIP)
foreach(page ricochet.1 ricochet-study.5 bash zsh fish)
  add_custom_command(TARGET ricochet POST_BUILD COMMAND ricochet manual ${page} > ${manual}/${page} VERBATIM)
endforeach()
foreach(page ricochet.1 ricochet-study.5)
  string(REGEX REPLACE ".*\\." "" section ${page})
  set(file ${page})
  if(RICOCHET_GZIP)
    set(file ${page}.gz)
    # No name and no time: the same bytes from the same program.
    add_custom_command(TARGET ricochet POST_BUILD COMMAND ${RICOCHET_GZIP} -9nc ${manual}/${page} > ${manual}/${file} VERBATIM)
  endif()
  install(FILES ${manual}/${file} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} COMPONENT ricochet)
endforeach()
install(FILES ${manual}/bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ricochet COMPONENT ricochet)
# Debian's zsh looks below /usr in the second of these.
foreach(folder site-functions vendor-completions)
  install(FILES ${manual}/zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${folder} RENAME _ricochet COMPONENT ricochet)
endforeach()
install(FILES ${manual}/fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME ricochet.fish COMPONENT ricochet)

# Pages with their pictures, and studies with their files, lie as they do here: their links hold.
set(root ${CMAKE_SOURCE_DIR})
file(GLOB pages CONFIGURE_DEPENDS RELATIVE ${root} ${root}/*.md ${root}/.github/*.md ${root}/core/*.md ${root}/core/*/*.md ${root}/core/*/*.svg
  ${root}/plugins/*.md ${root}/plugins/*.svg ${root}/runners/*.md ${root}/runners/report/*.png ${root}/tests/*.md)
file(GLOB_RECURSE studies CONFIGURE_DEPENDS RELATIVE ${root} ${root}/studies/*)
foreach(page ${pages} ${studies})
  cmake_path(GET page PARENT_PATH folder)
  install(FILES ${root}/${page} DESTINATION ${CMAKE_INSTALL_DATADIR}/ricochet/${folder} COMPONENT ricochet)
endforeach()

# Packages: `cpack -G DEB` makes ricochet and ricochet-dev, `cpack -G TGZ` one archive that runs from any folder.
set(RICOCHET_MAINTAINER "Ricochet maintainers <ricochet@packages.debian.org>" CACHE STRING "Who maintains the packages: name <address>")
execute_process(COMMAND git -C ${root} log -1 --format=%cD OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT date)
  set(date "Thu, 01 Jan 1970 00:00:00 +0000")
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${manual}/changelog @ONLY)
if(RICOCHET_GZIP)
  execute_process(COMMAND ${RICOCHET_GZIP} -9nf ${manual}/changelog)
  foreach(component ricochet dev)
    string(REPLACE ricochet-ricochet ricochet package ricochet-${component})
    string(REGEX REPLACE "ricochet$" "${package}" folder ${CMAKE_INSTALL_DOCDIR})
    install(FILES ${manual}/changelog.gz ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${folder} COMPONENT ${component})
  endforeach()
endif()
set(CPACK_PACKAGE_NAME ricochet)
set(CPACK_PACKAGE_CONTACT "${RICOCHET_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "numerical analysis of nonsmooth dynamics")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_RELOCATABLE ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR TGZ)
set(CPACK_COMPONENTS_ALL ricochet dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_RICOCHET_PACKAGE_NAME ricochet)
set(CPACK_DEBIAN_RICOCHET_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_RICOCHET_DESCRIPTION "numerical analysis of nonsmooth dynamics
Takes a study of a vibrating structure between stops, runs every combination
of its mass matrices, contact laws, time schemes, steps and meshes, and says
what each choice is worth. Program, methods, studies and pages.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME ricochet-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "ricochet (= ${PROJECT_VERSION}), libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "g++, cmake")
set(CPACK_DEBIAN_DEV_DESCRIPTION "methods of your own for Ricochet
Headers, CMake package and examples to build mass matrices, contact laws,
time schemes and references as plugins of Ricochet.")
# An archive lies anywhere: it has no prefix of its own.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/CPackProject.cmake @ONLY CONTENT "if(CPACK_GENERATOR STREQUAL \"TGZ\")
  set(CPACK_PACKAGING_INSTALL_PREFIX /)
endif()
")
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_BINARY_DIR}/CPackProject.cmake)
include(CPack)
